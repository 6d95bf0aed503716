"""The package as a whole: panics, threads, types and documentation."""

from __future__ import annotations

import inspect
import os
import pydoc
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import edgeline
from edgeline import _native

PYTHON = Path(__file__).parents[1]


def test_a_panic_is_an_error(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(edgeline.Error, match="please report it"):
        _native.fail()
    assert "as the tests asked for" in capfd.readouterr().err
    # And nothing is left behind.
    assert edgeline.solve(edgeline.Case.from_toml("half-short"), tolerance=1e-2).summary


def test_others_run_while_one_solves(case: edgeline.Case) -> None:
    """The interpreter's lock is released: a thread counts on while the other one solves."""
    ticks: list[float] = []
    stop = threading.Event()

    def tick() -> None:
        while not stop.wait(1e-3):
            ticks.append(time.perf_counter())

    ticker = threading.Thread(target=tick)
    ticker.start()
    began = time.perf_counter()
    edgeline.solve(case, tolerance=1e-4)
    ended = time.perf_counter()
    stop.set()
    ticker.join()
    within = [t for t in ticks if began < t < ended]
    assert len(within) >= 5, f"{len(within)} ticks in {ended - began:.3f} s"


def test_a_forked_process_solves_too() -> None:
    """It has none of its parent's threads, which may have solved before."""
    code = (
        "import os, signal, edgeline\n"
        "case = edgeline.Case.from_toml('flush-short')\n"
        "first = edgeline.solve(case, tolerance=1e-2).summary['p_centre_pa']\n"
        "if (child := os.fork()) == 0:\n"
        "    signal.alarm(60)\n"
        "    again = edgeline.solve(case, tolerance=1e-2).summary['p_centre_pa']\n"
        "    rows = edgeline.sweep([case, case], tolerance=1e-2)['p_centre_pa']\n"
        "    os._exit(0 if again == first and (abs(rows / first - 1) < 1e-6).all() else 1)\n"
        "assert os.waitpid(child, 0)[1] == 0\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert edgeline.__version__.count(".") == 2


INTERRUPTED = """
import os, signal, threading, time, numpy, edgeline
numpy.save("rough.npy", 2e-7 * numpy.random.default_rng(1).standard_normal((300, 300)))
case = edgeline.Case.from_toml("long-contact")
steps = {"dx_m": 10e-6, "dy_m": case.tables["roller"]["length_m"] / 299}
rough = case.changed(surface={"heights": "rough.npy", **steps})
solution = edgeline.solve(case, tolerance=1e-2)
axes = numpy.linspace(0, 1e-3, 250), numpy.linspace(0, 2e-3, 250), numpy.linspace(0, 1e-3, 300)
def grid():
    solution.to_xarray(*axes)
for task in (lambda: edgeline.solve(rough), grid):
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    began = time.perf_counter()
    try:
        task()
        print("done")
    except KeyboardInterrupt:
        print(time.perf_counter() - began)
"""


def test_an_interrupt_ends_a_contact_on_cells_and_a_grid(tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    ended = done.stdout.split()
    assert len(ended) == 2 and "done" not in ended, ended


def test_every_public_name_is_documented() -> None:
    for name in edgeline.__all__:
        thing = getattr(edgeline, name)
        if callable(thing):
            assert inspect.getdoc(thing), name
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                if not member.startswith("_"):
                    assert inspect.getdoc(value), f"{name}.{member}"
    text = pydoc.plain(pydoc.render_doc(edgeline))
    for wanted in ("class Case", "class Solution", "class Error", "pressure(self, x", "SI units"):
        assert wanted in text, wanted


def test_types_are_strict() -> None:
    """mypy --strict accepts the package, its stubs and the examples."""
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", os.devnull]
    done = subprocess.run(
        [*command, "edgeline", "examples"], cwd=PYTHON, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


# That of the cluster has a test of its own.
EXAMPLES = sorted(p for p in (PYTHON / "examples").glob("*.py") if p.stem != "cluster")


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, example], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout
