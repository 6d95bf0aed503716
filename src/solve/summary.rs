//! The numbers of a solution in SI units, as in `summary.json`.

use super::edge::EdgeStrength;
use super::solved_scene::Seconds;
use crate::base::HertzScales;
use crate::body::{EdgeModel, Resolution};
use crate::contact::Coarser;
use crate::stress::{BodyKind, Critical, Work};
use serde::{Deserialize, Serialize};

/// The summary of a solution; `D` is what its engine says besides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Summary<D = Details> {
    /// The case's name.
    pub case: String,
    /// The edge model.
    pub method: EdgeModel,
    /// The scales.
    pub hertz: HertzScales,
    /// Load (N).
    pub load_n: f64,
    /// Approach (m) of the points one roller radius below both surfaces at y = 0.
    pub approach_m: f64,
    /// Tilt of the lines x = 0 one roller radius below the surfaces, by least squares over the
    /// contact (rad); positive where the side of larger y is pressed deeper.
    pub tilt_rad: f64,
    /// Pressure at the contact's centre (Pa).
    pub p_centre_pa: f64,
    /// Largest pressure of the cells (Pa).
    pub p_max_pa: f64,
    /// Its place x, y (m).
    pub p_max_at_m: [f64; 2],
    /// Where the pressure's resultant acts: x, y (m).
    pub centre_of_pressure_m: [f64; 2],
    /// The contact's ends along y (m).
    pub contact_y_m: [f64; 2],
    /// Whether the contact iteration reached its tolerance.
    pub converged: bool,
    /// Iterations of the contact solve.
    pub iterations: usize,
    /// |load of the pressure - load| / load.
    pub load_error_rel: f64,
    /// Time spent.
    pub seconds: Seconds,
    /// The most stressed place of the curves asked for, all of them by default, at least 0.1 C
    /// from the surface's edges at the ends of the bodies' overlap.
    pub critical: Option<CriticalSummary>,
    /// The resolution and the work.
    pub details: D,
}

impl Summary {
    /// What to beware of.
    pub fn warnings(&self) -> Vec<String> {
        let unsettled = || {
            format!(
                "the contact changed by more than its tolerance until the last of its {} iterations (`converged` \
                 in the summary); compare with a tighter tolerance",
                self.iterations
            )
        };
        let wanted = self.details.resolution;
        let coarser = |Coarser { spacing, modes, .. }| {
            let farther = spacing[1] / wanted.spacing[1];
            let given_up = [
                (farther > 1.01).then(|| format!("half-widths {farther:.0} times as far apart")),
                (modes < wanted.modes).then(|| format!("{modes} of {} modes", wanted.modes)),
            ];
            let given_up: Vec<String> = given_up.into_iter().flatten().collect();
            format!(
                "the resolution was too fine for the contact, which is solved with {} (`coarser` in the summary's \
                 details); beside its ends errors may be many times the tolerance: compare with another tolerance, \
                 or with --engine cells",
                given_up.join(" and "),
            )
        };
        let unsettled = (!self.converged).then(unsettled);
        let shaped = self.details.profile_residual.map(|left_out| {
            format!(
                "the measured profile has details that {} nodes along the line cannot follow: they may change the \
                 pressure by some {left_out:.0e} p0 (`profile_residual` in the summary's details); smooth the profile, \
                 or take --engine cells, with --cells no longer than the distance of its points",
                self.details.contact_nodes
            )
        });
        [unsettled, self.details.coarser.map(coarser), shaped].into_iter().flatten().collect()
    }
}

impl<D> Summary<D> {
    /// The same with other details.
    pub fn map_details<E>(self, of: impl FnOnce(D) -> E) -> Summary<E> {
        Summary {
            case: self.case,
            method: self.method,
            hertz: self.hertz,
            load_n: self.load_n,
            approach_m: self.approach_m,
            tilt_rad: self.tilt_rad,
            p_centre_pa: self.p_centre_pa,
            p_max_pa: self.p_max_pa,
            p_max_at_m: self.p_max_at_m,
            centre_of_pressure_m: self.centre_of_pressure_m,
            contact_y_m: self.contact_y_m,
            converged: self.converged,
            iterations: self.iterations,
            load_error_rel: self.load_error_rel,
            seconds: self.seconds,
            critical: self.critical,
            details: of(self.details),
        }
    }
}

