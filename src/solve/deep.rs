//! How far points and lines at a depth below the surfaces have come: the approach and the tilt of
//! the bodies.
//!
//! Where the bodies touch they have closed the gap. What points below approach beyond that is the
//! shortening of both bodies above them, the integral of the strain (sigma_zz - nu (sigma_xx +
//! sigma_yy)) / E. No reference far away is needed, on which the result would depend. Deep below,
//! stresses are those of waves so long that the equations of free faces are close to singular, and
//! the displacement is known:
//!
//! - A body between two free faces is Kirchhoff's plate, loaded on its edge by the force and by the
//!   moment about its own middle: it moves and turns by the logarithm of the depths' ratio
//!   ([`Shape::as_plate`] over the wavenumbers across the contact).
//! - A half-space, with images or without, sinks at the depth z by
//!   (1 + nu) / (2 pi E) (2 (1 - nu) / r + z^2 / r^3) under a unit force at the distance r
//!   (Boussinesq; Johnson, Contact Mechanics, 1985, Eq. 3.19).

use super::scene::{Scene, SceneBody};
use crate::base::{BodyKind, Panels, StressTensor};
use crate::body::{End, Shape};
use crate::contact::Gap;
use crate::stress::{Field, LineLoad};
use std::f64::consts::PI;

/// What the motion of deep points needs to know of the contact.
pub(super) struct Touch {
    /// Ends along y (C) of the line on which the gap is closed.
    pub ends: [f64; 2],
    /// The load along all of the line.
    pub forces: Vec<Force>,
}

impl Touch {
    /// Those of a contact that has these `ends` and Hertz's pressures across.
    pub fn new(ends: [f64; 2], lines: &[LineLoad]) -> Self {
        let force = |line: &LineLoad| Force {
            y: line.y,
            square: 0.25 * line.half_width * line.half_width,
            size: line.weight * line.load,
        };
        Self { ends, forces: lines.iter().map(force).collect() }
    }
}

/// Places along the contact: with more of them tilts change by less than 1e-4 of themselves, and by
/// more with finer depths.
const PLACES: usize = 4;

/// End of the first panel of the depths (C), and their nodes.
const FIRST: f64 = 0.25;
const ORDER: usize = 4;

/// Depth, in half-lengths of a body, from which on its displacement is known.
const DEEP: f64 = 5.0;

/// The depth down to which stresses in a body of this half-length (C) are counted on the way to
/// `deepest` (C).
pub(super) fn reach(half: f64, deepest: f64) -> f64 {
    deepest.min(DEEP * half)
}

/// The places on the line where bodies touch at which deep points are looked at.
#[derive(Debug)]
pub(super) struct Places(Panels);

impl Places {
    /// Those of a contact with these `ends`.
    pub fn new(ends: [f64; 2]) -> Self {
        Self(Panels::new(ends.to_vec(), PLACES))
    }

    /// The places.
    pub fn all(&self) -> &[f64] {
        self.0.nodes()
    }

    /// The place nearest to y = 0 between the outermost ones: a contact's end itself may be an
    /// edge.
    pub fn nearest(&self) -> f64 {
        let all = self.all();
        0f64.clamp(all[0], all[all.len() - 1])
    }

    /// The slope of the straight line through `values` at the places, by least squares.
    pub fn slope(&self, values: &[f64]) -> f64 {
        let middle = 0.5 * (self.0.breaks()[0] + self.0.end());
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            let all = self.all().iter().zip(self.0.weights()).zip(values);
            all.map(|((y, w), value)| w * of(y - middle, *value)).sum()
        };
        sum(&|u, value| u * value) / sum(&|u, _| u * u)
    }
}

/// The displacement deep below one place.
#[derive(Debug)]
enum Far {
    /// That of a plate.
    Plate(Plate),
    /// That of a half-space.
    HalfSpace(Sunk),
}

/// The shortening of a body between free faces deep below one place: per length it is
/// `growth` / z + `twist` / z^2 + `rest` / z^3.
#[derive(Debug)]
pub(super) struct Plate {
    growth: f64,
    twist: f64,
    rest: f64,
}

