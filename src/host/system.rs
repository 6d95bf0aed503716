//! The system calls that the standard library has no safe form for: signals to processes and groups
//! of them, a child that dies with its parent, handlers of signals. Everything unsafe in this program
//! stands here; without it a driver that is killed would leave children, and one that is asked to stop
//! could not end them first.
#![allow(unsafe_code)]

use std::os::unix::process::CommandExt;
use std::process::Command;

/// Sends `signal` to the process `pid`, or to the group of that number if `group`. One that is not
/// there any more is none of ours.
pub fn send(signal: i32, pid: i32, group: bool) {
    let target = if group { -pid } else { pid };
    // SAFETY: a plain system call.
    unsafe {
        libc::kill(target, signal);
    }
}

/// Makes the child that `command` starts die with this process.
#[cfg_attr(not(target_os = "linux"), allow(unused_variables))]
pub fn die_with_this_process(command: &mut Command) {
    #[cfg(target_os = "linux")]
    {
        let parent = std::process::id() as libc::pid_t;
        // SAFETY: the closure runs in the forked child, where it only makes system calls that are
        // async-signal-safe, and allocates nothing.
        unsafe {
            command.pre_exec(move || {
                libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL);
                // The parent may have died before that call.
                if libc::getppid() != parent {
                    libc::_exit(127);
                }
                Ok(())
            });
        }
    }
}

/// Lets `handler`, which must only do what is async-signal-safe, take `signal` unless it is ignored on
/// purpose (nohup).
pub fn handle(signal: i32, handler: extern "C" fn(i32)) {
    // SAFETY: the structures are filled before they are used, and the handler is the caller's word.
    unsafe {
        let mut old: libc::sigaction = std::mem::zeroed();
        if libc::sigaction(signal, std::ptr::null(), &mut old) != 0
            || old.sa_sigaction == libc::SIG_IGN
        {
            return;
        }
        let mut new: libc::sigaction = std::mem::zeroed();
        new.sa_sigaction = handler as libc::sighandler_t;
        new.sa_flags = libc::SA_RESTART;
        libc::sigemptyset(&mut new.sa_mask);
        libc::sigaction(signal, &new, std::ptr::null_mut());
    }
}

/// Does what `signal` does by default; for use in a handler.
pub fn act_by_default(signal: i32) {
    // SAFETY: both calls are async-signal-safe.
    unsafe {
        libc::signal(signal, libc::SIG_DFL);
        libc::raise(signal);
    }
}
