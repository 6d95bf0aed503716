//! The files of uncertain inputs: `uncertainty.csv`, `uncertainty.json` and a plot with bands.

use super::draw::{Figure, Panel, Series, look};
use super::plots::{origin, symbol_of};
use super::study_files::pretty;
use super::table::number;
use crate::base::BodyKind;
use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::case::Case;
use crate::stress::{EDGE, Quantity, Variable, away_from_edges};
use crate::study::CONTACT;
use crate::study::uncertain::{Input, Place, Spread, Uncertain};
use serde_json::{Map, Value, json};

/// The files about `case`, by name.
pub fn contents(case: &Case, found: &Uncertain, method: EdgeModel) -> Vec<(String, Vec<u8>)> {
    let picture = figure(case, found, method).draw();
    [
        ("uncertainty.csv", table(found).into_bytes()),
        ("uncertainty.json", pretty(&summary(found)).into_bytes()),
        ("plot-uncertainty.svg", picture.to_svg().into_bytes()),
        ("plot-uncertainty.png", picture.to_png()),
    ]
    .map(|(name, content)| (name.to_string(), content))
    .into()
}

fn body_of(place: &Place) -> &'static str {
    place.body.map_or(CONTACT, BodyKind::name)
}

/// A row for each place and quantity, in pascals.
fn table(found: &Uncertain) -> String {
    let mut text = "body,curve,x_m,y_m,z_m,quantity,value_pa,first_order_pa,mean_pa,deviation_pa,low_pa,high_pa\n".to_string();
    for (place, spread) in &found.curves {
        let Spread { value, first_order, mean, deviation, interval: [low, high], .. } = spread;
        let [x, y, z] = place.at_m.map(number);
        let numbers =
            [value, first_order, mean, deviation, low, high].map(|v| number(*v)).join(",");
        let (body, variable) = (body_of(place), place.variable);
        text += &format!("{body},{},{x},{y},{z},{variable},{numbers}\n", place.curve);
    }
    text
}

fn summary(found: &Uncertain) -> Value {
    let inputs = found.inputs.iter().map(|input| {
        json!({ "key": input.key.path, "value": input.value, "deviation": input.deviation })
    });
    let whole: Map<String, Value> = found
        .whole
        .iter()
        .map(|(name, s)| {
            let parts: Map<String, Value> = found
                .inputs
                .iter()
                .zip(&s.parts)
                .map(|(input, part)| (input.key.path.to_string(), json!(part)))
                .collect();
            let spread = json!({
                "value": s.value,
                "first_order": s.first_order,
                "parts": parts,
                "mean": s.mean,
                "deviation": s.deviation,
                "interval_95": s.interval,
            });
            (name.to_string(), spread)
        })
        .collect();
    json!({
        "inputs": inputs.collect::<Vec<_>>(),
        "samples": found.samples,
        "seed": found.seed,
        "results": whole,
    })
}

/// A panel of the plot.
struct Shown {
    body: Option<BodyKind>,
    curve: &'static str,
    /// The running axis.
    axis: usize,
    variable: Variable,
    title: &'static str,
}

const PRESSURE: Shown = Shown {
    body: None,
    curve: "along-y",
    axis: 1,
    variable: Variable::Pressure,
    title: "along the contact, x = 0",
};
const STRESS: Shown = Shown {
    body: Some(BodyKind::Block),
    curve: "depth-centre",
    axis: 2,
    variable: Variable::Stress(Quantity::VonMises),
    title: "into the block, in the middle",
};

/// The panels of the plot.
const SHOWN: [Shown; 4] = [
    PRESSURE,
    Shown { curve: "along-x", axis: 0, title: "across the contact, in its middle", ..PRESSURE },
    STRESS,
    Shown { curve: "depth-end", title: "into the block, at the end", ..STRESS },
];

/// Pressure and von Mises stress with bands that 95 % of the samples lie in.
fn figure(case: &Case, found: &Uncertain, method: EdgeModel) -> Figure {
    let input = |i: &Input| format!("{} ± {}", i.key.path, significant(i.deviation, 3));
    let inputs: Vec<String> = found.inputs.iter().map(input).collect();
    let name = format!("{} (band: 95 % of the samples)", inputs.join(", "));
    let c_m = case.hertz().c_m;
    let panel = |shown: Shown| {
        let Shown { body, curve, axis, variable, title } = shown;
        let own = found.curves.iter().filter(move |(place, _)| {
            (place.body, place.variable) == (body, variable) && place.curve == curve
        });
        let points: Vec<(f64, f64)> =
            own.clone().map(|(place, s)| (place.at_m[axis] * 1e3, s.value * 1e-6)).collect();
        let band = own.clone().map(|(_, s)| s.interval.map(|v| v * 1e-6)).collect();
        let at_edge =
            |at_m: [f64; 3]| !away_from_edges(at_m.map(|v| v / c_m), case.overlap(), EDGE);
        let series = Series {
            markers: false,
            band: Some(band),
            beyond: own.map(|(place, _)| at_edge(place.at_m)).collect(),
            ..Series::curve(&name, look(&method.into()), points)
        };
        (!series.points.is_empty()).then(|| Panel {
            title: title.to_string(),
            x_label: format!("{} (mm)", ["x", "y", "z"][axis]),
            y_label: format!("{} (MPa)", symbol_of(variable)),
            series: vec![series],
            ..Panel::default()
        })
    };
    Figure {
        title: format!("{}: {} samples", origin(&case.name, method), found.samples),
        columns: 2,
        panels: SHOWN.into_iter().filter_map(panel).collect(),
        panel_size: (460, 310),
    }
}
