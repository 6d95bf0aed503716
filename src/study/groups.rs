//! The cases that one solution serves.

use crate::solve::SceneKey;
use std::collections::HashMap;

/// Indices of the cases of each scene, in the order of first appearance. A case without a key has a
/// group of its own.
pub fn groups(keys: impl IntoIterator<Item = Option<SceneKey>>) -> Vec<Vec<usize>> {
    let mut index: HashMap<SceneKey, usize> = HashMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, key) in keys.into_iter().enumerate() {
        let next = groups.len();
        let at = key.map_or(next, |key| *index.entry(key).or_insert(next));
        if at == next {
            groups.push(Vec::new());
        }
        groups[at].push(i);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::EdgeModel;
    use crate::case::{Cells, Draft, Form, KEYS, Sliding, builtin_case};
    use crate::solve::Scene;

    #[test]
    fn a_solution_serves_cases_that_differ_in_scale_or_by_rounding() {
        let mut case = builtin_case("half-short").unwrap().unwrap();
        case.block.radius_m = Some(-0.05);
        case.cells = Some(Cells { half_width_m: 1e-3 });
        case.sliding = Sliding { friction: 0.1 };
        let key =
            |draft: &Draft| Scene::new(&draft.case().unwrap(), EdgeModel::QuarterSpace, None).key();
        let own = Draft::of(&case, Form::Factors);
        // What fatigue is judged by is no part of a scene.
        let of_scene = |path: &str| !path.starts_with("fatigue.");
        for number in KEYS.iter().filter(|number| number.fits(&own) && of_scene(number.path)) {
            let changed = |factor: f64| {
                let mut draft = own.clone().named("other");
                match number.get(&draft) {
                    Some(0.0) | None => number.set(&mut draft, (factor - 1.0) * 1e-3),
                    Some(value) => number.set(&mut draft, factor * value),
                }
                key(&draft)
            };
            // A traction along x changes no pressure.
            let others = [
                "roller.radius_m",
                "block.radius_m",
                "dimensionless.W",
                "sliding.friction",
                "cells.half_width_m",
            ];
            let shared = others.contains(&number.path);
            assert_eq!(changed(1.01) == key(&own), shared, "{}", number.path);
            assert_eq!(changed(1.0 + 1e-15), key(&own), "{}", number.path);
        }
        let scene = |model, psi| Scene::new(&case, model, psi).key();
        let guilbault = scene(EdgeModel::Guilbault, None);
        assert_ne!(guilbault, scene(EdgeModel::Mirror, None));
        assert_ne!(guilbault, scene(EdgeModel::Guilbault, Some(1.2)));
    }

    #[test]
    fn groups_keep_the_order_and_what_has_no_key_stands_alone() {
        let case = builtin_case("half-short").unwrap().unwrap();
        let key = |tolerance: f64| {
            let case = case.clone().with_tolerance(tolerance);
            Some(Scene::new(&case, EdgeModel::QuarterSpace, None).key())
        };
        let keys = [key(1e-2), None, key(1e-3), key(1e-2), None];
        assert_eq!(groups(keys), [vec![0, 3], vec![1], vec![2], vec![4]]);
    }
}
