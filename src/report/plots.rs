//! The plots of a study, from the files of its run.

use super::draw::{Bar, Figure, Look, Marker, Note, Panel, Rule, Series, Shade, look};
use super::effects_text::{TOLD, label};
use super::study_files::StudyFiles;
use super::table::Table;
use crate::stress::away_from_edge;
use crate::study::response::Response;
use std::collections::BTreeMap;

/// Names of the quantities with their symbols, for axes.
pub const SYMBOLS: [(&str, &str); 9] = [
    ("pressure", "p / p0"),
    ("sigma_xx", "σxx / p0"),
    ("sigma_yy", "σyy / p0"),
    ("sigma_zz", "σzz / p0"),
    ("sigma_xy", "σxy / p0"),
    ("sigma_xz", "σxz / p0"),
    ("sigma_yz", "σyz / p0"),
    ("von_mises", "von Mises / p0"),
    ("tau_max", "τmax / p0"),
];

fn symbol(quantity: &str) -> &'static str {
    SYMBOLS.iter().find(|(name, _)| *name == quantity).map_or("", |(_, s)| s)
}

/// How much of a surface before the roller's end is shown (C): what happens at the end has no room
/// on the whole of a long roller.
const LAST: f64 = 5.0;

/// One case's rows of a table, with its scales.
struct Case<'a> {
    files: &'a StudyFiles,
    name: &'a str,
    c_m: f64,
    p0_pa: f64,
    half_length: f64,
}

/// Rows of a table whose columns have the given texts.
fn rows<'a>(table: &'a Table, filter: &[(&str, &str)]) -> Vec<&'a Vec<String>> {
    let columns: Vec<(usize, &str)> =
        filter.iter().filter_map(|(name, v)| Some((table.column(name)?, *v))).collect();
    table.rows.iter().filter(|r| columns.iter().all(|(c, v)| r[*c] == *v)).collect()
}

impl<'a> Case<'a> {
    fn all(files: &'a StudyFiles) -> Vec<Case<'a>> {
        let mut cases: Vec<Case> = Vec::new();
        for row in &files.study.rows {
            let name = files.study.text(row, "case");
            let number = |column| files.study.number(row, column);
            let (c, p0, s) = (number("c_m"), number("p0_pa"), number("S_l"));
            if let (Some(c_m), Some(p0_pa), Some(half_length)) = (c, p0, s)
                && !cases.iter().any(|c| c.name == name)
            {
                cases.push(Case { files, name, c_m, p0_pa, half_length });
            }
        }
        cases
    }

    /// Sources, FEM first: its points are drawn under the methods' curves.
    fn sources(&self) -> Vec<&'a str> {
        let study = &self.files.study;
        let of_case = rows(study, &[("case", self.name)]);
        let mut all: Vec<&str> = of_case.iter().map(|r| study.text(r, "source")).collect();
        all.sort_by_key(|source| *source != "fem");
        all
    }

    /// Points (coordinate, value) of a table in units of C and p0, and the error of FEM at them.
    fn points(&self, table: &Table, filter: &[(&str, &str)], x: &str, y: &str) -> Vec<(f64, f64)> {
        let mut filter = filter.to_vec();
        filter.push(("case", self.name));
        let (Some(x), Some(y)) = (table.column(x), table.column(y)) else { return Vec::new() };
        rows(table, &filter)
            .iter()
            .filter_map(|r| {
                let (x, y) = (r[x].parse::<f64>().ok()?, r[y].parse::<f64>().ok()?);
                Some((x / self.c_m, y / self.p0_pa))
            })
            .collect()
    }

