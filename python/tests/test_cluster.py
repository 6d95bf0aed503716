"""The sweep over a cluster, with a worker killed on the way: nothing is lost, nothing is there twice."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import edgeline

COUNT = 1200


@pytest.fixture(scope="module")
def cluster() -> ModuleType:
    """The example, as workers import it."""
    pytest.importorskip("distributed")
    examples = Path(__file__).parents[1] / "examples"
    # The workers are processes of their own, which look there, too.
    os.environ["PYTHONPATH"] = os.pathsep.join([str(examples), os.environ.get("PYTHONPATH", "")])
    spec = importlib.util.spec_from_file_location("cluster", examples / "cluster.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["cluster"] = module
    spec.loader.exec_module(module)
    return module


def test_a_worker_that_is_killed_costs_no_row(cluster: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from distributed import Client, LocalCluster

    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with LocalCluster(**local) as workers, Client(workers) as client:
        pids = client.run(os.getpid)
        rows = []
        for row in cluster.rows(client, COUNT):
            if not rows:
                os.kill(next(iter(pids.values())), signal.SIGKILL)
            rows.append(row)
    assert [int(row["row"]) for row in rows] == list(range(COUNT))
    assert [row["case"] for row in rows] == [f"case-{i}" for i in range(COUNT)]
    some = range(0, COUNT, 97)
    own = edgeline.sweep([cluster.case(i, COUNT) for i in some], tolerance=1e-2)
    assert np.array_equal(own["p_max_pa"], [rows[i]["p_max_pa"] for i in some])
