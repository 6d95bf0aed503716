"""What the tests share."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import edgeline

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def program() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs the program `edgeline`, which EDGELINE names, as the tests' other side."""
    path = os.environ.get("EDGELINE", str(ROOT / "target/fast/edgeline"))
    if not Path(path).exists():
        pytest.fail(f"{path} is missing: build the program, or name it by EDGELINE")

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        command = [path, *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    return run


@pytest.fixture(scope="session")
def case() -> edgeline.Case:
    return edgeline.Case.from_toml("half-short")


@pytest.fixture(scope="session")
def solution(case: edgeline.Case) -> edgeline.Solution:
    return edgeline.solve(case, tolerance=1e-2)
