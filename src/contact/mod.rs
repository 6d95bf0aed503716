//! Load-controlled contact of two bodies.
