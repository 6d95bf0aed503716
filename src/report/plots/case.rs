//! The plots of one case: pressure and stresses of all sources on the standard curves.

use super::symbol::in_p0;
use crate::base::{BodyKind, StressTensor};
use crate::report::brought::{FileCurves, Plots, of_case, plain};
use crate::report::draw::{Figure, Panel, Series, Shade, look};
use crate::report::study_files::StudyFiles;
use crate::report::study_summary::CaseSummary;
use crate::stress::{Quantity, Variable, away_from_edges};
use crate::study::{CONTACT, Source};

/// Lengths of the pressure and of the surface that are shown beside an end of the overlap (C). On
/// the whole of a long contact an end would be too narrow to read.
const LAST_PRESSURE: f64 = 2.0;
const LAST: f64 = 5.0;

/// Part of half the overlap by which a point lies beyond its middle if it is not there by rounding.
const BEYOND_MIDDLE: f64 = 1e-6;

/// The depth curves at the places along the contact, and where these are.
const DEPTHS: [(&str, &str); 3] =
    [("depth-centre", "middle"), ("depth-0.9", "0.9 of the half-length"), ("depth-end", "end")];
const DEPTHS_BEHIND: [(&str, &str); 2] =
    [("depth-0.9-neg", "0.9 at the −y end"), ("depth-end-neg", "−y end")];

/// A curve of a case and what it shows.
#[derive(Clone, Copy)]
enum Curve<'a> {
    /// The pressure on the line of this name.
    Pressure(&'a str),
    /// A scalar of the stress on a curve of a body.
    Stress(BodyKind, &'a str, Quantity),
}

/// An axis of a plot.
#[derive(Clone, Copy)]
enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    fn label(self) -> &'static str {
        ["x / C", "y / C", "z / C"][self as usize]
    }
}

/// The place (C) and the value (p0) of each point of a curve.
type Points = Vec<([f64; 3], f64)>;

/// One case of a run.
struct CasePlots<'a> {
    files: &'a StudyFiles,
    case: &'a CaseSummary,
}

