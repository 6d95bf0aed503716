//! The responses: numbers of a case and model whose dependence on the factors is analysed.

use super::measure::{Measure, Of};
use super::run::{CaseRun, MethodDetails, MethodResult, MethodRun};
use super::timing::Ratio;
use crate::solve::edge::EdgeStrength;
use crate::stress::{Quantity, Variable};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

/// A number of a case and model whose dependence on the factors is analysed. Files hold its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Response {
    /// The largest or the RMS error of something.
    Error(Of, Measure),
    /// Error of the largest von Mises stress (p0).
    CriticalValue,
    /// Error of the depth of the largest von Mises stress (C).
    CriticalDepth,
    /// Decimal logarithm of FEM's time over the model's.
    Log10Speedup,
    /// A result of the model, whatever it is compared with.
    Found(Found),
}

/// A result of a model in SI units, with the name of its column in `study.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// Pressure at the centre (Pa).
    CentrePressure,
    /// Largest pressure (Pa): the largest mean of a cell.
    LargestPressure,
    /// Largest von Mises stress outside the range left out (Pa).
    CriticalStress,
    /// Approach of the bodies (m).
    Approach,
}

impl Found {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::CentrePressure, Self::LargestPressure, Self::CriticalStress, Self::Approach];

    fn name(self) -> &'static str {
        match self {
            Self::CentrePressure => "p_centre_pa",
            Self::LargestPressure => "p_max_pa",
            Self::CriticalStress => "critical_von_mises_pa",
            Self::Approach => "approach_m",
        }
    }

    /// Its value in SI units; none where all stresses were left out.
    pub fn of(self, result: &MethodResult) -> Option<f64> {
        let summary = &result.solution.summary;
        Some(match self {
            Self::CentrePressure => summary.p_centre_pa,
            Self::LargestPressure => summary.p_max_pa,
            Self::CriticalStress => result.critical?.value * summary.hertz.p0_pa,
            Self::Approach => summary.approach_m,
        })
    }
}

const VON_MISES: Of = Of::Variable(Variable::Stress(Quantity::VonMises));

impl Response {
    /// RMS error of the pressure.
    pub const PRESSURE_RMS: Self = Self::Error(Of::Variable(Variable::Pressure), Measure::Rms);
    /// Largest error of the pressure.
    pub const PRESSURE_MAX: Self = Self::Error(Of::Variable(Variable::Pressure), Measure::Max);
    /// RMS error of the six stresses.
    pub const STRESS_RMS: Self = Self::Error(Of::Components, Measure::Rms);
    /// Largest error of the six stresses.
    pub const STRESS_MAX: Self = Self::Error(Of::Components, Measure::Max);
    /// RMS error of the von Mises stress.
    pub const VON_MISES_RMS: Self = Self::Error(VON_MISES, Measure::Rms);
    /// Largest error of the von Mises stress.
    pub const VON_MISES_MAX: Self = Self::Error(VON_MISES, Measure::Max);

    /// All that compare a model with FEM, in the order of the files.
    pub fn errors() -> impl Iterator<Item = Self> {
        let errors = [Of::Variable(Variable::Pressure), Of::Components].into_iter();
        errors
            .chain(Quantity::ALL.map(|of| Of::Variable(Variable::Stress(of))))
            .flat_map(|of| [Measure::Rms, Measure::Max].map(|by| Self::Error(of, by)))
            .chain([Self::CriticalValue, Self::CriticalDepth, Self::Log10Speedup])
    }

    /// [`Response::errors`], and the results of the models themselves.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::errors().chain(Found::ALL.map(Self::Found))
    }

    /// The name used in files, e.g. `von_mises_max`.
    pub fn name(self) -> String {
        match self {
            Self::Error(of, by) => {
                format!("{}_{}", of.name(), by.name())
            }
            Self::CriticalValue => "critical_value".to_string(),
            Self::CriticalDepth => "critical_depth".to_string(),
            Self::Log10Speedup => "log10_speedup".to_string(),
            Self::Found(found) => found.name().to_string(),
        }
    }

    /// The response of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|response| response.name() == name)
    }

    /// Its unit: `p0`, `C` or `decades`, that of a result in SI.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Error(..) | Self::CriticalValue => "p0",
            Self::CriticalDepth => "C",
            Self::Log10Speedup => "decades",
            Self::Found(Found::Approach) => "m",
            Self::Found(_) => "Pa",
        }
    }

    /// Its value for a case and model, if it exists.
    pub fn value(self, case: &CaseRun, method: &MethodRun) -> Option<f64> {
        let result = method.result.as_ref().ok()?;
        match self {
            Self::Error(of, by) => {
                let summary = result.summary.as_ref()?;
                let [max, rms] = match of {
                    Of::Variable(Variable::Pressure) => *summary.pressure.first()?,
                    Of::Components => summary.stress,
                    Of::Variable(Variable::Stress(of)) => summary.quantities[of.index()],
                };
                match by {
                    Measure::Rms => Some(rms),
                    Measure::Max => Some(max),
                    Measure::L1 => None,
                }
            }
            Self::CriticalValue => Some(result.critical?.value - case.reference_critical()?.value),
            Self::CriticalDepth => Some(result.critical?.at[2] - case.reference_critical()?.at[2]),
            Self::Log10Speedup => Some(speedup(case, method)?.value.log10()),
            // At a singular end it is that of the cells alone.
            Self::Found(Found::LargestPressure) if has_singular_end(result) => None,
            Self::Found(found) => found.of(result),
        }
    }
}

/// Whether the pressure of a result grows without bound towards an end.
fn has_singular_end(result: &MethodResult) -> bool {
    let MethodDetails::Line(details) = &result.solution.summary.details else { return false };
    let ends = details.edge.iter().chain(&details.edge_neg);
    ends.into_iter().any(|edge| matches!(edge, EdgeStrength::Singular { .. }))
}

impl Serialize for Response {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name())
    }
}

impl<'de> Deserialize<'de> for Response {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::from_name(&name)
            .ok_or_else(|| de::Error::custom(format!("there is no response '{name}'")))
    }
}

/// The ratio of FEM's time to the model's on one thread, with its uncertainty: from this run if FEM
/// ran in it, else from a record of both. Only times of one run on one machine are divided.
pub fn speedup(case: &CaseRun, method: &MethodRun) -> Option<Ratio> {
    let fem = &case.reference()?.provenance;
    if fem.live {
        let spread = fem.seconds_spread.unwrap_or(0.0);
        return Some(Ratio::new((fem.seconds?, spread), method.timing.first()?.with_spread()));
    }
    let timed = fem.timed.as_ref()?;
    Some(Ratio::new(timed.seconds, *timed.methods.get(method.source.name())?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_files_and_lead_back() {
        let names: Vec<String> = Response::errors().map(Response::name).collect();
        assert_eq!(names.len(), 23);
        assert_eq!(
            names[..5],
            ["pressure_rms", "pressure_max", "stress_rms", "stress_max", "sigma_xx_rms"]
        );
        assert_eq!(
            names[19..],
            ["tau_max_max", "critical_value", "critical_depth", "log10_speedup"]
        );
        for response in Response::all() {
            assert_eq!(Response::from_name(&response.name()), Some(response));
        }
        assert_eq!(Response::from_name("stress_l1"), None);
    }
}
