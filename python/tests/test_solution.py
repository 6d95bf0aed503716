"""Solutions: the numbers of the command line, broadcasting, and what is refused."""

from __future__ import annotations

import csv
import gc
import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import edgeline


def test_all_numbers_are_those_of_the_command_line(
    case: edgeline.Case, solution: edgeline.Solution, tmp_path: Path, program: Any
) -> None:
    done = program("solve", "half-short", "--tolerance", "1e-2", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "summary.json").read_text())
    for own in (summary, solution.summary):
        assert own["seconds"]["total"] > 0.0
    assert {**solution.summary, "seconds": None} == {**summary, "seconds": None}
    assert set(solution.tables) == {path.stem for path in tmp_path.glob("*.csv")}
    for name, table in solution.tables.items():
        with (tmp_path / f"{name}.csv").open() as file:
            rows = list(csv.DictReader(file))
        assert list(table) == list(rows[0])
        for column, values in table.items():
            if values.dtype == np.float64:
                theirs = np.array([float(row[column]) for row in rows])
                assert np.abs(values - theirs).max() <= 1e-12 * np.abs(theirs).max(), column
            else:
                assert values.tolist() == [row[column] for row in rows]


def test_the_files_are_those_of_the_command_line(
    solution: edgeline.Solution, tmp_path: Path, program: Any
) -> None:
    program("solve", "half-short", "--tolerance", "1e-2", "--out", tmp_path / "theirs")
    solution.write(tmp_path / "own")
    for name in ("pressure.csv", "curves.csv"):
        assert (tmp_path / "own" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    assert json.loads((tmp_path / "own/summary.json").read_text()) == solution.summary


def test_pressure_broadcasts_and_vanishes_outside(solution: edgeline.Solution) -> None:
    c, half = solution.summary["hertz"]["c_m"], 0.5 * solution.case.tables["roller"]["length_m"]
    x, y = np.linspace(-2.0 * c, 2.0 * c, 7), np.linspace(-1.5 * half, 1.5 * half, 5)
    grid = solution.pressure(x[:, None], y)
    assert grid.shape == (7, 5) and grid.dtype == np.float64
    assert grid[3, 2] == solution.pressure(0.0, 0.0) == solution.summary["p_centre_pa"]
    assert grid[1, 3] == solution.pressure(x[1], y[3])
    assert (grid[[0, -1]] == 0.0).all() and (grid[:, [0, -1]] == 0.0).all()
    assert np.array_equal(grid, grid[::-1]) and np.array_equal(grid, grid[:, ::-1])
    assert solution.pressure(0, [0, 1]).shape == (2,)
    assert solution.pressure([], 0.0).shape == (0,)
    with pytest.raises(ValueError, match="broadcast"):
        solution.pressure([0.0, 0.0], [0.0, 0.0, 0.0])


def test_stresses_broadcast_and_meet_the_curves(solution: edgeline.Solution) -> None:
    curves = solution.curves
    for body in ("block", "roller"):
        of_body = np.flatnonzero(curves["body"] == body)[::40]
        at = [curves[f"{axis}_m"][of_body] for axis in "xyz"]
        stress = solution.stress(body, *at)
        wanted = [curves[f"sigma_{name}_pa"][of_body] for name in edgeline.COMPONENTS]
        # Points of curves between those that carry the field are interpolated, to the tolerance.
        p0 = solution.summary["hertz"]["p0_pa"]
        assert np.abs(stress - np.stack(wanted, axis=-1)).max() < 1e-2 * p0
        measure = np.abs(edgeline.von_mises(stress) - curves["von_mises_pa"][of_body])
        assert measure.max() < 1e-2 * p0
    c = solution.summary["hertz"]["c_m"]
    grid = solution.stress("block", np.zeros((2, 1, 1)), [[0.0], [c]], [0.0, c, 2.0 * c])
    assert grid.shape == (2, 2, 3, 6)
    single = solution.stress("block", 0.0, c, 2.0 * c)
    assert single.shape == (6,)
    assert np.allclose(grid[0, 1, 2], single, rtol=1e-9)
    # The surface carries the pressure.
    assert solution.stress("block", 0.0, 0.0, 0.0)[2] == pytest.approx(
        -solution.pressure(0.0, 0.0), rel=1e-2
    )


def test_results_outlive_everything_else() -> None:
    solution = edgeline.solve(edgeline.Case.from_toml("flush-short"), tolerance=1e-2)
    pressure, cells = solution.pressure(0.0, 0.0), solution.cells
    stress = solution.stress("roller", 0.0, 0.0, [0.0, 1e-4])
    before = pressure.copy(), cells["p_pa"].copy(), stress.copy()
    del solution
    gc.collect()
    for now, then in zip((pressure, cells["p_pa"], stress), before, strict=True):
        assert np.array_equal(now, then)


@pytest.mark.parametrize("method", ["half-space", "mirror", "guilbault", "quarter-space"])
def test_every_method_carries_the_load(case: edgeline.Case, method: str) -> None:
    solution = edgeline.solve(case, method, tolerance=1e-2, engine="line")
    cells = solution.cells
    load = np.sum(cells["p_pa"] * cells["dx_m"] * cells["dy_m"])
    assert load == pytest.approx(solution.summary["load_n"], rel=1e-9)
    assert solution.summary["method"] == method and method in repr(solution)


def test_a_place_on_cells_is_one_from_the_rollers_middle() -> None:
    body = {"length_m": 6e-3, "young_pa": 210e9, "poisson": 0.3}
    case = edgeline.Case(
        name="offset", roller={"radius_m": 8e-3, **body}, block=body,
        load={"force_n": 9000.0}, pose={"offset_m": 1.6e-3},
    )
    solution = edgeline.solve(case, "mirror", tolerance=1e-4, engine="cells")
    cells = solution.cells
    found = solution.pressure(cells["x_m"], cells["y_m"])
    assert np.array_equal(found, cells["p_pa"])


def test_the_engine_on_cells(case: edgeline.Case, tmp_path: Path, program: Any) -> None:
    solution = edgeline.solve(case, "mirror", tolerance=1e-6, engine="cells")
    command = ("solve", "half-short", "--method", "mirror", "--engine", "cells")
    done = program(*command, "--tolerance", "1e-6", "--out", tmp_path / "theirs")
    assert done.returncode == 0, done.stderr
    solution.write(tmp_path / "own")
    theirs = sorted(path.name for path in (tmp_path / "theirs").iterdir())
    for name in theirs:
        if name.endswith((".csv", ".npy")):
            own, other = (tmp_path / side / name for side in ("own", "theirs"))
            assert own.read_bytes() == other.read_bytes(), name
    assert solution.summary["details"]["engine"] == "cells"
    # Along a curve off the end, the same stresses as at its points.
    curves = solution.curves
    at = np.flatnonzero((curves["body"] == "block") & (curves["curve"] == "depth-centre"))[::10]
    stress = solution.stress("block", *(curves[f"{axis}_m"][at] for axis in "xyz"))
    assert np.allclose(stress[:, 2], curves["sigma_zz_pa"][at], rtol=1e-9)
    assert solution.pressure(0.0, 0.0) == solution.summary["p_centre_pa"]
    with pytest.raises(edgeline.Error, match="a relative residual on cells"):
        edgeline.solve(case, "mirror", tolerance=0.1, engine="cells")


def test_what_does_not_exist_is_refused(case: edgeline.Case, solution: edgeline.Solution) -> None:
    for refused, wanted in [
        (lambda: edgeline.solve(case, "quarter"), 'method = "quarter" is not valid'),
        (lambda: edgeline.solve(case, engine="lines"), 'engine = "lines" is not valid'),
        (lambda: solution.stress("blok", 0, 0, 0), 'body = "blok" is not valid'),
        (lambda: solution.stress("block", 0, 0, [0, -1]), "z of point 2 (block) = -1 m"),
        (lambda: solution.stress("roller", 0, 1, 0), "y of point 1 (roller) = 1 m"),
        (lambda: solution.stress("block", np.nan, 0, 0), "x of point 1 (block) = NaN m"),
        (lambda: solution.stress("block", [0] * 5000, 0, [0] * 4999 + [-1]), "z of point 5000"),
        (lambda: solution.pressure([0, np.nan], 0), "point 2 = (NaN, 0) m"),
        (lambda: solution.write(""), "folder = ''"),
    ]:
        with pytest.raises(edgeline.Error) as error:
            refused()
        assert str(error.value).startswith(wanted)
    with pytest.raises(TypeError, match="'flush-short' is no Case"):
        edgeline.solve("flush-short")  # type: ignore[arg-type]


def test_a_tolerance_is_refused_as_by_the_command_line(
    case: edgeline.Case, tmp_path: Path, program: Any
) -> None:
    said = program("solve", "half-short", "--tolerance", "2", "--out", tmp_path)
    with pytest.raises(edgeline.Error) as refused:
        edgeline.solve(case, tolerance=2.0)
    assert said.stderr == f"error: {refused.value}\n"


def test_datasets_hold_pressures_and_stresses(solution: edgeline.Solution) -> None:
    pytest.importorskip("xarray")
    c = solution.summary["hertz"]["c_m"]
    # Every other value of a longer axis: the values need not lie side by side.
    x, y, z = np.linspace(-c, c, 9)[::2], np.linspace(0.0, c, 3), np.array([0.1 * c, c])
    flat = solution.to_xarray(x, y)
    assert flat["p_pa"].dims == ("x", "y") and flat["p_pa"].attrs["units"] == "Pa"
    assert np.array_equal(flat["p_pa"], solution.pressure(x[:, None], y))
    for body in ("block", "roller"):
        field = solution.to_xarray(x, y, z, body=body)
        stress = solution.stress(body, x[:, None, None], y[:, None], z)
        p0 = solution.summary["hertz"]["p0_pa"]
        for i, name in enumerate(edgeline.COMPONENTS):
            assert field[f"sigma_{name}_pa"].shape == (5, 3, 2)
            assert np.abs(field[f"sigma_{name}_pa"] - stress[..., i]).max() < 1e-6 * p0, name
        assert np.allclose(field["von_mises_pa"], edgeline.von_mises(stress), atol=1e-6 * p0)
        assert field["sigma_xx_pa"].sel(z=1).sizes == {"x": 5, "y": 3}


def test_plots_show_pressure_and_curves(solution: edgeline.Solution) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    ax = solution.plot()
    line = ax.lines[0]
    assert np.max(line.get_ydata()) == pytest.approx(1e-6 * solution.summary["p_max_pa"], rel=0.1)
    assert solution.plot(ax=ax) is ax
    lines = solution.plot("depth-centre", "roller").lines
    # Without colour, too, no two look alike.
    looks = {(line.get_linestyle(), line.get_marker()) for line in lines}
    assert len(lines) == len(looks) == 7
    pyplot.close("all")
    with pytest.raises(edgeline.Error, match="give one of .*depth-centre"):
        solution.plot("depth-center")


def test_what_the_program_warns_of_is_a_warning() -> None:
    case = edgeline.Case.from_toml("flush-short")
    with pytest.warns(UserWarning, match="is that of a tolerance of 0.0001, which 5e-5 takes, too"):
        edgeline.solve(case, "half-space", tolerance=5e-5)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        edgeline.solve(case, tolerance=1e-2)