impl Plate {
    /// That of the `body` below `y` under the `forces`, whose `strains` above are those of a column
    /// by a `rule`: the last panel tells how far they still are from the plate's.
    pub fn new(
        body: &SceneBody,
        y: f64,
        forces: &[Force],
        (rule, strains): (&Panels, &[f64]),
    ) -> Self {
        let SceneBody { half, middle, nu, share, .. } = *body;
        let load = forces.iter().map(|force| force.size).sum();
        let moment = forces.iter().map(|force| (force.y - middle) * force.size).sum();
        let shape = Shape { half, nu };
        let growth = share * shape.as_plate(load, moment, y - middle) / (PI * PI);
        // A wave turns the depth z by (1 - (1 - nu) k z / 2) e^(-k z) of what it turns the edge by:
        // summed over k with the torsion's further power of k, that falls as (1 + nu) / 2 z^-2.
        let turn = share * shape.turned() * moment * (y - middle) / (PI * PI);
        let twist = 0.5 * (1.0 + nu) * half * shape.twisted() * turn;
        let last = rule.len() - rule.order();
        let nodes = rule.nodes().iter().zip(rule.weights()).zip(strains).skip(last);
        let rest = |((z, weight), strain): ((&f64, &f64), &f64)| {
            weight * (strain - growth / z - twist / (z * z)) * z.powi(3)
        };
        let length: f64 = rule.weights()[last..].iter().sum();
        Self { growth, twist, rest: nodes.map(rest).sum::<f64>() / length }
    }

    /// The shortening (C^2 / (2 R)) between two depths (C).
    pub fn between(&self, from: f64, to: f64) -> f64 {
        self.growth * (to / from).ln()
            + self.twist * (from.recip() - to.recip())
            + 0.5 * self.rest * (from.powi(-2) - to.powi(-2))
    }
}

/// The displacement (C^2 / (2 R)) of points of a half-space below one place.
#[derive(Debug)]
pub(super) struct Sunk {
    share: f64,
    nu: f64,
    forces: Vec<Force>,
}

/// What the load on a piece of the contact line displaces far from it: a force on either side of x
/// = 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Force {
    /// Its place along the line (C).
    pub y: f64,
    /// Its square distance from x = 0 (C^2): that of the load, averaged.
    pub square: f64,
    /// Both together (C^2 p0).
    pub size: f64,
}

impl Sunk {
    /// Below `y` in a body with this `share` of the compliance and Poisson's ratio, under the
    /// forces at places along the line.
    pub fn new(body: &SceneBody, y: f64, forces: impl Iterator<Item = Force>) -> Self {
        let forces = forces.map(|force| Force { y: force.y - y, ..force }).collect();
        Self { share: body.share, nu: body.nu, forces }
    }

    /// At the depth `z` (C).
    pub fn at(&self, z: f64) -> f64 {
        self.sum(z, |r, part| (1.0 + part * self.constrained()) / r)
    }

    /// At the surface, under Hertz's pressures across: the mean of 1 / r over them is (4 / pi) (K -
    /// E) / (k^2 sqrt(a^2 + u^2)) at the distance u along the line, with the complete elliptic
    /// integrals of k^2 = a^2 / (a^2 + u^2).
    fn at_surface(&self) -> f64 {
        let one = |Force { y, square, size }: &Force| {
            let wide = 4.0 * square;
            let longest = (wide + y * y).sqrt();
            // By the arithmetic-geometric mean (Abramowitz and Stegun, 1964, 17.6).
            let (mut a, mut b) = (1.0, y.abs() / longest);
            let (mut sum, mut power) = (0.5 * wide / (longest * longest), 1.0);
            while a - b > 1e-12 {
                let c = 0.5 * (a - b);
                sum += power * c * c;
                power *= 2.0;
                (a, b) = (0.5 * (a + b), (a * b).sqrt());
            }
            let mean = if wide > 0.0 { 2.0 / a * sum * longest / wide } else { 1.0 / longest };
            size * mean
        };
        self.share / PI * self.forces.iter().map(one).sum::<f64>()
    }

    /// How much the body shortens there per length along z (C / (2 R)).
    pub fn strain(&self, z: f64) -> f64 {
        self.sum(z, |r, part| (1.0 - self.constrained() * (2.0 - 3.0 * part)) * z / r.powi(3))
    }

    /// 1 / (2 (1 - nu)).
    fn constrained(&self) -> f64 {
        0.5 / (1.0 - self.nu)
    }

    /// The sum over the forces of what `of` makes of the distance r and of (z / r)^2.
    fn sum(&self, z: f64, of: impl Fn(f64, f64) -> f64) -> f64 {
        let one = |Force { y, square, size }: &Force| {
            let squares = y * y + square + z * z;
            size * of(squares.sqrt(), z * z / squares)
        };
        self.share / PI * self.forces.iter().map(one).sum::<f64>()
    }
}

/// The forces of `body`'s images in both end faces, of the `weight` that an image has in the
/// displacement.
pub(super) fn images<'a>(
    body: &SceneBody,
    weight: f64,
    forces: &'a [Force],
) -> impl Iterator<Item = Force> + 'a {
    let faces = body.ends();
    let image = move |force: &Force, face: f64| Force {
        y: 2.0 * face - force.y,
        size: weight * force.size,
        ..*force
    };
    forces.iter().flat_map(move |force| faces.map(|face| image(force, face)))
}

