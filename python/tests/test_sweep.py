"""Sweeps: the rows of the command line, progress, shards, and what ends one."""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import edgeline

RATIOS = [0.5, 0.7, 1.0]
LOADS = [1e-4, 5e-4]


@pytest.fixture(scope="module")
def cases() -> list[edgeline.Case]:
    steel = {"young_pa": 210e9, "poisson": 0.3}
    return [
        edgeline.Case(
            name=f"row-{len(RATIOS) * i + j + 1}",
            roller={"radius_m": 10e-3, **steel},
            block=steel,
            dimensionless={"W": load, "S_l": 5.0, "L_r": ratio},
        )
        for i, load in enumerate(LOADS)
        for j, ratio in enumerate(RATIOS)
    ]


def test_the_rows_are_those_of_the_command_line(
    cases: list[edgeline.Case], tmp_path: Path, program: Any
) -> None:
    file = tmp_path / "sweep.toml"
    file.write_text(
        "[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n"
        "[block]\nyoung_pa = 210e9\npoisson = 0.3\n"
        f"[dimensionless]\nW = {LOADS}\nS_l = 5.0\nL_r = {RATIOS}\n"
    )
    out = tmp_path / "sweep.csv"
    done = program("sweep", file, "--tolerance", "1e-2", "--out", out)
    assert done.returncode == 0, done.stderr
    with out.open() as opened:
        rows = list(csv.DictReader(opened))
    table = edgeline.sweep(cases, tolerance=1e-2)
    assert table["row"].tolist() == list(range(len(cases)))
    assert table["case"].tolist() == [case.name for case in cases]
    shared = [name for name in rows[0] if name in table]
    assert len(shared) > 25 and shared[-1] == "err"
    for name in shared[1:]:
        theirs = [row[name] for row in rows]
        if table[name].dtype == np.float64:
            # The file has seven digits.
            wanted = np.array([float(text or "nan") for text in theirs])
            assert np.allclose(table[name], wanted, rtol=1e-6, equal_nan=True), name
        else:
            assert table[name].tolist() == theirs


def test_frames_and_tables_hold_the_same(cases: list[edgeline.Case]) -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    own = edgeline.sweep(cases[:2], tolerance=1e-2)
    frame = edgeline.sweep(cases[:2], tolerance=1e-2, into="pandas")
    table = edgeline.sweep(cases[:2], tolerance=1e-2, into="arrow")
    assert list(own) == list(frame.columns) == table.column_names
    assert frame["p_max_pa"].tolist() == own["p_max_pa"].tolist()
    assert table["critical_body"].to_pylist() == own["critical_body"].tolist()
    with pytest.raises(edgeline.Error, match="give numpy, pandas or arrow"):
        edgeline.sweep(cases, into="polars")  # type: ignore[call-overload]


def test_shards_have_each_case_once(cases: list[edgeline.Case]) -> None:
    whole = edgeline.sweep(cases, tolerance=1e-2)
    shards = [edgeline.sweep(cases, tolerance=1e-2, shard=(i, 2)) for i in np.arange(1, 3)]
    rows = np.concatenate([shard["row"] for shard in shards])
    p_max = np.concatenate([shard["p_max_pa"] for shard in shards])
    assert sorted(rows.tolist()) == list(range(len(cases)))
    assert np.array_equal(p_max[np.argsort(rows)], whole["p_max_pa"])
    with pytest.raises(edgeline.Error, match="give a pair of whole numbers"):
        edgeline.sweep(cases, shard=(3, 2))


def test_an_empty_part_has_the_columns_of_the_others(cases: list[edgeline.Case]) -> None:
    pandas, pyarrow = pytest.importorskip("pandas"), pytest.importorskip("pyarrow")
    parts = [
        edgeline.sweep(cases[:1], tolerance=1e-2, shard=(i, 2), into="arrow") for i in (1, 2)
    ]
    assert pyarrow.concat_tables(parts).num_rows == 1
    frames = [
        edgeline.sweep(cases[:1], tolerance=1e-2, shard=(i, 2), into="pandas") for i in (1, 2)
    ]
    assert frames[0].dtypes.equals(frames[1].dtypes)
    assert len(pandas.concat(frames)) == 1


@pytest.mark.parametrize(("into", "package"), [("pandas", "pandas"), ("arrow", "pyarrow")])
def test_a_missing_package_is_told_before_anything_is_solved(
    into: Any, package: str, cases: list[edgeline.Case], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    seen: list[tuple[int, int]] = []
    with pytest.raises(ImportError):
        edgeline.sweep(cases, into=into, progress=lambda *rows: seen.append(rows))
    assert not seen


def test_nothing_to_do_is_done() -> None:
    nothing = edgeline.sweep([])
    assert nothing["row"].tolist() == []
    some = edgeline.sweep([edgeline.Case.from_toml("flush-short")], tolerance=1e-1)
    assert list(nothing) == list(some)
    assert {name: v.dtype.kind for name, v in nothing.items() if name != "row"} == {
        name: v.dtype.kind for name, v in some.items() if name != "row"
    }


def test_numbers_of_jobs_and_parts_are_checked(cases: list[edgeline.Case]) -> None:
    for wrong in (0, -1, 10**30):
        with pytest.raises(edgeline.Error, match=f"jobs = {wrong} is not valid"):
            edgeline.sweep(cases, jobs=wrong)
    for shard in ((4, 3), (1, 10**30), "1/3", (1.0, 3), (0, 3), 1, (True, 2), (1, np.bool_(True))):
        with pytest.raises(edgeline.Error, match="give a pair of whole numbers"):
            edgeline.sweep(cases, shard=shard)  # type: ignore[arg-type]


def test_progress_counts_and_can_end_a_sweep(cases: list[edgeline.Case]) -> None:
    seen: list[tuple[int, int]] = []
    edgeline.sweep(cases, tolerance=1e-2, progress=lambda done, all: seen.append((done, all)))
    done = [count for count, _ in seen]
    assert done == sorted(done) and seen[-1] == (len(cases), len(cases))

    def enough(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        edgeline.sweep(cases, tolerance=1e-2, progress=enough)


def test_a_bar_of_tqdm(cases: list[edgeline.Case], capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    edgeline.sweep(cases[:2], tolerance=1e-2, progress=True)
    assert "2/2" in capsys.readouterr().err
