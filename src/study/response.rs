//! The responses: numbers of a case and model whose dependence on the factors is analysed.

use super::run::{CaseRun, MethodResult, MethodRun};
use super::timing::Ratio;
use crate::stress::Quantity;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

/// A number of a case and model whose dependence on the factors is analysed. Files hold its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Response {
    /// An error of a quantity in a measure.
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
    /// Largest pressure (Pa).
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

    fn of(self, result: &MethodResult) -> Option<f64> {
        let summary = &result.solution.summary;
        Some(match self {
            Self::CentrePressure => summary.p_centre_pa,
            Self::LargestPressure => summary.p_max_pa,
            Self::CriticalStress => result.critical?.value * summary.hertz.p0_pa,
            Self::Approach => summary.approach_m,
        })
    }
}

/// The quantity of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// The contact pressure.
    Pressure,
    /// The six stress components together.
    Stress,
    /// One quantity.
    Quantity(Quantity),
}

/// The measure of an error over curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Root mean square.
    Rms,
    /// The largest magnitude.
    Max,
}

impl Response {
    /// RMS error of the pressure.
    pub const PRESSURE_RMS: Self = Self::Error(Of::Pressure, Measure::Rms);
    /// Largest error of the pressure.
    pub const PRESSURE_MAX: Self = Self::Error(Of::Pressure, Measure::Max);
    /// RMS error of the six stresses.
    pub const STRESS_RMS: Self = Self::Error(Of::Stress, Measure::Rms);
    /// Largest error of the six stresses.
    pub const STRESS_MAX: Self = Self::Error(Of::Stress, Measure::Max);
    /// RMS error of the von Mises stress.
    pub const VON_MISES_RMS: Self = Self::Error(Of::Quantity(Quantity::VonMises), Measure::Rms);
    /// Largest error of the von Mises stress.
    pub const VON_MISES_MAX: Self = Self::Error(Of::Quantity(Quantity::VonMises), Measure::Max);

    /// All that compare a model with FEM, in the order of the files.
    pub fn all() -> impl Iterator<Item = Self> {
        let errors = [Of::Pressure, Of::Stress].into_iter();
        errors
            .chain(Quantity::ALL.map(Of::Quantity))
            .flat_map(|of| [Measure::Rms, Measure::Max].map(|by| Self::Error(of, by)))
            .chain([Self::CriticalValue, Self::CriticalDepth, Self::Log10Speedup])
    }

    /// [`Response::all`], and the results of the models themselves.
    pub fn every() -> impl Iterator<Item = Self> {
        Self::all().chain(Found::ALL.map(Self::Found))
    }

    /// The name used in files, e.g. `von_mises_max`.
    pub fn name(self) -> String {
        match self {
            Self::Error(of, by) => {
                let of = match of {
                    Of::Pressure => "pressure",
                    Of::Stress => "stress",
                    Of::Quantity(quantity) => quantity.name(),
                };
                let by = match by {
                    Measure::Rms => "rms",
                    Measure::Max => "max",
                };
                format!("{of}_{by}")
            }
            Self::CriticalValue => "critical_value".to_string(),
            Self::CriticalDepth => "critical_depth".to_string(),
            Self::Log10Speedup => "log10_speedup".to_string(),
            Self::Found(found) => found.name().to_string(),
        }
    }

    /// The response of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::every().find(|response| response.name() == name)
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
                    Of::Pressure => *summary.pressure.first()?,
                    Of::Stress => summary.stress,
                    Of::Quantity(quantity) => summary.quantities[quantity.index()],
                };
                Some(match by {
                    Measure::Rms => rms,
                    Measure::Max => max,
                })
            }
            Self::CriticalValue => Some(result.critical?.value - case.reference_critical()?.value),
            Self::CriticalDepth => Some(result.critical?.at[2] - case.reference_critical()?.at[2]),
            Self::Log10Speedup => Some(speedup(case, method)?.value.log10()),
            Self::Found(found) => found.of(result),
        }
    }
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
        let names: Vec<String> = Response::all().map(Response::name).collect();
        assert_eq!(names.len(), 23);
        assert_eq!(
            names[..5],
            ["pressure_rms", "pressure_max", "stress_rms", "stress_max", "sigma_xx_rms"]
        );
        assert_eq!(
            names[19..],
            ["tau_max_max", "critical_value", "critical_depth", "log10_speedup"]
        );
        for response in Response::every() {
            assert_eq!(Response::from_name(&response.name()), Some(response));
        }
        assert_eq!(Response::from_name("stress_l1"), None);
    }
}