/// The most stressed place in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct CriticalSummary {
    /// The body.
    pub body: BodyKind,
    /// The measure.
    pub measure: Measure,
    /// Its value (Pa).
    pub value_pa: f64,
    /// Where: x, y, z (m).
    pub at_m: [f64; 3],
}

/// The measure of the largest stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Von Mises equivalent stress.
    VonMises,
}

impl CriticalSummary {
    /// `critical` in SI units.
    pub fn new(critical: &Critical, hertz: &HertzScales) -> Self {
        Self {
            body: critical.body,
            measure: Measure::VonMises,
            value_pa: critical.value * hertz.p0_pa,
            at_m: critical.at.map(|v| v * hertz.c_m),
        }
    }
}

/// The resolution of a scene and further numbers of its solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Details {
    /// Requested accuracy (p0).
    pub tolerance: f64,
    /// The resolution chosen for it.
    pub resolution: Resolution,
    /// Numbers of wavenumbers: those of the bodies' equations, and those of the loads.
    pub wavenumbers: [usize; 2],
    /// Nodes along the contact line, or along one half of it if the contact is symmetric.
    pub contact_nodes: usize,
    /// Strength of the contact's end, if the model has a law for it.
    pub edge: Option<EdgeStrength>,
    /// The same at the -y end of a contact that is not symmetric.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edge_neg: Option<EdgeStrength>,
    /// What the contact was solved with, where the resolution was too fine for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coarser: Option<Coarser>,
    /// What the nodes along the line leave out of the pressure, about (p0), where a measured
    /// profile does more between them than they can follow, and that is more than the tolerance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile_residual: Option<f64>,
    /// Remaining amplitude of the pressure's singularity across the contact (p0).
    pub edge_residual: f64,
    /// The largest condition number of the bodies' equations.
    pub condition: f64,
    /// Whether both bodies share one computation.
    pub bodies_shared: bool,
    /// Evaluations of waves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<WorkSummary>,
    /// Depth of the points of the approach (m).
    pub approach_reference_m: f64,
    /// The uniform sigma_xx of a roller compressed across its diameter (Pa).
    pub roller_diametral_tension_pa: f64,
    /// The stiffnesses, where they are asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<Stiffness>,
}

/// The stiffnesses of a contact at its load: how force and moment about the roller's middle grow
/// with the approach there and with the tilt. They are those between points and lines one roller
/// radius below the surfaces, as are approach and tilt.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Stiffness {
    /// Force by approach at constant tilt (N/m).
    pub force_by_approach_n_per_m: f64,
    /// Moment by tilt at constant approach (N m/rad).
    pub moment_by_tilt_nm_per_rad: f64,
    /// Force by tilt at constant approach (N/rad); zero where the contact is symmetric.
    pub force_by_tilt_n_per_rad: f64,
    /// Moment by approach at constant tilt (N); zero where the contact is symmetric. It differs a
    /// little from the force by tilt, as approach and tilt are those of points and lines at a
    /// depth.
    pub moment_by_approach_n: f64,
}

/// Evaluations done and avoided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct WorkSummary {
    /// Evaluations in the sums of the stresses.
    pub done: u64,
    /// Those avoided, by reason.
    pub avoided: Avoided,
}

/// Evaluations avoided, by reason; the names are those in the file and in the report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Avoided {
    /// Sources beyond the reach of a wave.
    #[serde(rename = "sources beyond a wave's reach")]
    pub sources: u64,
    /// End faces beyond the reach of a wavenumber from the contact.
    #[serde(rename = "end faces beyond a wave's reach")]
    pub ends: u64,
    /// Wavenumbers whose contribution is negligible.
    #[serde(rename = "wavenumbers that have faded")]
    pub faded: u64,
    /// The second of two identical bodies.
    #[serde(rename = "the other body is alike")]
    pub alike: u64,
}

impl WorkSummary {
    /// From the work of the fields; `alike` if it served two bodies.
    pub fn new(work: &Work, alike: bool) -> Self {
        let avoided = Avoided {
            sources: work.beyond_reach,
            ends: work.ends,
            faded: work.faded,
            alike: if alike { work.done } else { 0 },
        };
        Self { done: work.done, avoided }
    }
}
