//! The source of a result: an edge model or a reference.

use crate::body::EdgeModel;
use crate::fem::Code;
use serde::{Deserialize, Serialize};
use std::fmt;

/// An edge model, or an engine that models are compared with. Files hold its name.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Source {
    /// A semi-analytical model.
    Model(EdgeModel),
    /// A reference, or the published method on cells.
    Engine(Engine),
}

/// A finite-element code or another origin of curves beside the models, by its name in files.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Engine(String);

impl Engine {
    /// A finite-element code.
    pub fn of(code: Code) -> Self {
        Self(code.source().to_string())
    }

    /// gmsh and FEniCSx; the name in files is `fem`.
    pub fn fenicsx() -> Self {
        Self::of(Code::Fenicsx)
    }

    /// Whether it is FEniCSx.
    pub fn is_fenicsx(&self) -> bool {
        *self == Self::fenicsx()
    }

    /// The name in files of the published method on uniform cells.
    pub const PUBLISHED: &'static str = "guilbault-cells";

    /// The published method on uniform cells.
    pub fn published() -> Self {
        Self(Self::PUBLISHED.to_string())
    }

    /// Curves from anywhere, by the name that they were given.
    pub fn brought(name: &str) -> Self {
        Self(name.to_string())
    }

    /// The name in files.
    pub fn name(&self) -> &str {
        &self.0
    }

    /// The name for readers.
    pub fn title(&self) -> &str {
        let own = |code: &Code| code.source() == self.0;
        match Code::ALL.into_iter().find(own) {
            Some(code) => code.title(),
            None => &self.0,
        }
    }
}

impl Source {
    /// All that the program has itself: the models, the codes, and the published method.
    pub fn all() -> impl Iterator<Item = Self> {
        let codes = Code::ALL.into_iter().map(Engine::of);
        let engines = codes.chain([Engine::published()]).map(Self::from);
        EdgeModel::ALL.into_iter().map(Self::from).chain(engines)
    }

    /// The name in files.
    pub fn name(&self) -> &str {
        match self {
            Source::Model(method) => method.name(),
            Source::Engine(engine) => engine.name(),
        }
    }

    /// The name for readers.
    pub fn title(&self) -> &str {
        match self {
            Source::Model(method) => method.name(),
            Source::Engine(engine) => engine.title(),
        }
    }

    /// The engine, if this is a reference and no model.
    pub fn engine(&self) -> Option<&Engine> {
        match self {
            Source::Model(_) => None,
            Source::Engine(engine) => (*engine != Engine::published()).then_some(engine),
        }
    }

    /// Whether this is a reference and no model.
    pub fn is_engine(&self) -> bool {
        self.engine().is_some()
    }
}

impl From<EdgeModel> for Source {
    fn from(method: EdgeModel) -> Self {
        Source::Model(method)
    }
}

impl From<Engine> for Source {
    fn from(engine: Engine) -> Self {
        Source::Engine(engine)
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}