impl<'a> CasePlots<'a> {
    /// The sources of the case. References come first: their points lie under the models' curves.
    fn sources(&self) -> Vec<&'a Source> {
        let own = self.files.study.iter().filter(|row| row.case == self.case.name);
        let mut all: Vec<&Source> = own.map(|row| &row.source).collect();
        all.sort_by_key(|source| !source.is_engine());
        all
    }

    /// The points of a source on a curve.
    fn points(&self, curve: Curve, source: &Source) -> Points {
        let name = &self.case.name;
        let point = |at_m: [f64; 3], value_pa| self.point(at_m, value_pa);
        let points: Points = match curve {
            Curve::Pressure(line) => {
                let rows = self.files.pressure.iter();
                rows.filter(|r| r.case == *name && r.source == *source && r.line == line)
                    .map(|r| point([r.at_m[0], r.at_m[1], 0.0], r.p_pa))
                    .collect()
            }
            Curve::Stress(body, curve, quantity) => {
                let rows = self.files.curves.iter();
                rows.filter(|r| r.body == body && r.case == *name && r.source == *source)
                    .filter(|r| r.curve == curve)
                    .map(|r| point(r.at_m, r.stress(quantity)))
                    .collect()
            }
        };
        points.into_iter().filter(|(_, value)| value.is_finite()).collect()
    }

    /// The own errors (p0) of a reference on a curve, where it states one for each of `points`
    /// points.
    fn own_errors(&self, curve: Curve, source: &Source, points: usize) -> Option<Vec<f64>> {
        let (body, curve, quantity) = match curve {
            Curve::Pressure(line) => (CONTACT, line, None),
            Curve::Stress(body, curve, quantity) => (body.name(), curve, Some(quantity)),
        };
        let rows = self.files.fem_error.iter().filter(|r| {
            r.body == body && r.case == self.case.name && r.curve == curve && r.source == *source
        });
        let error_pa = rows.filter_map(|r| quantity.map_or(r.pressure_pa, |q| r.stress(q)));
        let errors: Vec<f64> = error_pa.map(|e| e / self.case.hertz.p0_pa).collect();
        (errors.len() == points && points > 0).then_some(errors)
    }

    fn point(&self, at_m: [f64; 3], value_pa: f64) -> ([f64; 3], f64) {
        let hertz = &self.case.hertz;
        (at_m.map(|v| v / hertz.c_m), value_pa / hertz.p0_pa)
    }

    /// One series for each source that has the curve.
    fn series(&self, curve: Curve, axis: Axis) -> Vec<Series> {
        let series = |source: &Source| {
            let points = self.points(curve, source);
            let (whose, own_errors) = match source.is_engine() {
                true => (" (band: its own error)", self.own_errors(curve, source, points.len())),
                false => ("", None),
            };
            let name = format!("{}{whose}", source.title());
            let ends = self.case.overlap();
            let beyond = points.iter().map(|(at, _)| !away_from_edges(*at, ends, self.excluded()));
            let drawn = points.iter().map(|(at, value)| (at[axis as usize], *value)).collect();
            let series = Series {
                beyond: beyond.collect(),
                line: !source.is_engine(),
                ..Series::marks(&name, look(source), drawn)
            };
            (!points.is_empty()).then(|| series.within(own_errors))
        };
        self.sources().into_iter().filter_map(series).collect()
    }

    /// Up to this distance from an edge nothing is compared (C).
    fn excluded(&self) -> f64 {
        self.files.summary.range.stress_c
    }

    /// The part of an axis that is not compared; the curve meets the edge at its value `edge`.
    fn shade(&self, edge: f64) -> Shade {
        let (from, to) = (edge - self.excluded(), edge + self.excluded());
        Shade { from, to, name: format!("not compared: within {} C of an edge", self.excluded()) }
    }

    /// The parts of an axis along y that are not compared.
    fn shades_along(&self) -> Vec<Shade> {
        self.case.overlap().map(|end| self.shade(end)).into()
    }

    /// Whether the curves go over both halves of the contact, because it is not symmetric.
    fn is_two_sided(&self) -> bool {
        let [from, to] = self.case.overlap_m;
        let least = 0.5 * (from + to) - BEYOND_MIDDLE * (to - from);
        let mut rows = self.files.pressure.iter().filter(|row| row.case == self.case.name);
        rows.any(|row| row.line == "along-y" && row.at_m[1] < least)
    }

    /// Ranges of y (C) of this `length` beside the ends that the curves go to, and what they are
    /// called; the whole line where they would cover it.
    fn beside_ends(&self, length: f64) -> Vec<(f64, f64, &'static str)> {
        let [from, to] = self.case.overlap();
        if !self.is_two_sided() {
            return vec![((0.5 * (from + to)).max(to - length), to, "end")];
        }
        if to - from <= 2.0 * length {
            return vec![(from, to, "both ends")];
        }
        vec![(from, from + length, "−y end"), (to - length, to, "+y end")]
    }

    fn pressure(&self) -> Figure {
        let panel = |title: &str, line: &str, axis: Axis| Panel {
            title: title.to_string(),
            x_label: axis.label().to_string(),
            y_label: in_p0(Variable::Pressure),
            series: self.series(Curve::Pressure(line), axis),
            ..Default::default()
        };
        let along =
            |title: &str| Panel { shades: self.shades_along(), ..panel(title, "along-y", Axis::Y) };
        let ends = self.beside_ends(LAST_PRESSURE).into_iter().map(|(from, to, place)| Panel {
            x_range: Some((from, to)),
            ..along(&format!("{LAST_PRESSURE} C beside the {place}"))
        });
        let mut panels = vec![along("along the contact line, x = 0")];
        panels.extend(ends);
        panels.push(panel("across the contact, in the middle", "along-x", Axis::X));
        Figure {
            title: format!("{}: contact pressure", self.case.name),
            columns: panels.len(),
            panels,
            panel_size: (380, 330),
        }
    }

    /// The curves from files, each on its own points.
    fn brought(&self) -> Vec<(String, Figure)> {
        let (ends, excluded) = (self.case.overlap(), self.excluded());
        let of_file = |file: FileCurves| {
            let name = &file.summary.name;
            let all = file.all.iter().map(|(source, curves)| (source.clone(), curves)).collect();
            let plots = Plots { name, all, ends, excluded };
            let named = |(curve, figure)| (format!("{name}-{curve}"), figure);
            plots.figures().into_iter().map(named).collect::<Vec<_>>()
        };
        let all = of_case(self.files, self.case).into_iter().flat_map(of_file).enumerate();
        let named = |(i, (name, figure)): (usize, (String, Figure))| {
            (plain(&format!("{}-brought-{:02}-{name}", self.case.name, i + 1)), figure)
        };
        all.map(named).collect()
    }

    /// A panel of one quantity on one curve of a body.
    fn stress(&self, title: &str, curve: (BodyKind, &str), axis: Axis, of: Quantity) -> Panel {
        let (body, name) = curve;
        Panel {
            title: title.to_string(),
            x_label: axis.label().to_string(),
            y_label: in_p0(Variable::Stress(of)),
            series: self.series(Curve::Stress(body, name, of), axis),
            ..Default::default()
        }
    }

    fn surface(&self, body: BodyKind) -> Figure {
        let [xx, yy, zz] = ["sigma_xx", "sigma_yy", "sigma_zz"].map(component);
        let shown = self.beside_ends(LAST);
        let panels = |of: Quantity| {
            let symbol = in_p0(Variable::Stress(of));
            let whole = self.stress(&symbol, (body, "surface-along-y"), Axis::Y, of);
            let panel = |&(from, to, place): &(f64, f64, &str)| Panel {
                title: if shown.len() > 1 { format!("{symbol}, {place}") } else { symbol.clone() },
                shades: self.shades_along(),
                x_range: Some((from, to)),
                ..whole.clone()
            };
            shown.iter().map(panel).collect::<Vec<_>>()
        };
        let [from, to] = self.case.overlap();
        let shorter = shown.iter().any(|(a, b, _)| b - a < 0.499 * (to - from));
        let part = if shorter { format!(", {LAST} C beside the end") } else { String::new() };
        let (case, body) = (&self.case.name, body.name());
        let all = [xx, yy, zz, Quantity::VonMises, Quantity::TauMax];
        Figure {
            title: format!("{case}: surface of the {body} along y{part} (x = 0, z = 0)"),
            columns: if shown.len() > 1 { 4 } else { 3 },
            panels: all.into_iter().flat_map(panels).collect(),
            panel_size: (380, 300),
        }
    }

    fn depth(&self, body: BodyKind, quantities: &[Quantity], what: &str) -> Figure {
        let behind = if self.is_two_sided() { &DEPTHS_BEHIND[..] } else { &[] };
        let places: Vec<_> = DEPTHS.iter().chain(behind).collect();
        let panel = |of: Quantity, (curve, place): &(&str, &str)| {
            let title = format!("{}, {place}", in_p0(Variable::Stress(of)));
            let at_edge = curve.starts_with("depth-end");
            Panel {
                shades: at_edge.then(|| self.shade(0.0)).into_iter().collect(),
                ..self.stress(&title, (body, curve), Axis::Z, of)
            }
        };
        let panels = quantities.iter().flat_map(|&of| places.iter().map(move |p| panel(of, p)));
        Figure {
            title: format!("{}: {what} over depth in the {} (x = 0)", self.case.name, body.name()),
            columns: places.len(),
            panels: panels.collect(),
            panel_size: (380, 290),
        }
    }
}

/// The component of this name.
fn component(name: &str) -> Quantity {
    let index = StressTensor::NAMES.iter().position(|n| *n == name).expect("a component's name");
    Quantity::ALL[index]
}

/// The plots of all cases, by name.
pub(super) fn figures(files: &StudyFiles) -> Vec<(String, Figure)> {
    let mut plots: Vec<(String, Figure)> = Vec::new();
    let across = ["sigma_xx", "sigma_yy", "sigma_zz", "sigma_yz"].map(component);
    let invariants = [Quantity::VonMises, Quantity::TauMax];
    for case in &files.summary.cases {
        let (name, case) = (&case.name, CasePlots { files, case });
        plots.push((format!("{name}-pressure"), case.pressure()));
        for body in BodyKind::ALL {
            let of = body.name();
            plots.push((format!("{name}-surface-{of}"), case.surface(body)));
            plots.push((format!("{name}-depth-{of}"), case.depth(body, &across, "stresses")));
            let equivalent = case.depth(body, &invariants, "equivalent stresses");
            plots.push((format!("{name}-invariants-{of}"), equivalent));
        }
        plots.extend(case.brought());
    }
    plots
}
