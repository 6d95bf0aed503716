"""The sweep over a cluster, with a worker killed on the way: nothing is lost, nothing is there twice."""

from __future__ import annotations

import importlib
import os
import signal
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import edgeline

COUNT = 1200


@pytest.fixture
def cluster(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The example; workers are started with this path, so that they find it, too."""
    pytest.importorskip("distributed")
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "examples"))
    return importlib.import_module("cluster")


def test_a_worker_that_is_killed_costs_no_row(cluster: Any) -> None:
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
