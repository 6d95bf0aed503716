//! What a file of curves says of itself: units, axes, error.

use crate::base::{BodyKind, StressTensor};
use std::fmt::Write;

/// Lines `# key: value` that a file may begin with, and what options may state instead.
pub const KEYS: [(&str, &str); 8] = [
    ("name", "what the curves are called; the file's name without its ending by default"),
    ("length_unit", "m, cm, mm, um or in"),
    ("stress_unit", "Pa, kPa, MPa, GPa, psi or ksi"),
    ("body", "block or roller, where no column says so"),
    (
        "axes",
        "the file's directions across the contact, along it, and into the block, as in z -x y",
    ),
    ("origin", "the file's coordinates of the contact's origin, as in 0 12.5 0"),
    ("system", "bodies or space: z into each body, or one system of axes for both"),
    ("error_p0", "the largest error of the curves as a fraction of p0, as in 0.005"),
];

/// Units by name, with their value in SI units.
const LENGTHS: [(&str, f64); 5] =
    [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("in", 0.0254)];
const STRESSES: [(&str, f64); 6] = [
    ("Pa", 1.0),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("GPa", 1e9),
    ("psi", 6_894.757_293_168_361),
    ("ksi", 6_894_757.293_168_361),
];

/// A unit: its name, and its value in the SI unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Its name.
    pub name: &'static str,
    /// Its value in the SI unit.
    pub si: f64,
}

impl Unit {
    fn find(list: &[(&'static str, f64)], name: &str) -> Option<Self> {
        let same = |(known, _): &&(&str, f64)| known.eq_ignore_ascii_case(name);
        list.iter().find(same).map(|&(name, si)| Self { name, si })
    }

    /// The unit of length called `name`.
    pub fn of_length(name: &str) -> Option<Self> {
        Self::find(&LENGTHS, name)
    }

    /// The unit of stress called `name`.
    pub fn of_stress(name: &str) -> Option<Self> {
        Self::find(&STRESSES, name)
    }
}

/// A direction of the file: its axis, 0 to 2, and its sign.
pub type Direction = (usize, f64);

/// The file's directions across the contact, along it, and into the block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes(pub [Direction; 3]);

impl Default for Axes {
    fn default() -> Self {
        Self([(0, 1.0), (1, 1.0), (2, 1.0)])
    }
}

/// The place of each component in [`StressTensor::components`].
const PLACE: [[usize; 3]; 3] = [[0, 3, 4], [3, 1, 5], [4, 5, 2]];

/// The rows and columns of the components.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

impl Axes {
    /// Reads three directions, each x, y, z or 1, 2, 3 with or without a sign.
    fn parse(text: &str) -> Option<Self> {
        let direction = |word: &str| -> Option<Direction> {
            let (sign, axis) = match word.strip_prefix('-') {
                Some(axis) => (-1.0, axis),
                None => (1.0, word.strip_prefix('+').unwrap_or(word)),
            };
            let known = ["x", "y", "z"].iter().zip(["1", "2", "3"]);
            let is_it =
                |(letter, digit): (&&str, &str)| axis.eq_ignore_ascii_case(letter) || axis == digit;
            Some((known.into_iter().position(is_it)?, sign))
        };
        let all: Option<Vec<Direction>> = words(text).map(direction).collect();
        let axes: [Direction; 3] = all?.try_into().ok()?;
        let each = (0..3).all(|axis| axes.iter().any(|(a, _)| *a == axis));
        each.then_some(Self(axes))
    }

    /// A vector of the file in our axes.
    pub fn turn(&self, vector: [f64; 3]) -> [f64; 3] {
        self.0.map(|(axis, sign)| sign * vector[axis])
    }

    /// A stress of the file in our axes.
    pub fn turn_stress(&self, stress: &StressTensor) -> StressTensor {
        let theirs = stress.components();
        StressTensor::from_components(PAIRS.map(|(i, j)| {
            let ((a, first), (b, second)) = (self.0[i], self.0[j]);
            first * second * theirs[PLACE[a][b]]
        }))
    }

    fn text(&self) -> String {
        let word = |(axis, sign): &Direction| {
            format!("{}{}", if *sign < 0.0 { "-" } else { "" }, ["x", "y", "z"][*axis])
        };
        self.0.iter().map(word).collect::<Vec<_>>().join(" ")
    }
}

/// What z is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum System {
    /// The depth below the body's own surface at the point's x, into each body.
    Bodies,
    /// A coordinate in one system of axes for both bodies, into the block, 0 where they touch
    /// first.
    Space,
}

/// What a file, or an option, states.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Statements {
    /// The name of the curves.
    pub name: Option<String>,
    /// The body.
    pub body: Option<BodyKind>,
    /// The unit of coordinates.
    pub length: Option<Unit>,
    /// The unit of stresses and pressures.
    pub stress: Option<Unit>,
    /// The axes.
    pub axes: Option<Axes>,
    /// The contact's origin in the file's coordinates.
    pub origin: Option<[f64; 3]>,
    /// What z is.
    pub system: Option<System>,
    /// The largest error of the curves (p0).
    pub error_p0: Option<f64>,
}

