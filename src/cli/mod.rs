//! See the crate's list of layers.
