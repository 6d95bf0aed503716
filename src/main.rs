//! The program; its code is in the library.

#![forbid(unsafe_code)]

use std::process::ExitCode;

/// A solve allocates many short-lived buffers of some kilobytes, which take a tenth of its time
/// with the system's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    edgeline::cli::run(std::env::args_os())
}