    /// One series for each source: `value` over `coordinate`.
    fn series(
        &self,
        table: &Table,
        filter: &[(&str, &str)],
        axis: &str,
        value: &str,
    ) -> Vec<Series> {
        let coordinate = format!("{axis}_m");
        self.sources()
            .into_iter()
            .filter_map(|source| {
                let mut with_source = filter.to_vec();
                with_source.push(("source", source));
                let points = self.points(table, &with_source, &coordinate, value);
                let fem = source == "fem";
                let band = fem.then(|| self.band(filter, &coordinate, value, points.len()));
                let beyond = self.beyond(table, &with_source);
                (!points.is_empty()).then(|| Series {
                    name: if fem { "FEM (band: its own error)" } else { source }.to_string(),
                    look: look(source),
                    points,
                    line: !fem,
                    markers: true,
                    band: band.flatten(),
                    beyond,
                })
            })
            .collect()
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
        Some(((self.half_length - length).max(0.0), self.half_length))
    }

    /// Which points of a curve lie where nothing is compared: values are singular there.
    fn beyond(&self, table: &Table, filter: &[(&str, &str)]) -> Vec<bool> {
        let mut filter = filter.to_vec();
        filter.push(("case", self.name));
        // Tables round coordinates.
        let excluded = self.excluded() * (1.0 - 1e-6);
        rows(table, &filter)
            .iter()
            .map(|r| {
                let at =
                    ["x_m", "y_m", "z_m"].map(|v| table.number(r, v).unwrap_or(0.0) / self.c_m);
                !away_from_edge(at, self.half_length, excluded)
            })
            .collect()
    }

    /// FEM's own error at the points of a curve, where every one of them has it.
    fn band(&self, filter: &[(&str, &str)], axis: &str, value: &str, n: usize) -> Option<Vec<f64>> {
        let filter: Vec<(&str, &str)> = filter
            .iter()
            .map(|&(name, v)| if name == "line" { ("curve", v) } else { (name, v) })
            .chain(filter.iter().any(|f| f.0 == "line").then_some(("body", "contact")))
            .collect();
        let value = if value == "p_pa" { "pressure_pa" } else { value };
        let band: Vec<f64> =
            self.points(&self.files.fem_error, &filter, axis, value).iter().map(|p| p.1).collect();
        (band.len() == n && n > 0).then_some(band)
    }

    fn pressure(&self) -> Figure {
        let table = &self.files.pressure;
        let panel = |title: &str, line: &str, axis: &str| Panel {
            title: title.to_string(),
            x_label: format!("{axis} / C"),
            y_label: symbol("pressure").to_string(),
            series: self.series(table, &[("line", line)], axis, "p_pa"),
            ..Default::default()
        };
        let along = |title: &str, length: f64| Panel {
            shade: self.shade(self.half_length),
            x_range: self.before_the_end(length),
            ..panel(title, "along-y", "y")
        };
        Figure {
            title: format!("{}: contact pressure", self.name),
            columns: 3,
            panels: vec![
                along("along the contact line, x = 0", f64::INFINITY),
                along("last 2 C before the roller's end", 2.0),
                panel("across the contact, y = 0", "along-x", "x"),
            ],
            panel_size: (380, 330),
        }
    }

    /// A panel of one quantity on one curve of a body.
    fn stress(&self, title: &str, body: &str, curve: &str, axis: &str, quantity: &str) -> Panel {
        let filter = [("body", body), ("curve", curve)];
        Panel {
            title: title.to_string(),
            x_label: format!("{axis} / C"),
            y_label: symbol(quantity).to_string(),
            series: self.series(&self.files.curves, &filter, axis, &format!("{quantity}_pa")),
            ..Default::default()
        }
    }

    fn surface(&self, body: &str) -> Figure {
        let quantities = ["sigma_xx", "sigma_yy", "sigma_zz", "von_mises", "tau_max"];
        let panel = |quantity: &str| Panel {
            shade: self.shade(self.half_length),
            x_range: self.before_the_end(LAST),
            ..self.stress(symbol(quantity), body, "surface-along-y", "y", quantity)
        };
        let part = if self.half_length > LAST { format!(", last {LAST} C") } else { String::new() };
        Figure {
            title: format!("{}: surface of the {body} along y{part} (x = 0, z = 0)", self.name),
            columns: 3,
            panels: quantities.map(panel).into(),
            panel_size: (380, 300),
        }
    }

