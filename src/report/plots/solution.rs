//! The plots of one solution: pressure, and stresses of both bodies on the standard curves, in mm
//! and MPa.

use super::symbol::symbol;
use crate::base::{BodyKind, HertzScales};
use crate::case::Case;
use crate::cells::Heights;
use crate::report::draw::{Colour, Figure, Look, Map, Marker, Panel, Rule, Series, Shade};
use crate::solve::{PEAK_CURVE, PressureCell, Solution};
use crate::stress::{EDGE, Quantity, away_from_edges};

const MM: f64 = 1e3;
const MPA: f64 = 1e-6;

/// Von Mises stress and the component that free ends change most.
const SHOWN: [Quantity; 2] = [Quantity::Stress(1), Quantity::VonMises];

/// The lines into the bodies and along them, with what they are called in legends.
const DOWN: [(&str, &str); 5] = [
    ("depth-centre", "centre"),
    ("depth-0.9", "0.9 of the half-length"),
    ("depth-end", "end"),
    ("depth-0.9-neg", "0.9 at the −y end"),
    ("depth-end-neg", "−y end"),
];
const ALONG: [(&str, &str); 3] = [
    ("surface-along-y", "surface"),
    ("along-y-0.5C", "0.5 C deep"),
    ("along-y-0.78C", "0.78 C deep"),
];

/// Under the largest pressure of a rough contact.
const PEAK: [(&str, &str); 1] = [(PEAK_CURVE, "under the largest pressure")];

/// Most lines of a map in each direction; cells that lie closer are thinned out.
const MOST_LINES: f64 = 400.0;

/// A solution in the units of its plots.
struct Plots<'a, D> {
    solution: &'a Solution<D>,
    /// Name of the case and of what solved it.
    title: String,
    hertz: HertzScales,
    /// The ends of the overlap (C).
    ends: [f64; 2],
}

/// The plots of `solution` by the names of their files: pressure, its map, and for each body that
/// has curves its stresses. `by` names what solved the case.
pub fn of_solution<D>(case: &Case, by: &str, solution: &Solution<D>) -> Vec<(String, Figure)> {
    let plots = Plots {
        solution,
        title: format!("{}, {by}", case.name),
        hertz: solution.curves.hertz,
        ends: case.overlap(),
    };
    let mut figures =
        vec![("pressure".to_string(), plots.pressure()), ("pressure-map".to_string(), plots.map())];
    if let Some(heights) = case.heights() {
        figures.push(("heights".to_string(), plots.heights(&heights)));
    }
    figures.extend(profile(case, &plots.title, solution).map(|figure| ("profile".into(), figure)));
    for body in BodyKind::ALL {
        for (place, axis, lines) in
            [("along", 1, &ALONG[..]), ("depth", 2, &DOWN), ("peak", 2, &PEAK)]
        {
            let figure = plots.stress(body, axis, lines);
            if figure.panels.iter().all(|panel| !panel.series.is_empty()) {
                figures.push((format!("{place}-{}", body.name()), figure));
            }
        }
    }
    figures
}

/// Points of a profile's line.
const PROFILE_POINTS: usize = 201;
const ROUGH_POINTS: usize = 801;

