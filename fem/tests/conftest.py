"""Shared pieces of the tests: the package on the path, a steel pair, small live models."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

FEM = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(FEM))

from edgeline_fem.record import standard_request  # noqa: E402
from edgeline_fem.request import Case, Material  # noqa: E402

STEEL = Material(210e9, 0.3)


def steel_case(load_factor, slenderness, length_ratio):
    """A steel roller of 10 mm radius on a steel block."""
    return Case.from_dimensionless("test", load_factor, slenderness, length_ratio, 0.01, STEEL, STEEL)


def run_stage(stage, request, folder, ranks=1):
    """Run a stage as the driver does; returns the finished process."""
    command = [sys.executable, "-m", "edgeline_fem", stage, str(request), str(folder)]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command]
    environment = {
        **os.environ, "PYTHONPATH": str(FEM), "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    }
    # What gmsh prints may be arbitrary bytes.
    return subprocess.run(command, capture_output=True, text=True, errors="replace", env=environment, cwd="/",
                          check=False)


def _solved(folder, case, size):
    """A case meshed and solved by the command line: (case, request, folder)."""
    request = folder / "request.json"
    request.write_text(json.dumps(standard_request(case, size).to_json()))
    for stage in ("mesh", "solve"):
        done = run_stage(stage, request, folder)
        assert done.returncode == 0, done.stderr
    return case, request, folder


@pytest.fixture(scope="session")
def live(tmp_path_factory):
    """A coarse flush contact: (case, request, folder)."""
    return _solved(tmp_path_factory.mktemp("live"), steel_case(5e-4, 5.0, 1.0), 2.0)


@pytest.fixture(scope="session")
def coarse(tmp_path_factory):
    """The same on a mesh that other codes, which are slower, solve in half a minute."""
    return _solved(tmp_path_factory.mktemp("coarse"), steel_case(5e-4, 5.0, 1.0), 2.8)


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    """A contact too coarse to be right, for comparing programs with themselves."""
    return _solved(tmp_path_factory.mktemp("small"), steel_case(1e-3, 3.0, 0.75), 4.0)
