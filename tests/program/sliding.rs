//! Bodies that slide on each other, against recorded finite elements.

use edgeline::body::EdgeModel;
use edgeline::case::Case;
use edgeline::fem::FemResults;
use edgeline::solve::{Options, SolvedCase};
use edgeline::stress::{BodyKind, EDGE, away_from_edge};
use std::path::Path;

/// Largest root mean square of a component on a curve, of each body, and largest difference (p0).
const RMS: [(BodyKind, f64); 2] = [(BodyKind::Block, 0.005), (BodyKind::Roller, 0.006)];
const LARGEST: f64 = 0.02;

#[test]
fn stresses_under_friction_are_those_of_finite_elements() {
    for name in ["sliding-flush", "sliding-half", "sliding-steel-aluminium"] {
        let case = Case::find(Path::new(name)).unwrap();
        let recorded = FemResults::embedded_of(&case).unwrap().expect(name);
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap();
        let curves = solved.solution().curves;
        let half_length = case.factors().slenderness;
        for (body, limit) in RMS {
            let (mut rms, mut largest) = (0.0, 0.0);
            let (mut worst, mut place) = (String::new(), String::new());
            let own = recorded.finest().curves.stress.iter().filter(|c| c.body == body);
            for want in own {
                let got = curves.curve(body, &want.name).expect("the same curves");
                for component in 0..6 {
                    let pairs = want.at.iter().zip(want.stress.iter().zip(&got.stress));
                    let away = pairs.filter(|(at, _)| away_from_edge(**at, half_length, EDGE));
                    let differences = away.map(|(at, (want, got))| {
                        (*at, (want.components()[component] - got.components()[component]).abs())
                    });
                    let differences: Vec<([f64; 3], f64)> = differences.collect();
                    let sum: f64 = differences.iter().map(|(_, d)| d * d).sum();
                    let own = (sum / differences.len() as f64).sqrt();
                    if own > rms {
                        (rms, worst) = (own, format!("{} component {component}", want.name));
                    }
                    for (at, d) in differences {
                        if d > largest {
                            (largest, place) = (d, format!("{} {component} at {at:?}", want.name));
                        }
                    }
                }
            }
            println!(
                "{name}, {}: RMS {rms:.4} ({worst}), largest {largest:.4} ({place})",
                body.name()
            );
            assert!(rms <= limit, "{name}, {}: {rms} on {worst}", body.name());
            assert!(largest <= LARGEST, "{name}, {}: {largest} on {place}", body.name());
        }
        assert_eq!(recorded.finest().curves.stress.len(), 2 * 19);
    }
}
