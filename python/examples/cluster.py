"""A sweep over a cluster by dask.distributed.

    python cluster.py --cases 100000 --out rows.csv
    python cluster.py --scheduler tcp://head:8786 --cases 100000 --out rows.csv

Without a scheduler, a local cluster of two workers is started. Each task solves a shard of the cases, on one processor
of its worker. Dask gives the tasks of a worker that is lost to another one, so every case is there once. The rows are
written in the order of their shards as they come, and do not stay in memory.
"""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterator
from typing import Any

from distributed import Client, LocalCluster

import edgeline

#: Cases of a task: some seconds of work, so that the cluster's own costs do not count.
CASES_PER_TASK = 500


def case(i: int, count: int) -> edgeline.Case:
    """The `i`-th of `count` cases: blocks from flush to twice as long, and rollers of 1 to 50 half-widths."""
    steel = {"young_pa": 210e9, "poisson": 0.3}
    # An additive recurrence covers the plane evenly whatever `count` is.
    u, v = (0.754877666 * i) % 1.0, (0.569840291 * i) % 1.0
    return edgeline.Case(
        name=f"case-{i}",
        roller={"radius_m": 10e-3, **steel},
        block=steel,
        dimensionless={"W": 5e-4, "S_l": 0.5 * 100.0**u, "L_r": 1.0 - 0.5 * v},
    )


def solve(first: int, count: int) -> list[dict[str, Any]]:
    """The rows of one task, its cases from `first` on."""
    numbers = range(first, min(first + CASES_PER_TASK, count))
    table = edgeline.sweep((case(i, count) for i in numbers), tolerance=1e-2, jobs=1)
    table["row"] = table["row"] + first
    names = list(table)
    return [dict(zip(names, row, strict=True)) for row in zip(*table.values(), strict=True)]


def rows(client: Client, count: int) -> Iterator[dict[str, Any]]:
    """All rows in their order; at most a few tasks for each worker are under way at a time."""
    firsts = iter(range(0, count, CASES_PER_TASK))
    waiting = []
    ahead = 4 * max(1, sum(client.ncores().values()))
    for first in firsts:
        waiting.append(client.submit(solve, first, count, retries=3, pure=False))
        if len(waiting) >= ahead:
            yield from waiting.pop(0).result()
    for future in waiting:
        yield from future.result()


def main() -> None:
    """Runs the sweep."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--scheduler", help="address of a Dask scheduler")
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--out", default="rows.csv")
    arguments = parser.parse_args()
    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    cluster = arguments.scheduler or LocalCluster(**local)
    with Client(cluster) as client, open(arguments.out, "w", newline="") as file:
        writer = None
        for row in rows(client, arguments.cases):
            if writer is None:
                writer = csv.DictWriter(file, list(row))
                writer.writeheader()
            writer.writerow(row)
    print(f"wrote {arguments.cases} rows into {arguments.out}")
    if not arguments.scheduler:
        cluster.close()


if __name__ == "__main__":
    main()
