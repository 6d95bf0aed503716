//! The files of `edgeline fatigue`: `fatigue.csv`, `fatigue-<body>.vtr`, a map of each measure and,
//! last, `summary.json`.

use super::columns::{Columns, Values};
use super::draw::{Figure, Map};
use super::plots::origin;
use super::vtk::VtkGrid;
use crate::base::{BodyKind, HertzScales};
use crate::case::{Case, Fatigue, Sliding};
use crate::fatigue::{Extreme, Measures};
use crate::solve::Passage;
use schemars::JsonSchema;
use serde::Serialize;

/// The passages of one case by one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Passages {
    /// The method's name.
    pub method: String,
    /// The passage of each body.
    pub bodies: Vec<Passage>,
}

/// The value of a measure in units of p0 or without a unit, and the number in the history of its
/// instant, if it has one.
type Value = Option<(f64, Option<usize>)>;

/// A measure as a column of the table, an array of the grid and a picture.
struct Measure {
    name: &'static str,
    /// Name with the unit in pictures.
    label: &'static str,
    /// Whether it is a stress.
    stress: bool,
    of: fn(&Measures) -> Value,
}

fn at(extreme: Extreme) -> (f64, Option<usize>) {
    (extreme.value, Some(extreme.at))
}

const MEASURES: [Measure; 5] = [
    Measure {
        name: "tau_xz_range",
        label: "range of tau_xz (MPa)",
        stress: true,
        of: |m| Some((m.shear_range, None)),
    },
    Measure {
        name: "tau_max",
        label: "largest shear stress (MPa)",
        stress: true,
        of: |m| Some(at(m.tau_max)),
    },
    Measure {
        name: "von_mises",
        label: "largest von Mises stress (MPa)",
        stress: true,
        of: |m| Some(at(m.von_mises)),
    },
    Measure {
        name: "dang_van",
        label: "Dang Van's measure (MPa)",
        stress: true,
        of: |m| m.dang_van.map(at),
    },
    Measure {
        name: "fatemi_socie",
        label: "Fatemi and Socie's measure",
        stress: false,
        of: |m| m.fatemi_socie.map(|plane| (plane.value, None)),
    },
];

impl Measure {
    /// Its name with the unit of files.
    fn column(&self) -> String {
        if self.stress { format!("{}_pa", self.name) } else { self.name.to_string() }
    }

    /// Its value in the unit of files.
    fn in_si(&self, value: f64, hertz: &HertzScales) -> f64 {
        if self.stress { value * hertz.p0_pa } else { value }
    }

    fn value(&self, measures: &Measures) -> Option<f64> {
        (self.of)(measures).map(|(value, _)| value)
    }
}

/// The summary of a passage.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Summary {
    /// The case's name.
    pub case: String,
    /// The edge model.
    pub method: String,
    /// C (m) and p0 (Pa).
    pub c_m: f64,
    /// p0 (Pa).
    pub p0_pa: f64,
    /// The friction.
    pub friction: f64,
    /// The largest value of each measure in each body, outside 0.1 C of the overlap's edges.
    pub critical: Vec<CriticalPlace>,
    /// What to beware of in the contact, as a solution of it says.
    pub warnings: Vec<String>,
}

/// The largest value of a measure.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CriticalPlace {
    /// The body.
    pub body: BodyKind,
    /// The column of `fatigue.csv`.
    pub measure: String,
    /// The value, Pa but for Fatemi and Socie's.
    pub value: f64,
    /// y and z of the place (m).
    pub at_m: [f64; 2],
    /// x of the instant (m), where the measure is that of one.
    pub x_m: Option<f64>,
    /// Dang Van's measure over its limit.
    pub over_limit: Option<f64>,
    /// The normal of Fatemi and Socie's plane.
    pub normal: Option<[f64; 3]>,
    /// What half-spaces say.
    pub half_space: Option<HalfSpaceCritical>,
}

/// The largest value by half-spaces.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct HalfSpaceCritical {
    /// The value.
    pub value: f64,
    /// y and z of its place (m).
    pub at_m: [f64; 2],
    /// The value over that of the method.
    pub factor: f64,
}

/// The summary of `own`, with that of half-spaces beside it if there is one.
pub fn summary(
    case: &Case,
    hertz: &HertzScales,
    own: &Passages,
    half_space: Option<&Passages>,
    warnings: Vec<String>,
) -> Summary {
    let Sliding { friction } = case.sliding;
    let mut critical = Vec::new();
    for (i, passage) in own.bodies.iter().enumerate() {
        let other = half_space.map(|all| &all.bodies[i]);
        critical.extend(MEASURES.iter().filter_map(|m| place(case, hertz, m, passage, other)));
    }
    Summary {
        case: case.name.clone(),
        method: own.method.clone(),
        c_m: hertz.c_m,
        p0_pa: hertz.p0_pa,
        friction,
        critical,
        warnings,
    }
}

/// The largest value of a measure in a body; none without the measure.
fn place(
    case: &Case,
    hertz: &HertzScales,
    measure: &Measure,
    passage: &Passage,
    half_space: Option<&Passage>,
) -> Option<CriticalPlace> {
    let found = passage.critical(|m| measure.value(m))?;
    let at_m = |passage: &Passage, place: usize| passage.place(place).map(|v| v * hertz.c_m);
    let own = &passage.measures[found.at];
    let (_, instant) = (measure.of)(own)?;
    let value = measure.in_si(found.value, hertz);
    let Fatigue { dang_van_beta_pa, .. } = case.fatigue;
    let half_space = half_space.and_then(|passage| {
        let other = passage.critical(|m| measure.value(m))?;
        Some(HalfSpaceCritical {
            value: measure.in_si(other.value, hertz),
            at_m: at_m(passage, other.at),
            factor: other.value / found.value,
        })
    });
    Some(CriticalPlace {
        body: passage.body,
        measure: measure.column(),
        value,
        at_m: at_m(passage, found.at),
        x_m: instant.map(|i| passage.instants(found.at)[i] * hertz.c_m),
        over_limit: dang_van_beta_pa
            .filter(|_| measure.name == "dang_van")
            .map(|limit| value / limit),
        normal: own
            .fatemi_socie
            .filter(|_| measure.name == "fatemi_socie")
            .map(|plane| plane.normal),
        half_space,
    })
}

