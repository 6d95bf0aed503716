//! The profiles of a case's bodies, as functions of y.

use super::model::Case;
use super::profile::{ProfileKind, ProfileSpec};
use crate::base::number::{significant, stated};
use crate::base::{BodyKind, Error, HertzScales, Profile, Result};
use std::f64::consts::PI;

/// Ratio of length and diameter up to which the profile of ISO/TS 16281 curves from the middle.
const SHORT: f64 = 2.5;

/// Johns and Gohar's factor of the Hertz half-width.
const JOHNS_GOHAR: f64 = 0.3033;

/// Most of the roller's radius that a profile may drop by.
const DEEPEST: f64 = 0.5;

impl Case {
    /// The profile of a body (m), if it has one.
    ///
    /// With the body's length L = 2 a, the roller's diameter D, the contact modulus E* and the
    /// design force Q: Lundberg (1939) Q / (pi L E*) ln(1 / (1 - (2 y / L)^2)), the drop of both
    /// bodies together; Johns and Gohar (Tribology International 14, 1981) with 1 - (1 - 0.3033 b /
    /// a) (2 y / L)^2, b the Hertz half-width under Q; ISO/TS 16281:2008 0.00035 D ln(1 / (1 - (2 y
    /// / L)^2)) up to L = 2.5 D, and 0.0005 D with the outer 1.25 D on either side curved beyond
    /// it; Fujiwara and Kawase (NTN Technical Review 75, 2007) K1 A ln(1 / (1 - (1 - e^(-zm / (K1
    /// A))) t^2)) on the outer part K2 a of each half, with A = 2 Q / (pi L E'), E' = 2 E*.
    pub fn profile(&self, body: BodyKind) -> Option<Profile> {
        let spec = self.profile_spec(body)?;
        let length = self.length_m(body);
        let half = 0.5 * length;
        let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let e_star = self.contact_modulus();
        let force = number(spec.design_force_n);
        let diameter = 2.0 * self.roller.radius_m;
        // Q / (pi L E*).
        let amplitude = force / (PI * length * e_star);
        let whole =
            |amplitude: f64, k: f64| Profile::Logarithm { amplitude, k, start: 0.0, span: half };
        Some(match spec.kind {
            ProfileKind::Crown => Profile::Arc { straight: 0.0, radius: number(spec.radius_m) },
            ProfileKind::Relief => Profile::Arc {
                straight: 0.5 * number(spec.straight_m),
                radius: number(spec.radius_m),
            },
            ProfileKind::Logarithmic => whole(number(spec.amplitude_m), number(spec.k)),
            ProfileKind::Lundberg => whole(amplitude, 1.0),
            ProfileKind::JohnsGohar => {
                let radius = self.equivalent_radius_m();
                let b = HertzScales::new(e_star, radius, length, force).c_m;
                whole(amplitude, 1.0 - JOHNS_GOHAR * b / half)
            }
            ProfileKind::Iso16281 if length <= SHORT * diameter => whole(0.00035 * diameter, 1.0),
            ProfileKind::Iso16281 => {
                let span = 0.5 * SHORT * diameter;
                let start = half - span;
                Profile::Logarithm { amplitude: 0.0005 * diameter, k: 1.0, start, span }
            }
            ProfileKind::Fujiwara => {
                let amplitude = number(spec.k1) * amplitude;
                let span = number(spec.k2) * half;
                let k = -(-number(spec.zm_m) / amplitude).exp_m1();
                Profile::Logarithm { amplitude, k, start: half - span, span }
            }
            ProfileKind::Table => Profile::Table(spec.table.clone()?),
        })
    }

    /// The profile of a body as the case gives it.
    pub fn profile_spec(&self, body: BodyKind) -> Option<&ProfileSpec> {
        match body {
            BodyKind::Block => self.block.profile.as_ref(),
            BodyKind::Roller => self.roller.profile.as_ref(),
        }
    }

    /// The same to be changed.
    pub(super) fn profile_mut(&mut self, body: BodyKind) -> &mut Option<ProfileSpec> {
        match body {
            BodyKind::Block => &mut self.block.profile,
            BodyKind::Roller => &mut self.roller.profile,
        }
    }

    /// Refuses profiles without the numbers of their kind, with others, or that no body can have.
    pub(super) fn check_profiles(&self) -> Result<()> {
        BodyKind::ALL.into_iter().try_for_each(|body| self.check_profile(body))?;
        let of_both = |body: BodyKind| {
            self.profile_spec(body).map(|spec| spec.kind).filter(|kind| kind.is_of_both())
        };
        let [Some(block), Some(roller)] = BodyKind::ALL.map(of_both) else { return Ok(()) };
        Err(Error::Value {
            key: "block.profile.kind".into(),
            value: format!("{:?}", block.name()),
            reason: format!(
                "its drop is that of both bodies together, as that of the roller's {} profile is: \
                 added, they are too deep",
                roller.name()
            ),
            remedy: "give it to one of the bodies alone".into(),
        })
    }

