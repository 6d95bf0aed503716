//! The files of uncertain inputs: `uncertainty.csv`, `uncertainty.json` and a plot with bands.

use super::draw::{Figure, Panel, Series, look};
use super::plots::origin;
use super::study_files::pretty;
use super::table::number;
use crate::base::BodyKind;
use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::stress::{Quantity, Variable};
use crate::study::CONTACT;
use crate::study::uncertain::{Input, Place, Spread, Uncertain};
use serde_json::{Map, Value, json};

/// The files about the case of this name, by name.
pub fn contents(case: &str, found: &Uncertain, method: EdgeModel) -> Vec<(String, Vec<u8>)> {
    [
        ("uncertainty.csv", table(found)),
        ("uncertainty.json", pretty(&summary(found))),
        ("plot-uncertainty.svg", figure(case, found, method).draw().to_svg()),
    ]
    .map(|(name, text)| (name.to_string(), text.into_bytes()))
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
    title: "contact pressure, x = 0",
};
const STRESS: Shown = Shown {
    body: Some(BodyKind::Block),
    curve: "depth-centre",
    axis: 2,
    variable: Variable::Stress(Quantity::VonMises),
    title: "von Mises, block, middle",
};

/// The panels of the plot.
const SHOWN: [Shown; 4] = [
    PRESSURE,
    Shown { curve: "along-x", axis: 0, title: "contact pressure across", ..PRESSURE },
    STRESS,
    Shown { curve: "depth-end", title: "von Mises, block, end", ..STRESS },
];

/// Pressure and von Mises stress with bands that 95 % of the samples lie in.
fn figure(case: &str, found: &Uncertain, method: EdgeModel) -> Figure {
    let input = |i: &Input| format!("{} ± {}", i.key.path, significant(i.deviation, 3));
    let inputs: Vec<String> = found.inputs.iter().map(input).collect();
    let name = format!("{} (band: 95 % of the samples)", inputs.join(", "));
    let panel = |shown: Shown| {
        let Shown { body, curve, axis, variable, title } = shown;
        let own = found.curves.iter().filter(move |(place, _)| {
            (place.body, place.variable) == (body, variable) && place.curve == curve
        });
        let points: Vec<(f64, f64)> =
            own.clone().map(|(place, s)| (place.at_m[axis] * 1e3, s.value * 1e-6)).collect();
        let band = own.map(|(_, s)| s.interval.map(|v| v * 1e-6)).collect();
        let series = Series {
            markers: false,
            band: Some(band),
            ..Series::curve(&name, look(&method.into()), points)
        };
        (!series.points.is_empty()).then(|| Panel {
            title: title.to_string(),
            x_label: format!("{} (mm)", ["x", "y", "z"][axis]),
            y_label: "MPa".to_string(),
            series: vec![series],
            ..Panel::default()
        })
    };
    Figure {
        title: format!("{}: {} samples", origin(case, method), found.samples),
        columns: 2,
        panels: SHOWN.into_iter().filter_map(panel).collect(),
        panel_size: (460, 310),
    }
}