    fn depth(&self, body: &str, quantities: &[&str], what: &str) -> Figure {
        let places = [
            ("depth-centre", "y = 0"),
            ("depth-0.9", "y = 0.9 L1/2"),
            ("depth-end", "y = L1/2 (end)"),
        ];
        let panels = quantities.iter().flat_map(|q| {
            places.iter().map(move |(curve, place)| Panel {
                shade: if *curve == "depth-end" { self.shade(0.0) } else { None },
                ..self.stress(&format!("{}, {place}", symbol(q)), body, curve, "z", q)
            })
        });
        Figure {
            title: format!("{}: {what} over depth in the {body} (x = 0)", self.name),
            columns: 3,
            panels: panels.collect(),
            panel_size: (380, 290),
        }
    }
}

/// Rows of `effects.csv` of one method and response.
struct EffectRows<'a> {
    look: Look,
    table: &'a Table,
    rows: Vec<&'a Vec<String>>,
    unit: &'static str,
}

impl<'a> EffectRows<'a> {
    fn of(files: &'a StudyFiles, method: &str, response: Response) -> Option<Self> {
        let table = &files.effects;
        let rows = rows(table, &[("method", method), ("response", &response.name())]);
        (!rows.is_empty()).then(|| Self { look: look(method), table, rows, unit: response.unit() })
    }

    fn number(&self, row: &[String], name: &str) -> f64 {
        self.table.number(row, name).unwrap_or(f64::NAN)
    }

    fn limits(&self) -> [(f64, String); 2] {
        let get = |name| self.rows.first().map_or(f64::NAN, |r| self.number(r, name));
        [(get("me"), "ME".to_string()), (get("sme"), "SME".to_string())]
    }

    fn half_normal(&self, response: Response) -> Panel {
        let points: Vec<(f64, f64)> = self
            .rows
            .iter()
            .map(|r| (self.number(r, "half_normal_quantile"), self.number(r, "effect").abs()))
            .collect();
        // Names of those that stand out, and of the largest two in any case: the small ones lie close
        // together and are noise.
        let mut largest: Vec<f64> = points.iter().map(|p| p.1).collect();
        largest.sort_by(|a, b| b.total_cmp(a));
        let second = largest.get(1).copied().unwrap_or(0.0);
        let notes = self.rows.iter().zip(&points).filter_map(|(r, &at)| {
            let named = at.1 >= second || self.table.text(r, "verdict") != "noise";
            named.then(|| Note { at, text: self.table.text(r, "term").replace(" x ", " × ") })
        });
        Panel {
            title: label(response),
            x_label: "half-normal quantile".to_string(),
            y_label: format!("|effect| ({})", self.unit),
            series: vec![Series::marks("", self.look, points.clone())],
            notes: notes.collect(),
            rules: self
                .limits()
                .into_iter()
                .filter(|(v, _)| v.is_finite())
                .map(|(v, name)| Rule::Horizontal(v, name))
                .chain([Rule::Horizontal(0.0, String::new())])
                .collect(),
            x_range: Some((0.0, 2.1)),
            ..Default::default()
        }
    }

    fn pareto(&self, response: Response) -> Panel {
        let mut bars: Vec<Bar> = self
            .rows
            .iter()
            .map(|r| Bar {
                name: self.table.text(r, "term").replace(" x ", " × "),
                value: self.number(r, "effect").abs(),
                colour: self.look.colour,
                strong: self.table.text(r, "verdict") == "active",
            })
            .collect();
        bars.sort_by(|a, b| b.value.total_cmp(&a.value));
        Panel {
            title: label(response),
            x_label: format!("|effect| ({}); full: beyond SME", self.unit),
            bars,
            rules: self
                .limits()
                .into_iter()
                .filter(|(v, _)| v.is_finite())
                .map(|(v, name)| Rule::Vertical(v, name))
                .collect(),
            ..Default::default()
        }
    }
}