impl Statements {
    /// Takes in `value` for one of [`KEYS`].
    ///
    /// # Errors
    /// What to write instead.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let about = KEYS.iter().find(|(known, _)| *known == key).map_or("", |(_, about)| about);
        let refused = || format!("{key} cannot be '{value}': give {about}");
        match key {
            "name" => self.name = Some(value.to_string()).filter(|v| !v.is_empty()),
            "body" => self.body = Some(body_of(value).ok_or_else(refused)?),
            "length_unit" => self.length = Some(Unit::of_length(value).ok_or_else(refused)?),
            "stress_unit" => self.stress = Some(Unit::of_stress(value).ok_or_else(refused)?),
            "axes" => self.axes = Some(Axes::parse(value).ok_or_else(refused)?),
            "origin" => self.origin = Some(numbers(value).ok_or_else(refused)?),
            "system" => {
                self.system = Some(match value {
                    "bodies" => System::Bodies,
                    "space" => System::Space,
                    _ => return Err(refused()),
                });
            }
            "error_p0" => {
                let error = value.parse().ok().filter(|e: &f64| (0.0..=0.5).contains(e));
                self.error_p0 = Some(error.ok_or_else(refused)?);
            }
            _ => return Err(format!("there is no key {key}")),
        }
        Ok(())
    }

    /// These, and those of `other` where these state nothing.
    pub fn or(self, other: &Self) -> Self {
        Self {
            name: self.name.or_else(|| other.name.clone()),
            body: self.body.or(other.body),
            length: self.length.or(other.length),
            stress: self.stress.or(other.stress),
            axes: self.axes.or(other.axes),
            origin: self.origin.or(other.origin),
            system: self.system.or(other.system),
            error_p0: self.error_p0.or(other.error_p0),
        }
    }

    /// Units and axes in words.
    pub fn describe(&self) -> String {
        let units: Vec<&str> =
            [self.length, self.stress].iter().flatten().map(|u| u.name).collect();
        let mut text =
            if units.is_empty() { "units by column".to_string() } else { units.join(", ") };
        if let Some(axes) = self.axes {
            write!(text, "; axes {}", axes.text()).expect("a string grows");
        }
        if let Some(origin) = self.origin {
            write!(text, "; origin {} {} {}", origin[0], origin[1], origin[2])
                .expect("a string grows");
        }
        if self.system == Some(System::Space) {
            text.push_str("; one system for both bodies");
        }
        text
    }
}

/// The body called `name`.
pub(super) fn body_of(name: &str) -> Option<BodyKind> {
    BodyKind::ALL.into_iter().find(|body| body.name().eq_ignore_ascii_case(name))
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split([' ', ',', '\t']).filter(|word| !word.is_empty())
}

fn numbers(text: &str) -> Option<[f64; 3]> {
    let all: Option<Vec<f64>> =
        words(text).map(|w| w.parse().ok().filter(|v: &f64| v.is_finite())).collect();
    all?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_turn_points_and_stresses_alike() {
        let axes = Axes::parse("z, -x y").unwrap();
        assert_eq!(axes.text(), "z -x y");
        assert_eq!(axes.turn([1.0, 2.0, 3.0]), [3.0, -1.0, 2.0]);
        // A dyad n n turns as n does.
        let dyad = |n: [f64; 3]| StressTensor::from_components(PAIRS.map(|(i, j)| n[i] * n[j]));
        let n = [0.3, -1.2, 0.7];
        assert_eq!(axes.turn_stress(&dyad(n)), dyad(axes.turn(n)));
        assert_eq!(Axes::default().turn_stress(&dyad(n)), dyad(n));
        for bad in ["x y", "x y y", "x y w", "x y z x", "", "--x y z"] {
            assert_eq!(Axes::parse(bad), None, "{bad}");
        }
        assert_eq!(Axes::parse("3 -1 2"), Some(axes));
    }

    #[test]
    fn statements_are_checked_and_joined() {
        let mut own = Statements::default();
        for (key, value) in [
            ("length_unit", "MM"),
            ("stress_unit", "mpa"),
            ("body", "roller"),
            ("origin", "0, 1.5 -2"),
            ("system", "space"),
            ("error_p0", "0.01"),
        ] {
            own.set(key, value).unwrap();
        }
        assert_eq!(own.length, Some(Unit { name: "mm", si: 1e-3 }));
        assert_eq!(own.stress.unwrap().si, 1e6);
        let mut other = Statements::default();
        other.set("name", "abc").unwrap();
        other.set("body", "block").unwrap();
        let both = own.or(&other);
        assert_eq!((both.name.as_deref(), both.body), (Some("abc"), Some(BodyKind::Roller)));
        for (key, value) in [
            ("length_unit", "ft"),
            ("stress_unit", "mm"),
            ("body", "ball"),
            ("axes", "x y"),
            ("origin", "1 2"),
            ("origin", "1 2 nan"),
            ("system", "moon"),
            ("error_p0", "-0.1"),
            ("error_p0", "5 %"),
        ] {
            let said = Statements::default().set(key, value).unwrap_err();
            assert!(said.starts_with(&format!("{key} cannot be '{value}': give ")), "{said}");
        }
    }
}
