"""No process outlives whoever started it."""

import os
import subprocess
import sys
import time
from pathlib import Path

FEM = Path(__file__).resolve().parents[1]

SLEEPER = "import sys, time; from edgeline_fem import lifetime; lifetime.follow_driver(); " \
          "print('on', flush=True); time.sleep(60)"


def boot_id():
    return Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()


def environment(driver):
    return {**os.environ, "PYTHONPATH": str(FEM), "EDGELINE_DRIVER": driver}


def gone(pid, seconds=5.0):
    """Whether the process ends within some seconds."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            state = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()[0]
        except FileNotFoundError:
            return True
        if state == "Z":
            return True
        time.sleep(0.02)
    return False


def test_a_process_dies_with_its_parent():
    middle = (
        "import subprocess, sys, time\n"
        f"child = subprocess.Popen([sys.executable, '-c', {SLEEPER!r}], stdout=subprocess.PIPE)\n"
        "child.stdout.readline()\n"
        "print(child.pid, flush=True)\n"
        "time.sleep(60)\n"
    )
    parent = subprocess.Popen(
        [sys.executable, "-c", middle], stdout=subprocess.PIPE, text=True,
        env=environment(f"{boot_id()}:{os.getpid()}"),
    )
    child = int(parent.stdout.readline())
    assert not gone(child, 0.2)
    parent.kill()
    parent.wait()
    assert gone(child)


def test_a_process_whose_driver_is_dead_ends_at_once():
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    done = subprocess.run(
        [sys.executable, "-c", SLEEPER], env=environment(f"{boot_id()}:{dead.pid}"), timeout=30,
        capture_output=True, check=False,
    )
    assert done.returncode == 1
    assert done.stdout == b""


def test_a_driver_on_another_machine_is_not_looked_for():
    code = "from edgeline_fem import lifetime; lifetime.follow_driver()"
    for driver in ("other-boot:999999999", "", "nonsense"):
        done = subprocess.run([sys.executable, "-c", code], env=environment(driver), timeout=30, check=False)
        assert done.returncode == 0
