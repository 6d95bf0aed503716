//! Solves and times cases by models. Cases of one problem are solved together.

use super::groups::groups;
use super::published::Published;
use super::timing::{self, Timing};
use crate::base::Result;
use crate::body::EdgeModel;
use crate::case::Case;
use crate::solve::{Scene, Solution};
use rayon::prelude::*;

/// Solves cases that share a scene by one edge model: one solution for each case, in their order.
pub type Solver<'a> = dyn Fn(&[Case], EdgeModel) -> Vec<Result<Solution>> + Sync + 'a;

/// Seconds of one case by one model on this number of threads in a separate process; `None` where
/// it cannot be measured.
pub type Cold<'a> = dyn Fn(&Case, EdgeModel, usize) -> Option<f64> + Sync + 'a;

/// The models of a run.
pub struct Models<'a> {
    /// The models.
    pub methods: Vec<EdgeModel>,
    /// Warm repeats of the timing; 0 leaves the timing out.
    pub repeats: usize,
    /// Solves cases that differ only in scale by one model: one result for each, in their order.
    pub solver: &'a Solver<'a>,
    /// Measures the time of a solve in a separate process.
    pub cold: &'a Cold<'a>,
    /// The published method on cells, if it is to be run.
    pub published: Option<&'a Published<'a>>,
}

/// The attempt of one model to solve one case.
pub(super) struct Attempt {
    /// The model.
    pub method: EdgeModel,
    /// Its solution.
    pub solution: Result<Solution>,
    /// Repeated timing on one thread and on all; empty without timing.
    pub timing: Vec<Timing>,
}

/// The contact problems to solve: each with its cases, by every model.
pub(super) struct Jobs<'a> {
    cases: &'a [Case],
    models: &'a Models<'a>,
    jobs: Vec<(Vec<usize>, EdgeModel)>,
}

impl<'a> Jobs<'a> {
    /// Groups the cases that are one problem.
    pub fn new(cases: &'a [Case], models: &'a Models<'a>) -> Self {
        // A round surface matters to free ends alone: which cases are one problem depends on the
        // model.
        let of_method = |&method: &EdgeModel| {
            let key = |case: &Case| Some(Scene::new(case, method, None).key());
            groups(cases.iter().map(key)).into_iter().map(move |group| (group, method))
        };
        Self { cases, models, jobs: models.methods.iter().flat_map(of_method).collect() }
    }

    /// Number of contact problems to be solved.
    pub fn solves(&self) -> usize {
        self.jobs.len()
    }

    /// Number of steps that [`Jobs::run`] reports.
    pub fn steps(&self) -> usize {
        self.jobs.len() * if self.models.repeats > 0 { 2 } else { 1 }
    }

    /// Solves all problems and times them. The result has the models of each case, in their order.
    /// Every thread reports its finished steps to `step`.
    pub fn run(&self, step: &(dyn Fn(&str) + Sync)) -> Vec<Vec<Attempt>> {
        let solved: Vec<Vec<Result<Solution>>> = self
            .jobs
            .par_iter()
            .map(|(group, method)| {
                let members: Vec<Case> = group.iter().map(|&i| self.cases[i].clone()).collect();
                let solutions = (self.models.solver)(&members, *method);
                step(&format!("{method}, {}", members[0].name));
                solutions
            })
            .collect();
        // Timing runs alone, after everything else.
        let timings: Vec<Vec<Timing>> = self
            .jobs
            .iter()
            .map(|(group, method)| self.timing(&self.cases[group[0]], *method, step))
            .collect();
        let mut attempts: Vec<Vec<Attempt>> = self.cases.iter().map(|_| Vec::new()).collect();
        for (((group, method), solutions), timing) in self.jobs.iter().zip(solved).zip(timings) {
            for (&i, solution) in group.iter().zip(solutions) {
                attempts[i].push(Attempt { method: *method, solution, timing: timing.clone() });
            }
        }
        attempts
    }

    /// Times one case of a problem, on one thread and on all. The others differ only in scale.
    fn timing(&self, case: &Case, method: EdgeModel, step: &dyn Fn(&str)) -> Vec<Timing> {
        if self.models.repeats == 0 {
            return Vec::new();
        }
        let one = std::slice::from_ref(case);
        let work = || (self.models.solver)(one, method).into_iter().collect::<Result<Vec<_>>>();
        let timings = [1, 0]
            .into_iter()
            .filter_map(|threads| timing::measure(threads, self.models.repeats, work).ok())
            .map(|t| Timing { cold_s: (self.models.cold)(case, method, t.threads), ..t })
            .collect();
        step(&format!("timing {method}, {}", case.name));
        timings
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Material;
    use crate::case::Factors;

    /// Terms of first order in C / R are of free ends; other models are the same under any load.
    #[test]
    fn loads_share_a_problem_where_round_surfaces_do_not_matter() {
        let steel = Material { young_pa: 210e9, poisson: 0.3 };
        let case = |load: f64, first_order: bool| {
            let factors = Factors { load, slenderness: 5.0, length_ratio: 0.5 };
            let mut case = Case::from_factors("case", 10e-3, steel, steel, factors);
            case.accuracy.first_order = first_order;
            case
        };
        let models = Models {
            methods: vec![EdgeModel::Mirror, EdgeModel::QuarterSpace],
            repeats: 0,
            solver: &|_, _| Vec::new(),
            cold: &|_, _, _| None,
            published: None,
        };
        for (first_order, problems) in [(false, 2), (true, 3)] {
            let cases = [1e-4, 1e-3].map(|load| case(load, first_order));
            assert_eq!(Jobs::new(&cases, &models).solves(), problems, "{first_order}");
        }
    }
}