/// The files of a passage but for the summary, by their names.
pub fn contents(
    case: &Case,
    hertz: &HertzScales,
    own: &Passages,
    half_space: Option<&Passages>,
) -> Vec<(String, Vec<u8>)> {
    let mut files =
        vec![("fatigue.csv".into(), table(hertz, own, half_space).to_csv().into_bytes())];
    for passage in &own.bodies {
        let name = passage.body.name();
        files.push((format!("fatigue-{name}.vtr"), grid(passage, hertz).to_vtr()));
        for measure in MEASURES.iter().filter(|m| m.value(&passage.measures[0]).is_some()) {
            let picture = figure(&origin(&case.name, &own.method), hertz, measure, passage).draw();
            let file = format!("fatigue-{name}-{}", measure.name.replace('_', "-"));
            files.push((format!("{file}.svg"), picture.to_svg().into_bytes()));
            files.push((format!("{file}.png"), picture.to_png()));
        }
    }
    files
}

/// All measures at all places, one row a place.
fn table(hertz: &HertzScales, own: &Passages, half_space: Option<&Passages>) -> Columns {
    let (mut bodies, mut y, mut z) = (Vec::new(), Vec::new(), Vec::new());
    for passage in &own.bodies {
        for place in 0..passage.measures.len() {
            let [own_y, own_z] = passage.place(place);
            bodies.push(passage.body.name().to_string());
            y.push(own_y * hertz.c_m);
            z.push(own_z * hertz.c_m);
        }
    }
    let mut columns = vec![
        ("body".to_string(), Values::Texts(bodies)),
        ("y_m".into(), Values::Numbers(y)),
        ("z_m".into(), Values::Numbers(z)),
    ];
    let all = |passages: &Passages, of: &dyn Fn(&Passage, usize) -> Option<f64>| {
        let bodies = passages.bodies.iter();
        let values = bodies.flat_map(|p| (0..p.measures.len()).map(move |place| of(p, place)));
        values.collect::<Option<Vec<f64>>>()
    };
    for measure in &MEASURES {
        let value = |p: &Passage, place: usize| {
            Some(measure.in_si(measure.value(&p.measures[place])?, hertz))
        };
        let Some(values) = all(own, &value) else { continue };
        columns.push((measure.column(), Values::Numbers(values)));
        let instant = |p: &Passage, place: usize| {
            let (_, at) = (measure.of)(&p.measures[place])?;
            Some(p.instants(place)[at?] * hertz.c_m)
        };
        if let Some(places) = all(own, &instant) {
            columns.push((format!("{}_x_m", measure.name), Values::Numbers(places)));
        }
        if let Some(others) = half_space.and_then(|passages| all(passages, &value)) {
            columns.push((format!("{}_half_space", measure.column()), Values::Numbers(others)));
        }
    }
    Columns { name: "fatigue", columns }
}

/// The measures in the plane x = 0 of the global frame, in which z points into the block.
fn grid(passage: &Passage, hertz: &HertzScales) -> VtkGrid {
    let (ny, nz) = (passage.y.len(), passage.z.len());
    let roller = passage.body == BodyKind::Roller;
    let mut layers: Vec<usize> = (0..nz).collect();
    if roller {
        layers.reverse();
    }
    let side = if roller { -1.0 } else { 1.0 };
    let arrays = MEASURES.iter().filter_map(|measure| {
        let places = layers.iter().flat_map(|k| (0..ny).map(move |j| k * ny + j));
        let value = |i: usize| measure.value(&passage.measures[i]);
        let values = places.map(|i| Some(measure.in_si(value(i)?, hertz) as f32));
        Some((measure.column(), values.collect::<Option<Vec<f32>>>()?))
    });
    let arrays = arrays.collect();
    let y = passage.y.iter().map(|y| y * hertz.c_m).collect();
    let z = layers.iter().map(|&k| side * passage.z[k] * hertz.c_m).collect();
    VtkGrid { axes_m: [vec![0.0], y, z], arrays }
}

/// A map of a measure, whose largest value is marked. Near an edge it shows no more than the
/// largest value outside.
fn figure(origin: &str, hertz: &HertzScales, measure: &Measure, passage: &Passage) -> Figure {
    let scale = if measure.stress { 1e-6 * hertz.p0_pa } else { 1.0 };
    let most = passage.critical(|m| measure.value(m)).map_or(f64::INFINITY, |m| m.value);
    let values = passage.measures.iter().map(|m| scale * measure.value(m).unwrap_or(f64::NAN));
    let title = format!("{origin}: {}", passage.body.name());
    let axes =
        [&passage.y, &passage.z].map(|axis| axis.iter().map(|v| 1e3 * hertz.c_m * v).collect());
    let (label, limit) = (measure.label.to_string(), scale * most);
    let map = Map { label, axes, down: true, values: values.collect(), limit };
    Figure::of_map(title, ["y (mm)", "z (mm)"], map).of_what(measure.label)
}