    fn check_profile(&self, body: BodyKind) -> Result<()> {
        let Some(spec) = self.profile_spec(body) else { return Ok(()) };
        let place = format!("{}.profile", body.name());
        check_numbers(spec, &place)?;
        let refuse = |key: &str, value: String, reason: String, remedy: String| {
            Err(Error::Value { key: format!("{place}.{key}"), value, reason, remedy })
        };
        let kind = spec.kind.name();
        let [from, to] = [-0.5, 0.5].map(|s| s * self.length_m(body));
        let half = to;
        if let Some(straight) = spec.straight_m.filter(|s| *s >= 2.0 * half) {
            let reason = "the straight part is as long as the body, so nothing is left to relieve";
            let remedy = format!("it is less than the length, {} m", stated(2.0 * half));
            return refuse("straight_m", stated(straight), reason.into(), remedy);
        }
        match (spec.kind, &spec.table) {
            (ProfileKind::Table, None) => {
                let reason = "a table needs its file".to_string();
                return refuse(
                    "kind",
                    "\"table\"".into(),
                    reason,
                    "add file = \"drop.csv\"".into(),
                );
            }
            (ProfileKind::Table, Some(table)) => {
                let [first, last] = table.range();
                let rounding = 1e-9 * half;
                if first > from + rounding || last < to - rounding {
                    let file = spec.file.clone().unwrap_or_default();
                    let [first, last, from, to] = [first, last, from, to].map(stated);
                    let reason = format!(
                        "its points lie from y = {first} to {last} m and the body from {from} to \
                         {to} m"
                    );
                    let remedy = "give drops up to both ends".to_string();
                    return refuse("file", format!("{:?}", file.display()), reason, remedy);
                }
            }
            _ => {}
        }
        if spec.kind == ProfileKind::JohnsGohar {
            self.check_design_force(body, spec)?;
        }
        let profile = self.profile(body).expect("the body has one");
        // What has no limit at the end is judged just before it.
        let ends = [from, to].map(|y| 0.999 * y);
        let inner = profile.points().iter().copied().filter(|y| *y > from && *y < to);
        let drops = inner.chain(ends).map(|y| (y, profile.drop(y)));
        let highest = drops.clone().map(|(_, drop)| drop).fold(0.0, f64::min);
        let (place, lowest) =
            drops.max_by(|a, b| a.1.total_cmp(&b.1)).expect("a profile has two ends");
        let deepest = lowest - highest;
        if deepest >= DEEPEST * self.roller.radius_m {
            let place = match ends.contains(&place) {
                true => "the body's end".to_string(),
                false => format!("y = {} m", stated(place)),
            };
            let (radius, value) = (stated(self.roller.radius_m), format!("{kind:?}"));
            let reason = match deepest.is_finite() {
                true => format!(
                    "the profile drops by {} m at {place}, which no small slope allows \
                     (the roller's radius is {radius} m)",
                    significant(deepest, 4)
                ),
                false => format!(
                    "the profile ends before the body does, {} m from its middle",
                    significant(half, 4)
                ),
            };
            return refuse("kind", value, reason, "check the units of the profile (m, N)".into());
        }
        Ok(())
    }

    /// Refuses a force under which Johns and Gohar's profile would not drop: its Hertz half-width b
    /// is at most a / 0.3033, b^2 = 4 Q R / (pi L E*).
    fn check_design_force(&self, body: BodyKind, spec: &ProfileSpec) -> Result<()> {
        let length = self.length_m(body);
        let widest = 0.5 * length / JOHNS_GOHAR;
        let most = PI * length * self.contact_modulus() * widest * widest
            / (4.0 * self.equivalent_radius_m());
        match spec.design_force_n {
            Some(force) if force >= most => Err(Error::Value {
                key: format!("{}.profile.design_force_n", body.name()),
                value: format!("{force:e}"),
                reason: "1 - 0.3033 b / a is not above zero, b the Hertz half-width under this \
                         force and a half of the length: such a profile does not drop"
                    .into(),
                remedy: format!("give less than {most:.4e} N, the force that the body carries"),
            }),
            _ => Ok(()),
        }
    }
}

/// Refuses a profile at `place` without the numbers of its kind, or with others.
fn check_numbers(spec: &ProfileSpec, place: &str) -> Result<()> {
    let (kind, wanted) = (spec.kind.name(), spec.kind.keys());
    let takes = match wanted {
        [] => "no number".to_string(),
        keys => keys.join(", "),
    };
    for key in ProfileSpec::NUMBERS {
        let (own, value, reason) = match spec.number(key) {
            Some(value) if !wanted.contains(&key) => {
                (key, stated(value), format!("the profile {kind} has no such number"))
            }
            None if wanted.contains(&key) => {
                let reason = format!("the profile {kind} needs {key}, which is missing");
                ("kind", format!("{kind:?}"), reason)
            }
            _ => continue,
        };
        let (key, remedy) = (format!("{place}.{own}"), format!("it takes {takes}"));
        return Err(Error::Value { key, value, reason, remedy });
    }
    Ok(())
}
