//! The edge model of a solution, and what to compute.

use super::extent::check_points;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::stress::BodyKind;
use crate::stress::curves::{self, CURVE_NAMES};

/// The edge model of a solution, and what to compute.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The edge model of both bodies.
    pub method: EdgeModel,
    /// Bodies whose curves to compute.
    pub bodies: Vec<BodyKind>,
    /// Names of the standard curves to compute; all by default.
    pub curves: Vec<String>,
    /// Extra points, in their order.
    pub points: Vec<Point>,
    /// Weight of the images of `guilbault`, instead of [`crate::body::guilbault_psi`].
    pub psi: Option<f64>,
}

/// A point in a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The body.
    pub body: BodyKind,
    /// x, y, z (m); z is the depth into the body, >= 0.
    pub at_m: [f64; 3],
}

impl Options {
    /// All standard curves of both bodies.
    pub fn new(method: EdgeModel) -> Self {
        Self {
            method,
            bodies: BodyKind::ALL.to_vec(),
            curves: CURVE_NAMES.iter().map(|s| s.to_string()).collect(),
            points: Vec::new(),
            psi: None,
        }
    }

    /// Whether the curve called `name` is wanted; one at -x or at the -y end is with its twin on
    /// the other side.
    pub fn wants(&self, name: &str) -> bool {
        let twin = curves::twin(name);
        self.curves.iter().any(|wanted| wanted == name || wanted == twin)
    }

    /// Refuses what the line engine does not take: a rough surface, and what [`Options::check`]
    /// refuses.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn check_line(&self, case: &Case) -> Result<()> {
        case.check_smooth("contacts along a line are smooth; only cells carry heights")?;
        self.check(case)
    }

    /// Refuses curves that do not exist and points outside their body.
    ///
    /// # Errors
    /// [`Error::Value`] that names the first of them.
    pub fn check(&self, case: &Case) -> Result<()> {
        let unknown = |name: &&String| curves::every_name().all(|known| known != *name);
        if let Some(name) = self.curves.iter().find(unknown) {
            let nearest = CURVE_NAMES
                .iter()
                .min_by_key(|known| strsim::damerau_levenshtein(known, name))
                .expect("there are standard curves");
            return Err(Error::Value {
                key: "curve".into(),
                value: name.clone(),
                reason: "there is no standard curve of this name".into(),
                remedy: format!("did you mean {nearest}? There are {}", CURVE_NAMES.join(", ")),
            });
        }
        check_points(case, self.points.iter().map(|point| (point.body, point.at_m)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(options: &Options) -> String {
        let case = crate::case::builtin_case("flush-short").unwrap().unwrap();
        options.check(&case).unwrap_err().to_string()
    }

    #[test]
    fn unknown_curves_are_refused_with_the_nearest_one() {
        let mut options = Options::new(EdgeModel::Mirror);
        options.curves = vec!["depth-end".into(), "depth-center".into()];
        let said = refused(&options);
        assert!(said.contains("depth-center") && said.contains("mean depth-centre?"), "{said}");
    }

    #[test]
    fn points_outside_a_body_are_refused() {
        let mut options = Options::new(EdgeModel::Mirror);
        for (body, at_m, wanted) in [
            (BodyKind::Roller, [0.0, 0.0, 0.0201], "z of point 2 (roller) = 0.0201 m"),
            (BodyKind::Roller, [f64::NAN, 0.0, 0.0], "x of point 2 (roller) = NaN m"),
            (BodyKind::Block, [0.0, -1.0, 0.0], "y of point 2 (block) = -1 m"),
            (BodyKind::Block, [0.0, 0.0, -1e-9], "z of point 2 (block) = -1e-9 m"),
        ] {
            // A block has no floor.
            let good = Point { body: BodyKind::Block, at_m: [0.0, 0.0, 0.0201] };
            options.points = vec![good, Point { body, at_m }];
            let said = refused(&options);
            assert!(said.starts_with(wanted), "{said}");
        }
    }
}
