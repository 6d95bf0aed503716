//! The program; everything it does stands in the library.

#![forbid(unsafe_code)]

use std::process::ExitCode;

/// A solve asks for many buffers of some kilobytes for a short time; the system's allocator spends a tenth
/// of all time on them.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    edgeline::cli::run(std::env::args_os())
}
