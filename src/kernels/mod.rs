//! Closed forms only: pure functions, no allocation.