/// How much `body` shortens per length along z (C / (2 R)) at the nodes of the depths of a `rule`,
/// below `y` in its `field`.
pub(super) fn strains(body: &SceneBody, field: &Field, y: f64, rule: &Panels) -> Vec<f64> {
    // 1 / E in units of 1 / E*.
    let compliance = body.share / (1.0 - body.nu * body.nu);
    let strain = |s: &StressTensor| compliance * (body.nu * (s.xx + s.yy) - s.zz);
    field.down(&[0.0], y, rule.nodes()).iter().map(|row| strain(&row[0].pressure)).collect()
}

/// The strain of one body below a place.
#[derive(Debug)]
struct Column {
    /// The depths.
    rule: Panels,
    /// How much each shortens per length, in units of C / (2 R).
    strains: Vec<f64>,
    far: Far,
    /// What images of another weight than they have in the stresses displace.
    images: Option<Sunk>,
}

impl Column {
    /// That of a `body` with this treatment of its `end` below `y`, from its `field`, down to
    /// `deepest` (C) or to where the displacement is known.
    fn new(
        body: &SceneBody,
        end: End,
        field: &Field,
        touch: &Touch,
        (y, deepest): (f64, f64),
    ) -> Self {
        let rule = depths(reach(body.half, deepest));
        let strains = strains(body, field, y, &rule);
        let forces = &touch.forces;
        let weight = end.image_weight.unwrap_or(0.0);
        let far = match end.freed {
            true => Far::Plate(Plate::new(body, y, forces, (&rule, &strains))),
            false => {
                let all = forces.iter().copied().chain(images(body, weight, forces));
                Far::HalfSpace(Sunk::new(body, y, all))
            }
        };
        // Images have their full weight in the stresses.
        let missing = end.image_weight.map(|weight| weight - 1.0).filter(|more| *more != 0.0);
        let images = missing.map(|more| Sunk::new(body, y, images(body, more, forces)));
        Self { rule, strains, far, images }
    }

    /// Memory that it takes (bytes).
    fn bytes(&self) -> usize {
        let forces = |sunk: &Sunk| size_of_val(sunk.forces.as_slice());
        let far = match &self.far {
            Far::Plate(_) => 0,
            Far::HalfSpace(sunk) => forces(sunk),
        };
        // The nodes, their weights and their strains.
        let nodes = 3 * size_of_val(self.strains.as_slice());
        size_of::<Self>() + nodes + far + self.images.as_ref().map_or(0, forces)
    }

    /// The shortening (C^2 / (2 R)) above `depth` (C).
    fn above(&self, depth: f64) -> f64 {
        let reach = self.rule.end();
        let images =
            self.images.as_ref().map_or(0.0, |sunk| sunk.at_surface() - sunk.at(depth.min(reach)));
        images
            + self.strained(depth.min(reach))
            + if depth > reach { self.beyond(depth) } else { 0.0 }
    }

    /// The shortening from the known displacements, between the last depth and `depth`.
    fn beyond(&self, depth: f64) -> f64 {
        let reach = self.rule.end();
        match &self.far {
            Far::Plate(plate) => plate.between(reach, depth),
            Far::HalfSpace(sunk) => sunk.at(reach) - sunk.at(depth),
        }
    }

    /// The integral of the strains down to `depth`.
    fn strained(&self, depth: f64) -> f64 {
        let whole = self.rule.breaks().partition_point(|end| *end <= depth) - 1;
        let known = whole * ORDER;
        let all = self.rule.weights().iter().zip(&self.strains);
        let sum: f64 = all.take(known).map(|(weight, strain)| weight * strain).sum();
        let from = self.rule.breaks()[whole];
        if from >= depth {
            return sum;
        }
        // Deep strains fall with the depth: their product with it is smoother.
        let product = |z: f64| -> f64 {
            let near = self.rule.interpolation(z);
            near.map(|(i, share)| share * self.rule.nodes()[i] * self.strains[i]).sum()
        };
        let part = Panels::new(vec![from, depth], ORDER);
        let rest = part.nodes().iter().zip(part.weights());
        sum + rest.map(|(z, weight)| weight * product(*z) / z).sum::<f64>()
    }
}

/// How far points below one place have approached each other.
#[derive(Debug)]
struct Closed {
    /// The gap that is closed (C^2 / (2 R)).
    gap: f64,
    columns: Vec<Column>,
}

impl Closed {
    fn new(scene: &Scene, fields: [&Field; 2], touch: &Touch, place: (f64, f64)) -> Self {
        let [block, roller] = fields;
        let column = |(kind, body): (BodyKind, SceneBody)| {
            let field = if kind == BodyKind::Block { block } else { roller };
            Column::new(&body, scene.end(kind), field, touch, place)
        };
        let columns = scene.distinct_bodies().into_iter().map(column).collect();
        Self { gap: scene.gap().at(0.0, place.0), columns }
    }

