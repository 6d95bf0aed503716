"""The examples of the README and of docs/python.md run as they stand."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_the_example_runs(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    block = re.search(r"^    import edgeline\n(?:(?:    .*)?\n)+", text, re.M)
    assert block is not None
    names: dict[str, Any] = {}
    exec(textwrap.dedent(block[0]), names)
    solution = names["solution"]
    assert solution.summary["converged"]
    assert np.shape(solution.stress("block", 0.0, 0.0, [0.0, 1e-4])) == (2, 6)
