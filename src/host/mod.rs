//! The machine: complete files, files that were given, locked folders, limits of memory, child
//! processes and signals.

#[cfg(feature = "cli")]
mod files;
mod inputs;
#[cfg(feature = "cli")]
mod lock;
mod memory;
#[cfg(feature = "cli")]
mod process;
#[cfg(feature = "cli")]
mod secret;
#[cfg(feature = "cli")]
mod signals;
#[cfg(feature = "cli")]
mod system;
mod text;

#[cfg(feature = "cli")]
pub(crate) use {
    files::{
        check_not_given, make_folder, prepare_folder, remove_folder, remove_if_there,
        remove_marker, replace_set, write_set, write_set_over, write_whole,
    },
    lock::Lock,
    process::{Stage, capture, capture_any, kill_marked},
    secret::secret,
    signals::{check_interrupt, let_large_files_fail},
    text::{csv_fault, csv_line, csv_line_from, read_text},
};

pub(crate) use inputs::{read_input, remember_input};
pub(crate) use memory::check_memory;
pub(crate) use text::{MARK, WRITE_COMMAS, other_separators};