    /// At `depth` (C), in units of C^2 / (2 R).
    fn at(&self, depth: f64) -> f64 {
        self.gap + self.columns.iter().map(|column| column.above(depth)).sum::<f64>()
    }
}

/// The tilt of the lines x = 0 at `depth` (C) below both surfaces, in units of C / (2 R), by least
/// squares over the line where they touch, from the `fields` of the block and of the roller.
pub(super) fn tilt(scene: &Scene, fields: [&Field; 2], touch: &Touch, depth: f64) -> f64 {
    let places = Places::new(touch.ends);
    let closed = |y: &f64| Closed::new(scene, fields, touch, (*y, depth)).at(depth);
    places.slope(&places.all().iter().map(closed).collect::<Vec<_>>())
}

/// The approach of points at any depth below y = 0. Where the bodies do not touch there, it is that
/// at the nearest place where they do and the tilt from there on.
#[derive(Debug)]
pub(super) struct Approaches {
    nearest: f64,
    there: Closed,
    /// What the tilt needs, if it counts.
    places: Places,
    along: Vec<Closed>,
}

impl Approaches {
    /// That of a contact, from the `fields` of the block and of the roller.
    pub fn new(scene: &Scene, fields: [&Field; 2], touch: &Touch) -> Self {
        let places = Places::new(touch.ends);
        let nearest = places.nearest();
        let closed = |y: f64| Closed::new(scene, fields, touch, (y, f64::INFINITY));
        let tilting: &[f64] = if nearest == 0.0 { &[] } else { places.all() };
        let along = tilting.iter().map(|y| closed(*y)).collect();
        Self { nearest, there: closed(nearest), along, places }
    }

    /// Memory that it takes (bytes).
    pub fn bytes(&self) -> usize {
        let closed = std::iter::once(&self.there).chain(&self.along);
        size_of::<Self>()
            + closed.flat_map(|closed| &closed.columns).map(Column::bytes).sum::<usize>()
    }

    /// At `depth` (C), in units of C^2 / (2 R).
    pub fn at(&self, depth: f64) -> f64 {
        let there = self.there.at(depth);
        if self.along.is_empty() {
            return there;
        }
        let along: Vec<f64> = self.along.iter().map(|closed| closed.at(depth)).collect();
        there - self.nearest * self.places.slope(&along)
    }
}

/// The rule of a column of a body down to a depth.
pub(super) fn depths(deepest: f64) -> Panels {
    let mut breaks = vec![0.0];
    let mut next = FIRST;
    while 1.5 * next < deepest {
        breaks.push(next);
        next *= 2.0;
    }
    breaks.push(deepest);
    Panels::new(breaks, ORDER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::gauss_legendre;

    fn sunk(y: f64, square: f64) -> Sunk {
        let body = SceneBody::straight(5.0, 0.3, 0.6);
        Sunk::new(&body, 0.0, std::iter::once(Force { y, square, size: 2.0 }))
    }

    #[test]
    fn the_surface_sinks_by_the_mean_over_hertz_pressures() {
        let (nodes, weights) = gauss_legendre(400);
        for (u, a) in [(0.1, 1.0), (0.7, 0.9), (3.0, 1.2), (40.0, 1.0)] {
            // x = a sin t.
            let rule = nodes.iter().zip(&weights);
            let mean: f64 = rule
                .map(|(t, w)| {
                    let (sin, cos) = (0.5 * PI * t).sin_cos();
                    w * cos * cos / (a * a * sin * sin + u * u).sqrt()
                })
                .sum();
            let (got, want) = (sunk(u, 0.25 * a * a).at_surface(), 0.6 / PI * 2.0 * mean);
            assert!((got / want - 1.0).abs() < 1e-9, "{u} {a}: {got} {want}");
        }
        let point = sunk(0.7, 0.0);
        assert!((point.at_surface() / point.at(0.0) - 1.0).abs() < 1e-14);
    }

    /// On the axis of a force Boussinesq's point sinks by (1 + nu) (3 - 2 nu) / (2 pi E z).
    #[test]
    fn the_strain_is_the_slope_of_the_displacement() {
        for (y, z) in [(0.0, 2.0), (1.5, 2.0), (8.0, 3.0)] {
            let sunk = sunk(y, 0.25);
            let step = 1e-4;
            let slope = (sunk.at(z - step) - sunk.at(z + step)) / (2.0 * step);
            assert!((sunk.strain(z) / slope - 1.0).abs() < 1e-7, "{y} {z}");
        }
        let (z, nu) = (2.0, 0.3);
        let want = 2.0 * 0.6 / (1.0 - nu * nu) * (1.0 + nu) * (3.0 - 2.0 * nu) / (2.0 * PI * z);
        assert!((sunk(0.0, 0.0).at(z) / want - 1.0).abs() < 1e-14);
    }
}