/// Texts in the order of the numbers that they are, each once.
fn ascending<'a>(texts: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut all: Vec<&str> = texts.collect();
    let number = |text: &str| text.parse::<f64>().unwrap_or(0.0);
    all.sort_by(|a, b| number(a).total_cmp(&number(b)));
    all.dedup();
    all
}

/// Interaction plots of a response: its mean over the corners at each pair of levels of two factors, all in the
/// same limits.
fn interactions(files: &StudyFiles, method: &str, response: Response) -> Vec<Panel> {
    let names: Vec<&str> = files.summary.factors.iter().map(|f| f.name.name()).collect();
    let unit = response.unit();
    let pairs =
        names.iter().enumerate().flat_map(|(i, a)| names[i + 1..].iter().map(move |b| (a, b)));
    let mut panels: Vec<Panel> = pairs
        .map(|(a, b)| Panel {
            y_label: format!("mean of the corners ({unit})"),
            ..interaction(&files.study, method, response, [a, b])
        })
        .collect();
    let means = panels.iter().flat_map(|p| &p.series).flat_map(|s| &s.points).map(|p| p.1);
    let range = Panel::limits_of(means);
    for panel in &mut panels {
        panel.y_range = Some(range);
    }
    panels
}

/// Means of a response over the first factor's levels, a line for each level of the second.
fn interaction(study: &Table, method: &str, response: Response, [a, b]: [&str; 2]) -> Panel {
    let column = response.name();
    // Texts as keys: the levels of one factor are printed alike in every row.
    let mut values: BTreeMap<(&str, &str), Vec<f64>> = BTreeMap::new();
    for row in rows(study, &[("source", method), ("role", "corner")]) {
        if let Some(value) = study.number(row, &column) {
            let key = (study.text(row, b), study.text(row, a));
            values.entry(key).or_default().push(value);
        }
    }
    let levels = ascending(values.keys().map(|k| k.1));
    let Look { colour, .. } = look(method);
    let looks = [
        Look { colour, dash: Some((6.0, 4.0)), marker: Marker::Square },
        Look { colour, dash: None, marker: Marker::Circle },
    ];
    let (mut series, mut notes) = (Vec::new(), Vec::new());
    for (line, look) in ascending(values.keys().map(|k| k.0)).into_iter().zip(looks) {
        let mean = |(x, level): (usize, &&str)| {
            let all = values.get(&(line, *level))?;
            Some((x as f64, all.iter().sum::<f64>() / all.len() as f64))
        };
        let means: Vec<(f64, f64)> = levels.iter().enumerate().filter_map(mean).collect();
        notes.extend(means.last().map(|at| Note { at: *at, text: format!("{b} = {line}") }));
        series.push(Series::curve("", look, means));
    }
    Panel {
        title: format!("{}: {a} × {b}", label(response)),
        x_label: a.to_string(),
        series,
        notes,
        x_names: levels.into_iter().map(String::from).collect(),
        ..Default::default()
    }
}

/// Run time against error: each method and FEM in each case.
fn time_and_error(files: &StudyFiles) -> Figure {
    let study = &files.study;
    let mut sources: Vec<&str> = Vec::new();
    for row in &study.rows {
        let source = study.text(row, "source");
        if !sources.contains(&source) {
            sources.push(source);
        }
    }
    let panel = |title: &str, error: &str, own: &str| Panel {
        title: title.to_string(),
        x_label: "seconds a case (one thread; FEM: on its own machine)".to_string(),
        y_label: "error / p0".to_string(),
        series: sources
            .iter()
            .map(|source| {
                let fem = *source == "fem";
                let points = rows(study, &[("source", source)]);
                let points = points.iter().filter_map(|r| {
                    let e = study.number(r, if fem { own } else { error })?;
                    Some((study.number(r, "seconds")?, e))
                });
                let name = if fem { "FEM (its own error)" } else { source };
                Series::marks(name, look(source), points.collect())
            })
            .collect(),
        log: (true, true),
        ..Default::default()
    };
    Figure {
        title: "Run time against error, one point a case".to_string(),
        columns: 2,
        panels: vec![
            panel("largest error of the pressure", "pressure_max", "fem_error_pressure"),
            panel("largest error of the six stresses", "stress_max", "fem_error_stress"),
        ],
        panel_size: (470, 370),
    }
}

