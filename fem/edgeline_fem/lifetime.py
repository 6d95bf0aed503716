"""Processes that end with the process that started them."""

import ctypes
import os
import signal

_PR_SET_PDEATHSIG = 1


def _boot():
    """Identifies this machine and its current boot."""
    try:
        with open("/proc/sys/kernel/random/boot_id", encoding="ascii") as file:
            return file.read().strip()
    except OSError:
        return ""


# Loaded here, as little as possible is to happen between fork and exec.
_libc = ctypes.CDLL(None, use_errno=True)


def die_with_parent():
    """Ask the kernel to kill this process when its parent dies (Linux; elsewhere nothing happens)."""
    if hasattr(_libc, "prctl"):
        _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)


def follow_driver():
    """Under a driver, die with the parent, and end now if the driver is dead already.

    The driver names itself as ``EDGELINE_DRIVER=<boot id>:<process id>``. Its own child dies with it
    without this; the ranks that mpirun starts need it. Ranks on other machines follow mpirun alone.
    """
    boot, _, driver = os.environ.get("EDGELINE_DRIVER", "").rpartition(":")
    if not boot or not driver.isdigit():
        return
    die_with_parent()
    if boot == _boot():
        try:
            os.kill(int(driver), 0)
        except ProcessLookupError:
            os._exit(1)
