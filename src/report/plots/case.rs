//! The plots of one case: pressure and stresses of all sources on the standard curves.

use super::symbol::Shown;
use crate::base::{BodyKind, StressTensor};
use crate::report::brought::{FileCurves, Plots, of_case, plain};
use crate::report::draw::{Figure, Panel, Series, Shade, look};
use crate::report::study_files::StudyFiles;
use crate::report::study_summary::CaseSummary;
use crate::stress::{Quantity, away_from_edge};
use crate::study::{CONTACT, Source};

/// Length of the surface that is shown before the roller's end (C). On the whole of a long roller
/// the end would be too narrow to read.
const LAST: f64 = 5.0;

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
            let half = self.case.slenderness;
            let beyond = points.iter().map(|(at, _)| !away_from_edge(*at, half, self.excluded()));
            (!points.is_empty()).then(|| Series {
                name,
                look: look(source),
                beyond: beyond.collect(),
                points: points.iter().map(|(at, value)| (at[axis as usize], *value)).collect(),
                line: !source.is_engine(),
                markers: true,
                band: own_errors,
            })
        };
        self.sources().into_iter().filter_map(series).collect()
    }

    /// Up to this distance from the roller's edge nothing is compared (C).
    fn excluded(&self) -> f64 {
        self.files.summary.range.stress_c
    }

    /// The part of an axis that is not compared; the curve meets the edge at its value `edge`.
    fn shade(&self, edge: f64) -> Option<Shade> {
        let (from, to) = (edge - self.excluded(), edge + self.excluded());
        Some(Shade { from, to, name: "not compared: singular edge".to_string() })
    }

    /// The last `length` of the y axis (C).
    fn before_the_end(&self, length: f64) -> Option<(f64, f64)> {
        let half = self.case.slenderness;
        Some(((half - length).max(0.0), half))
    }

    fn pressure(&self) -> Figure {
        let panel = |title: &str, line: &str, axis: Axis| Panel {
            title: title.to_string(),
            x_label: axis.label().to_string(),
            y_label: Shown::Pressure.symbol(),
            series: self.series(Curve::Pressure(line), axis),
            ..Default::default()
        };
        let along = |title: &str, length: f64| Panel {
            shade: self.shade(self.case.slenderness),
            x_range: self.before_the_end(length),
            ..panel(title, "along-y", Axis::Y)
        };
        Figure {
            title: format!("{}: contact pressure", self.case.name),
            columns: 3,
            panels: vec![
                along("along the contact line, x = 0", f64::INFINITY),
                along("last 2 C before the roller's end", 2.0),
                panel("across the contact, y = 0", "along-x", Axis::X),
            ],
            panel_size: (380, 330),
        }
    }

    /// The curves from files, each on its own points.
    fn brought(&self) -> Vec<(String, Figure)> {
        let (half, excluded) = (self.case.slenderness, self.excluded());
        let of_file = |file: FileCurves| {
            let name = &file.summary.name;
            let all = file.all.iter().map(|(source, curves)| (source.clone(), curves)).collect();
            let plots = Plots { name, all, ends: [-half, half], excluded };
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
            y_label: Shown::Stress(of).symbol(),
            series: self.series(Curve::Stress(body, name, of), axis),
            ..Default::default()
        }
    }

    fn surface(&self, body: BodyKind) -> Figure {
        let [xx, yy, zz] = ["sigma_xx", "sigma_yy", "sigma_zz"].map(component);
        let half = self.case.slenderness;
        let panel = |of: Quantity| Panel {
            shade: self.shade(half),
            x_range: self.before_the_end(LAST),
            ..self.stress(&Shown::Stress(of).symbol(), (body, "surface-along-y"), Axis::Y, of)
        };
        let part = if half > LAST { format!(", last {LAST} C") } else { String::new() };
        let (case, body) = (&self.case.name, body.name());
        Figure {
            title: format!("{case}: surface of the {body} along y{part} (x = 0, z = 0)"),
            columns: 3,
            panels: [xx, yy, zz, Quantity::VonMises, Quantity::TauMax].map(panel).into(),
            panel_size: (380, 300),
        }
    }

    fn depth(&self, body: BodyKind, quantities: &[Quantity], what: &str) -> Figure {
        let places = [
            ("depth-centre", "y = 0"),
            ("depth-0.9", "y = 0.9 L1/2"),
            ("depth-end", "y = L1/2 (end)"),
        ];
        let panels = quantities.iter().flat_map(|&of| {
            places.iter().map(move |&(curve, place)| {
                let title = format!("{}, {place}", Shown::Stress(of).symbol());
                Panel {
                    shade: if curve == "depth-end" { self.shade(0.0) } else { None },
                    ..self.stress(&title, (body, curve), Axis::Z, of)
                }
            })
        });
        Figure {
            title: format!("{}: {what} over depth in the {} (x = 0)", self.case.name, body.name()),
            columns: 3,
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
