//! FEM results as a reference of a study: recorded or live curves. The difference of the two finest
//! meshes is FEM's own error at each point.

use super::run::{Provenance, Reference};
use crate::fem::{self, MeshResult};

/// The reference of a record or of a live run.
///
/// The error at a point is the difference of the two finest meshes; a single mesh has none. It is
/// not multiplied by Richardson's factor, which requires a known order of convergence. The plain
/// difference exists for every curve.
pub fn from_fem(reference: &fem::FemResults) -> Reference {
    let finest = reference.finest();
    let curves = match reference.meshes.get(1) {
        Some(next) => finest.curves.clone().with_error_from(&next.curves),
        None => finest.curves.clone(),
    };
    let coarser = reference.meshes.iter().skip(1).map(|m| (m.size, m.curves.clone())).collect();
    let provenance = provenance(finest, reference.source == "live");
    Reference { curves, provenance, size: Some(finest.size), coarser }
}

fn provenance(mesh: &MeshResult, live: bool) -> Provenance {
    let summary = &mesh.summary;
    let text = |name: &str| summary.more.get(name).and_then(|v| v.as_str()).map(str::to_string);
    Provenance {
        live,
        date: text("date"),
        machine: Some(summary.processor().to_string()),
        command: text("command"),
        unknowns: Some(summary.unknowns as u64),
        seconds: Some(summary.total_seconds()),
        seconds_spread: None,
        stages: summary.seconds.clone(),
        versions: summary
            .versions
            .iter()
            .filter(|(name, _)| *name != "processor")
            .map(|(name, v)| {
                (name.clone(), v.as_str().map_or_else(|| v.to_string(), str::to_string))
            })
            .collect(),
        timed: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::curves::CURVE_NAMES;
    use crate::study::{Engine, Range, Source, errors};

    #[test]
    fn a_record_is_its_own_reference() {
        let mut seen = 0;
        for name in fem::FemResults::embedded_names() {
            let record = fem::FemResults::embedded(name).unwrap().unwrap();
            let reference = from_fem(&record);
            let ends = record.case.overlap();
            let again = (&Source::from(Engine::fenicsx()), &reference.curves);
            let rows =
                errors::compare(name, ends, &reference.curves, again, &Range::default()).unwrap();
            // Two lines with two ranges each, the curves of both bodies with eight quantities.
            let curves = reference.curves.stress.len();
            assert!(curves >= 2 * CURVE_NAMES.len());
            assert_eq!(rows.len(), 4 + curves * 8, "{name}");
            assert!(rows.iter().all(|r| r.max == 0.0 && r.points > 10), "{name}");
            let stated = rows.iter().all(|r| r.ref_error_max.is_some());
            assert_eq!(stated, record.meshes.len() > 1, "{name}");
            assert!(reference.provenance.seconds.is_some_and(|s| s > 0.0));
            assert!(!reference.provenance.live);
            seen += 1;
        }
        assert_eq!(seen, fem::FemResults::embedded_names().count());
    }
}
