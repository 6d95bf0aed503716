//! The explorer: a page in the browser on which a case is changed and solved while one watches.
//!
//! [`serve`] answers on the loopback interface alone. `server` checks who asks and for what, `desk`
//! solves one request at a time and drops those that a newer one replaces, `asked` reads a case
//! from a request, `answer` writes a solution as JSON, `files` what is downloaded, and `controls`
//! describes the keys of a case, from which the page makes its fields.

mod alive;
mod answer;
mod asked;
mod controls;
mod desk;
mod files;
mod server;

pub use server::{Explorer, serve};
