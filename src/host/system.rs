//! A child that dies with its parent. Without this, a killed driver would leave its children
//! behind. The standard library has no safe call for it; nothing else in this program is unsafe.
#![allow(unsafe_code)]

use std::process::Command;

/// Makes the child that `command` starts die with this process.
#[cfg_attr(not(target_os = "linux"), allow(unused_variables))]
pub(super) fn die_with_this_process(command: &mut Command) {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{Signal, getpid, getppid, set_parent_process_death_signal};
        use std::os::unix::process::CommandExt;
        let parent = getpid();
        // SAFETY: the closure runs in the forked child, where it only makes system calls that are
        // async-signal-safe, and allocates nothing.
        unsafe {
            command.pre_exec(move || {
                set_parent_process_death_signal(Some(Signal::KILL))?;
                // The parent may have died before that call.
                if getppid() == Some(parent) { Ok(()) } else { Err(rustix::io::Errno::SRCH.into()) }
            });
        }
    }
}