/// The profiles of both bodies, and the gap between them before they are loaded but tilted as they
/// are then; none between straight and parallel bodies.
fn profile<D>(case: &Case, title: &str, solution: &Solution<D>) -> Option<Figure> {
    const UM: f64 = 1e6;
    let summary = &solution.summary;
    let profiles = BodyKind::ALL.map(|body| case.profile(body));
    let heights = case.heights();
    if profiles.iter().all(Option::is_none) && summary.tilt_rad == 0.0 && heights.is_none() {
        return None;
    }
    let points = if heights.is_some() { ROUGH_POINTS } else { PROFILE_POINTS };
    let ends = BodyKind::ALL.map(|body| case.ends_m(body));
    let places = |[from, to]: [f64; 2]| {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        // Some profiles have no drop at the very end.
        let share = move |i: usize| 0.9999 * (2.0 * i as f64 / (points - 1) as f64 - 1.0);
        (0..points).map(move |i| middle + half * share(i))
    };
    let drop = |body: usize, y: f64| {
        let middle = 0.5 * (ends[body][0] + ends[body][1]);
        profiles[body].as_ref().map_or(0.0, |profile| profile.drop(y - middle))
    };
    let line = |(body, look): (usize, Look)| {
        profiles[body].as_ref()?;
        let points = places(ends[body]).map(|y| (y * MM, drop(body, y) * UM)).collect();
        Some(Series { markers: false, ..Series::curve(BodyKind::ALL[body].name(), look, points) })
    };
    let both = case.overlap_m();
    let middle = 0.5 * (both[0] + both[1]);
    let height = |y: f64| heights.as_ref().map_or(0.0, |heights| heights.at(0.0, y - middle));
    let gap = |y: f64| drop(0, y) + drop(1, y) - height(y) - summary.tilt_rad * y;
    let gaps: Vec<(f64, f64)> = places(both).map(|y| (y, gap(y))).collect();
    let least = gaps.iter().map(|(_, gap)| *gap).fold(f64::INFINITY, f64::min);
    let gaps = gaps.into_iter().map(|(y, gap)| (y * MM, (gap - least) * UM)).collect();
    let [look, ..] = looks();
    let [from, to] = summary.contact_y_m;
    let panel = |title: &str, y_label: &str, series: Vec<Series>| Panel {
        title: title.into(),
        x_label: "y (mm)".into(),
        y_label: y_label.into(),
        series,
        ..Panel::default()
    };
    let gap = Series { markers: false, ..Series::curve("", look, gaps) };
    let gap = Panel {
        rules: [from, to].map(|y| Rule::Vertical(y * MM, String::new())).into(),
        ..panel("Gap before the load, x = 0; dashed: the contact's ends", "gap (µm)", vec![gap])
    };
    let drops: Vec<Series> = (0..2).zip(looks()).filter_map(line).collect();
    let drops = (!drops.is_empty()).then(|| panel("Profile", "drop (µm)", drops));
    Some(Figure {
        title: format!("{title}: profile and gap"),
        columns: 2,
        panels: drops.into_iter().chain([gap]).collect(),
        panel_size: (470, 310),
    })
}

/// The looks of the curves of one panel, told apart without colour too.
fn looks() -> [Look; 5] {
    let look = |rgb, dash, marker| Look { colour: Colour { name: "", rgb }, dash, marker };
    [
        look([0x00, 0x72, 0xb2], None, Marker::Circle),
        look([0xd5, 0x5e, 0x00], Some((7.0, 3.0)), Marker::Triangle),
        look([0x00, 0x8c, 0x67], Some((2.0, 3.0)), Marker::Square),
        look([0xb0, 0x60, 0x95], Some((9.0, 3.0)), Marker::Cross),
        look([0x7a, 0x5c, 0x00], Some((1.0, 2.0)), Marker::Diamond),
    ]
}

