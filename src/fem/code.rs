//! The finite-element codes, declared here and nowhere else.

use crate::base::number::stated;
use crate::base::{BodyKind, Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Sliding};
use crate::solve::Scene;

/// A finite-element code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Code {
    /// gmsh and FEniCSx: 27-node bricks, exact non-penetration.
    Fenicsx,
    /// CalculiX on the same grid: 20-node bricks, its own contact by a penalty.
    Calculix,
}

impl Code {
    /// All of them; errors are taken against the first that has curves.
    pub const ALL: [Code; 2] = [Code::Fenicsx, Code::Calculix];

    /// The name in requests and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Code::Fenicsx => "fenicsx",
            Code::Calculix => "calculix",
        }
    }

    /// The name of its curves in the files of a study.
    pub fn source(self) -> &'static str {
        match self {
            Code::Fenicsx => "fem",
            Code::Calculix => "calculix",
        }
    }

    /// The name for readers.
    pub fn title(self) -> &'static str {
        match self {
            Code::Fenicsx => "FEM",
            Code::Calculix => "CalculiX",
        }
    }

    /// The modules that the interpreter has to import, the one that names it first.
    pub fn modules(self) -> &'static [&'static str] {
        match self {
            Code::Fenicsx => &["dolfinx", "petsc4py", "mpi4py", "numpy", "dolfinx.fem.petsc"],
            Code::Calculix => &["numpy"],
        }
    }

    /// What to install, on Debian or Ubuntu.
    pub fn install(self) -> &'static str {
        match self {
            Code::Fenicsx => {
                "install it, on Debian or Ubuntu: apt-get install gmsh python3-dolfinx libopenblas0-serial"
            }
            Code::Calculix => {
                "install it, on Debian or Ubuntu: apt-get install gmsh calculix-ccx python3-numpy"
            }
        }
    }

    /// Refuses bodies and scenes that it does not take.
    ///
    /// # Errors
    /// [`Error::Value`] with the key of the case.
    pub fn check(self, case: &Case) -> Result<()> {
        case.check_force("finite elements take a force")?;
        let refuse = |key: &str, value: String, reason: &str, remedy: &str| {
            let (reason, remedy) = (reason.to_string(), remedy.to_string());
            Err(Error::Value { key: key.to_string(), value, reason, remedy })
        };
        if let Some(radius_m) = case.block.radius_m {
            let remedy = "remove it, or solve the case with `edgeline solve`";
            let value = stated(radius_m);
            return refuse(
                "block.radius_m",
                value,
                "finite elements take a flat block only",
                remedy,
            );
        }
        case.check_smooth("finite elements take smooth surfaces only")?;
        if self == Code::Fenicsx {
            return Ok(());
        }
        // `edgeline deck` has no other engine, so the remedy is a command of its own.
        let remedy = "remove it, or solve the case with `edgeline fem --engine fenicsx`";
        if !Scene::new(case, EdgeModel::HalfSpace, None).is_symmetric() {
            let (key, value) = uneven(case);
            let reason = "the deck models a quarter of the bodies, which takes a scene that is symmetric along y";
            return refuse(&key, value, reason, remedy);
        }
        if case.sliding != Sliding::default() {
            let (value, reason) =
                (case.sliding.friction.to_string(), "the deck's contact is frictionless");
            return refuse("sliding.friction", value, reason, remedy);
        }
        for body in BodyKind::ALL {
            if let Some(spec) = case.profile_spec(body) {
                let reason = "the deck takes straight generatrices only";
                let key = format!("{}.profile.kind", body.name());
                return refuse(&key, spec.kind.name().to_string(), reason, remedy);
            }
        }
        Ok(())
    }
}

/// The key, with its value, that makes a scene differ on both sides of y = 0.
fn uneven(case: &Case) -> (String, String) {
    let keys = [
        ("load.eccentricity_m", case.load.eccentricity_m),
        ("pose.tilt_rad", case.pose.tilt_rad),
        ("pose.offset_m", Some(case.pose.offset_m)),
    ];
    let mut given = keys.into_iter().filter_map(|(key, value)| Some((key, value?)));
    match given.find(|(_, value)| *value != 0.0) {
        Some((key, value)) => (key.into(), stated(value)),
        // Only a table has other drops on its other side.
        None => {
            let is_uneven =
                |body: &BodyKind| case.profile(*body).is_some_and(|profile| !profile.is_even());
            let body = BodyKind::ALL.into_iter().find(is_uneven).expect("nothing else is left");
            (format!("{}.profile.kind", body.name()), "table".into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn what_a_deck_does_not_take_is_named_with_a_command_that_takes_it() {
        let refused = |case: &Case| Code::Calculix.check(case).unwrap_err().to_string();
        let find = |name: &str| Case::find(Path::new(name)).unwrap();
        for (name, wanted) in [
            ("sliding-flush", "sliding.friction = 0.3 is not valid"),
            ("eccentric-flush", "load.eccentricity_m = 0.00015 is not valid"),
            ("offset-flush-end", "pose.offset_m = "),
            ("crown-inside", "roller.profile.kind = crown is not valid"),
        ] {
            let said = refused(&find(name));
            assert!(said.starts_with(wanted), "{said}");
            assert!(said.contains("`edgeline fem --engine fenicsx`"), "{said}");
        }
        let mut case = find("flush-short");
        case.pose.tilt_rad = Some(-1e-4);
        assert!(refused(&case).starts_with("pose.tilt_rad = -0.0001 "), "{}", refused(&case));
    }
}
