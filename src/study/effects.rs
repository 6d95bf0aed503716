//! The effects of the factors of a study on the models' errors and on their results.

use super::factorial::{self, Analysis};
use super::response::Response;
use super::run::{Factor, Role, StudyRun};
use crate::body::EdgeModel;
use crate::case::two_level::TwoLevel;

/// One response of one method, analysed.
#[derive(Debug, Clone)]
pub struct Effects {
    /// The method.
    pub method: EdgeModel,
    /// The response.
    pub response: Response,
    /// Its effects.
    pub analysis: Analysis,
    /// Response at each corner: coded levels and value, for interaction plots.
    pub corners: Vec<(Vec<i8>, f64)>,
    /// Response at the centre point.
    pub centre: Option<f64>,
}

/// An analysis that is not possible.
#[derive(Debug, Clone, PartialEq)]
pub enum NotAnalysed {
    /// None at all: the study is no two-level design.
    NoDesign,
    /// None of the errors: not all corners could be compared.
    NothingCompared,
    /// A response of these methods, which have no value of it at some corner.
    Response(Response, Vec<EdgeModel>),
}

/// Analyses every response of every method. The second list has the analyses that are not possible.
pub fn analyse(run: &StudyRun) -> (Vec<Effects>, Vec<NotAnalysed>) {
    let Some(design) = &run.design else {
        return (Vec::new(), vec![NotAnalysed::NoDesign]);
    };
    let mut all = Vec::new();
    let mut absent: Vec<(Response, Vec<EdgeModel>)> = Vec::new();
    for &method in &run.methods {
        for response in Response::all() {
            match effects_of(run, design, method, response) {
                Some(effects) => all.push(effects),
                None => match absent.iter_mut().find(|(of, _)| *of == response) {
                    Some((_, methods)) => methods.push(method),
                    None => absent.push((response, vec![method])),
                },
            }
        }
    }
    let missing = |response: &Response| absent.iter().any(|(of, _)| of == response);
    let nothing = Response::errors().all(|response| missing(&response));
    if nothing {
        absent.retain(|(of, _)| matches!(of, Response::Found(_)));
    }
    let nothing = nothing.then_some(NotAnalysed::NothingCompared);
    let absent = absent.into_iter().map(|(response, of)| NotAnalysed::Response(response, of));
    (all, nothing.into_iter().chain(absent).collect())
}

/// The effects on one response of one method, where it has a value at every corner.
fn effects_of(
    run: &StudyRun,
    design: &TwoLevel,
    method: EdgeModel,
    response: Response,
) -> Option<Effects> {
    let (mut corners, mut centre) = (Vec::new(), None);
    for case in &run.cases {
        let Some(m) = case.methods.iter().find(|m| m.source == method.into()) else { continue };
        match (&case.role, response.value(case, m)) {
            (Role::Corner(levels), Some(v)) => corners.push((levels.clone(), v)),
            (Role::Centre, v) => centre = v,
            _ => {}
        }
    }
    let (levels, values): (Vec<_>, Vec<_>) = corners.iter().cloned().unzip();
    let analysis = factorial::analyse(design, &levels, &values, centre).ok()?;
    Some(Effects { method, response, analysis, corners, centre })
}

/// Name of an effect, e.g. `W x S_l`.
pub fn term(run_factors: &[Factor], factors: &[usize]) -> String {
    factors.iter().map(|&i| &*run_factors[i].name).collect::<Vec<_>>().join(" x ")
}