/// All figures of a run by name.
fn figures(files: &StudyFiles) -> Vec<(String, Figure)> {
    let mut plots: Vec<(String, Figure)> = Vec::new();
    for case in Case::all(files) {
        let name = case.name;
        plots.push((format!("{name}-pressure"), case.pressure()));
        for body in ["block", "roller"] {
            plots.push((format!("{name}-surface-{body}"), case.surface(body)));
            let normal = ["sigma_xx", "sigma_yy", "sigma_zz", "sigma_yz"];
            plots.push((format!("{name}-depth-{body}"), case.depth(body, &normal, "stresses")));
            let invariants = case.depth(body, &["von_mises", "tau_max"], "equivalent stresses");
            plots.push((format!("{name}-invariants-{body}"), invariants));
        }
    }
    plots.extend(summary_figures(files));
    plots
}

/// The figures that sum up the whole study, by name.
fn summary_figures(files: &StudyFiles) -> Vec<(String, Figure)> {
    let mut plots = effects_figures(files);
    plots.push(("time-error".to_string(), time_and_error(files)));
    plots
}

/// All plots of a run: names of the files, and SVG.
pub fn all(files: &StudyFiles) -> Vec<(String, String)> {
    figures(files).into_iter().map(|(name, f)| (format!("{name}.svg"), f.draw().to_svg())).collect()
}

/// One of the plots that sum up the whole study (`time-error`, `half-normal-<method>`,
/// `pareto-<method>`, `interactions-<method>`) as SVG in the colours of a page.
pub fn named(files: &StudyFiles, name: &str) -> Option<String> {
    summary_figures(files)
        .into_iter()
        .find(|(n, _)| n == name)
        .map(|(_, f)| f.draw().to_themed_svg())
}

/// Half-normal, Pareto and interaction plots of each method.
fn effects_figures(files: &StudyFiles) -> Vec<(String, Figure)> {
    let mut plots = Vec::new();
    for method in files.summary.methods.iter().map(|m| m.name()) {
        let of: Vec<(Response, EffectRows)> =
            TOLD.iter().filter_map(|r| Some((*r, EffectRows::of(files, method, *r)?))).collect();
        if of.is_empty() {
            continue;
        }
        // Four panels stand better in two rows than as three and one.
        let columns = if of.len() == 4 { 2 } else { 3 };
        let figure = |title: String, panels: Vec<Panel>, columns, size| Figure {
            title,
            columns,
            panels,
            panel_size: size,
        };
        plots.push((
            format!("half-normal-{method}"),
            figure(
                format!("{method}: half-normal plot of the effects"),
                of.iter().map(|(r, e)| e.half_normal(*r)).collect(),
                columns,
                (380, 320),
            ),
        ));
        plots.push((
            format!("pareto-{method}"),
            figure(
                format!("{method}: effects by size"),
                of.iter().map(|(r, e)| e.pareto(*r)).collect(),
                columns,
                (380, 300),
            ),
        ));
        plots.push((
            format!("interactions-{method}"),
            figure(
                format!("{method}: interactions"),
                of.iter().flat_map(|(r, _)| interactions(files, method, *r)).collect(),
                3,
                (380, 270),
            ),
        ));
    }
    plots
}
