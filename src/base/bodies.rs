//! The two bodies.

use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut};

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum BodyKind {
    /// The rectangular block.
    Block,
    /// The roller.
    Roller,
}

impl BodyKind {
    /// Both bodies, the block first.
    pub const ALL: [BodyKind; 2] = [BodyKind::Block, BodyKind::Roller];

    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            BodyKind::Block => "block",
            BodyKind::Roller => "roller",
        }
    }

    /// The body called `name` in files.
    pub fn find(name: &str) -> Option<BodyKind> {
        BodyKind::ALL.into_iter().find(|body| body.name() == name)
    }
}

/// Ends that differ by less than this part of a length are flush: the difference is rounding.
const FLUSH: f64 = 1e-9;

/// The length by which a body goes on `beyond` an end of the contact, none where it is rounding of
/// a length of this `size`: flush ends have other axes, laws and points than the narrowest ledge.
pub fn ledge(beyond: f64, size: f64) -> f64 {
    if beyond > FLUSH * size { beyond } else { 0.0 }
}

/// A pair of values, one for each body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PerBody<T> {
    /// The block's value.
    pub block: T,
    /// The roller's value.
    pub roller: T,
}

impl<T> PerBody<T> {
    /// The block's value, then the roller's.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        [&self.block, &self.roller].into_iter()
    }

    /// As [`PerBody::iter`], with mutable values.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        [&mut self.block, &mut self.roller].into_iter()
    }

    /// `of` applied to both values.
    pub fn map<U>(&self, of: impl Fn(&T) -> U) -> PerBody<U> {
        PerBody { block: of(&self.block), roller: of(&self.roller) }
    }
}

impl<T> Index<BodyKind> for PerBody<T> {
    type Output = T;
    fn index(&self, body: BodyKind) -> &T {
        match body {
            BodyKind::Block => &self.block,
            BodyKind::Roller => &self.roller,
        }
    }
}

impl<T> IndexMut<BodyKind> for PerBody<T> {
    fn index_mut(&mut self, body: BodyKind) -> &mut T {
        match body {
            BodyKind::Block => &mut self.block,
            BodyKind::Roller => &mut self.roller,
        }
    }
}