impl<D> Plots<'_, D> {
    /// Whether a point's value is that of a singular edge, for which axes make no room.
    fn at_edge(&self, at: [f64; 3]) -> bool {
        !away_from_edges(at, self.ends, EDGE)
    }

    /// The edges' surroundings on an axis along y.
    fn shades(&self) -> Vec<Shade> {
        let mm = |y: f64| y * self.hertz.c_m * MM;
        let shade = |end: f64| Shade {
            from: mm(end - EDGE),
            to: mm(end + EDGE),
            name: "within 0.1 C of an edge".into(),
        };
        self.ends.map(shade).into()
    }

    /// One curve from its places (C) and values (p0).
    fn series(
        &self,
        name: &str,
        look: Look,
        axis: usize,
        points: impl Iterator<Item = ([f64; 3], f64)>,
    ) -> Series {
        let points: Vec<([f64; 3], f64)> = points.collect();
        let HertzScales { c_m, p0_pa, .. } = self.hertz;
        let place = |(at, value): &([f64; 3], f64)| (at[axis] * c_m * MM, value * p0_pa * MPA);
        Series {
            beyond: points.iter().map(|(at, _)| self.at_edge(*at)).collect(),
            ..Series::curve(name, look, points.iter().map(place).collect())
        }
    }

    /// The pressure on both lines, and the load per length.
    fn pressure(&self) -> Figure {
        let [look, ..] = looks();
        let pressure = |title: &str, name: &str, axis: usize, x_label: &str| {
            let line = self.solution.curves.line(name);
            let points = line.into_iter().flat_map(|line| line.at.iter().zip(&line.p));
            let points = points.map(|(&[x, y], &p)| ([x, y, 0.0], p));
            Panel {
                title: title.into(),
                x_label: x_label.into(),
                y_label: "p (MPa)".into(),
                series: vec![self.series("", look, axis, points)],
                ..Panel::default()
            }
        };
        let HertzScales { c_m, p0_pa, .. } = self.hertz;
        let loads = self.solution.line_loads.iter();
        let loads = loads.map(|line| (line.y * c_m * MM, line.load * c_m * p0_pa * 1e-3)).collect();
        let load = Panel {
            title: "Load per length".into(),
            x_label: "y (mm)".into(),
            y_label: "q (N/mm)".into(),
            series: vec![Series::curve("", look, loads)],
            ..Panel::default()
        };
        let along = pressure("Along the contact line, x = 0", "along-y", 1, "y (mm)");
        Figure {
            title: format!("{}: contact pressure", self.title),
            columns: 3,
            panels: vec![
                Panel { shades: self.shades(), ..along },
                pressure("Across the contact, in its middle", "along-x", 0, "x (mm)"),
                load,
            ],
            panel_size: (380, 320),
        }
    }

    /// The pressure over the whole contact.
    fn map(&self) -> Figure {
        let p0_pa = self.hertz.p0_pa;
        // Beside a singular edge the colours end with the largest value outside.
        let cells = &self.solution.cells;
        let outside = cells.iter().filter(|cell| !self.at_edge([cell.x, cell.y, 0.0]));
        let most = outside.map(|cell| cell.p).fold(0.0, f64::max);
        let capped = cells.iter().any(|cell| cell.p > most);
        let label = if capped { "p (MPa), as far as 0.1 C from the ends" } else { "p (MPa)" };
        let limit = most * p0_pa * MPA;
        self.map_of("contact pressure", (label, limit), |cell| cell.p * p0_pa * MPA)
    }

    /// The heights over the whole contact.
    fn heights(&self, heights: &Heights) -> Figure {
        let c_m = self.hertz.c_m;
        let middle = 0.5 * (self.ends[0] + self.ends[1]);
        let height = |cell: &PressureCell| heights.at(cell.x * c_m, (cell.y - middle) * c_m);
        self.map_of("heights", ("height (µm)", f64::INFINITY), |cell| height(cell) * 1e6)
    }

    /// A `value` over the whole contact, with its label and its [`Map::limit`].
    fn map_of(
        &self,
        what: &str,
        (label, limit): (&str, f64),
        value: impl Fn(&PressureCell) -> f64,
    ) -> Figure {
        let c_m = self.hertz.c_m;
        let cells = &self.solution.cells;
        let lines = |of: &dyn Fn(usize) -> f64| {
            let mut all: Vec<f64> = (0..cells.len()).map(of).collect();
            all.sort_by(f64::total_cmp);
            let apart = (all[all.len() - 1] - all[0]) / MOST_LINES;
            all.dedup_by(|next, kept| *next - *kept < apart);
            all
        };
        let (ys, xs) = (lines(&|i| cells[i].y), lines(&|i| cells[i].x));
        let mut values = vec![0.0; ys.len() * xs.len()];
        let place = |all: &[f64], v: f64| all.binary_search_by(|a| a.total_cmp(&v)).ok();
        for cell in cells {
            if let (Some(i), Some(j)) = (place(&ys, cell.y), place(&xs, cell.x)) {
                values[j * ys.len() + i] = value(cell);
            }
        }
        let axes = [ys, xs].map(|axis| axis.iter().map(|v| v * c_m * MM).collect());
        let map = Map { label: label.into(), axes, down: false, values, limit };
        let title = format!("{}: {what}", self.title);
        Figure::of_map(title, ["y (mm)", "x (mm)"], map)
    }

    /// The stresses of a body on some lines, `axis` along which they run.
    fn stress(&self, body: BodyKind, axis: usize, lines: &[(&str, &str)]) -> Figure {
        let panel = |of: Quantity| {
            let curves = lines.iter().zip(looks()).filter_map(|(&(name, label), look)| {
                let curve = self.solution.curves.curve(body, name)?;
                let points = curve.at.iter().zip(&curve.stress).map(|(at, s)| (*at, of.of(s)));
                Some(self.series(label, look, axis, points))
            });
            Panel {
                x_label: ["x (mm)", "y (mm)", "z (mm)"][axis].into(),
                y_label: format!("{} (MPa)", symbol(of)),
                series: curves.collect(),
                shades: if axis == 1 { self.shades() } else { Vec::new() },
                ..Panel::default()
            }
        };
        let place = match lines[0] {
            (PEAK_CURVE, _) => "under the largest pressure",
            _ if axis == 1 => "along the contact, x = 0",
            _ => "into the body, x = 0",
        };
        Figure {
            title: format!("{}: {} {place}", self.title, body.name()),
            columns: 2,
            panels: SHOWN.map(panel).into(),
            panel_size: (500, 300),
        }
    }
}
