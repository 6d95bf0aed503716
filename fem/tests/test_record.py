"""Records: resumable, error estimates with known answers."""

import dataclasses
import fcntl
import json
import os
import re
import subprocess
import sys

import pytest

from conftest import FEM, STEEL, steel_case
from edgeline_fem.record import (
    COMPONENTS, Run, check_record, keep, observed_orders, order_and_factor, read_cases, record,
    standard_request,
)
from edgeline_fem.request import FemError


def test_order_and_factor_of_a_known_sequence():
    """Values 1 + h^2 on sizes 2, 1.4 and 1: second order, the finest is off by 1."""
    values = [1.0 + h**2 for h in (2.0, 1.4, 1.0)]
    order, factor = order_and_factor((values[0] - values[1], values[1] - values[2]), (2.0, 1.4, 1.0))
    assert order == pytest.approx(2.0, abs=1e-9)
    assert factor * (values[1] - values[2]) == pytest.approx(1.0, rel=1e-9)
    assert order_and_factor((1.0, 2.0), (2.0, 1.4, 1.0)) == (None, None)


def test_cases_file(tmp_path):
    path = tmp_path / "cases.toml"
    path.write_text(
        '["a"]\nW = 1e-4\nS_l = 5.0\nL_r = 0.5\n'
        "roller = { radius_m = 0.01, young_pa = 210e9, poisson = 0.3 }\n"
        "block = { young_pa = 210e9, poisson = 0.3 }\n"
    )
    case = read_cases(path)["a"]
    assert case.roller == STEEL
    assert case.to_json() == {**steel_case(1e-4, 5.0, 0.5).to_json(), "name": "a"}
    path.write_text('["a"]\nW = 1e-4\n')
    with pytest.raises(FemError, match="case a has no 'roller'"):
        read_cases(path)


LISTED = {
    "W": "1e-4", "S_l": "5.0", "L_r": "0.5", "block": "{ young_pa = 210e9, poisson = 0.3 }",
    "roller": "{ radius_m = 0.01, young_pa = 210e9, poisson = 0.3 }",
}


@pytest.mark.parametrize(("change", "complaint"), [
    ({"W": "'1e-4'"}, "case a: 'W' must be a finite number above 0, not '1e-4'"),
    ({"W": "-1e-4"}, "case a: 'W' must be a finite number above 0"),
    ({"S_l": "inf"}, "case a: 'S_l' must be a finite number above 0"),
    ({"roller": "5"}, "case a: 'roller' is missing or is not an object"),
    ({"block": "{ young_pa = true, poisson = 0.3 }"}, "case a.block: 'young_pa' must be a finite number"),
    ({"block": "{ young_pa = 210e9, poisson = 0.7 }"}, "case a.block: 'poisson' must lie in"),
    ({"friction": "'much'"}, "case a: 'friction' must be a finite number"),
    ({"fricton": "0.1"}, "case a: unknown key 'fricton'; known are L_r, S_l, W, block, friction, roller"),
])
def test_a_bad_case_of_the_list_is_named(tmp_path, change, complaint):
    path = tmp_path / "cases.toml"
    path.write_text("[a]\n" + "".join(f"{key} = {value}\n" for key, value in {**LISTED, **change}.items()))
    with pytest.raises(FemError, match=re.escape(f"{path}: ") + complaint):
        read_cases(path)


@pytest.mark.parametrize(("text", "complaint"), [
    (b"a = 5", r"case a: must be a table, \[a\], not 5"),
    (b"['../a']", "the case's name '../a' is not valid"),
    (b"\xff", "cannot be read"),
])
def test_what_is_no_list_of_cases_is_refused(tmp_path, text, complaint):
    (tmp_path / "cases.toml").write_bytes(text)
    with pytest.raises(FemError, match=complaint):
        read_cases(tmp_path / "cases.toml")


def test_a_record_grows_and_is_not_made_twice(tmp_path):
    case = steel_case(5e-4, 5.0, 1.0)
    lines = []
    # Coarser than any mesh in use: what is tested is the file, not the numbers.
    assert record(case, 4.0, tmp_path, lines.append)
    assert record(case, 3.0, tmp_path, lines.append)
    before = (tmp_path / "test" / "record.json").read_bytes()
    assert not record(case, 3.0, tmp_path, lines.append)
    assert (tmp_path / "test" / "record.json").read_bytes() == before
    data = json.loads(before)
    assert list(data["meshes"]) == ["4", "3"]
    assert data["dimensionless"] == pytest.approx({"W": 5e-4, "S_l": 5.0, "L_r": 1.0})
    assert {e["curve"] for e in data["errors"]} >= {"along-y", "depth-centre"}
    assert set(data["orders"].values()) == {None}, "two meshes show no order"
    assert all(0.0 < mesh["cpu_seconds"] for mesh in data["meshes"].values())
    curves = (tmp_path / "test" / "curves.csv").read_text().splitlines()
    assert curves[0].startswith("mesh,body,curve,x_m")
    assert sum(line.startswith("4,") for line in curves) == sum(line.startswith("3,") for line in curves)
    assert not list((tmp_path / "test").glob(".work*"))
    with pytest.raises(FemError, match="holds another case"):
        other = steel_case(6e-4, 5.0, 1.0)
        record(other, 3.0, tmp_path, lines.append)


def made_up_run(folder, case, size, engine="fenicsx", profile=None):
    """A folder as a run leaves it, without fem.json; every stress and pressure is the same."""
    folder.mkdir()
    asked = standard_request(case, size).to_json()
    if engine != "fenicsx":
        asked["engine"] = engine
    if profile is not None:
        half = 0.5 * case.roller_length_m
        points = [[-half, 1e-7], [0.0, 0.0], [half, 1e-7]]
        asked["case"]["roller"].update(profile=profile, profile_m=points)
    (folder / "request.json").write_text(json.dumps(asked))
    rows = [f"{curve['body']},{curve['curve']},{point[0]},{point[1]},{point[2]}," + ",".join(["1e9"] * 8)
            for curve in asked["curves"] for point in curve["points_m"]]
    names = ",".join(f"{name}_pa" for name in COMPONENTS)
    (folder / "curves.csv").write_text("\n".join([f"body,curve,x_m,y_m,z_m,{names}", *rows]) + "\n")
    rows = [f"{line},{point[0]},{point[1]},1e9,1e9,1e9"
            for line, points in asked["pressure_points_m"].items() for point in points]
    head = "line,x_m,y_m,p_pa,p_lumped_pa,p_stress_pa"
    (folder / "pressure.csv").write_text("\n".join([head, *rows]) + "\n")
    return folder


def finish(run):
    """Let the made-up run end; its fem.json names the code as that of a real one does."""
    asked = json.loads((run / "request.json").read_text())
    named = {"engine": asked["engine"]} if "engine" in asked else {}
    mesh = {"options": asked["mesh"]}
    summary = {"schema": 1, **named, "case": "test", "hertz": {}, "mesh": mesh, "unknowns": 7}
    (run / "fem.json").write_text(json.dumps(summary))
    return run


def test_finished_runs_become_a_record(tmp_path):
    case = dataclasses.replace(steel_case(5e-4, 5.0, 1.0), eccentricity_m=1e-4)
    # A profile's own form stands beside its points, and alone in the record.
    runs = [made_up_run(tmp_path / f"run-{size:g}", case, size, profile={"kind": "crown"})
            for size in (4.0, 3.0)]
    with pytest.raises(FemError, match="not finished"):
        keep(runs, tmp_path / "kept", print)
    for run in runs:
        finish(run)
    keep(runs, tmp_path / "kept", print)
    kept = tmp_path / "kept" / "test"
    check_record(kept)
    data = json.loads((kept / "record.json").read_text())
    assert list(data["meshes"]) == ["4", "3"]
    assert data["meshes"]["3"]["command"] == "edgeline fem cases/test.toml --size 3"
    keep(runs[-1:], tmp_path / "kept", print, "profiled")
    data = json.loads((kept / "record.json").read_text())
    assert data["meshes"]["3"]["command"] == "edgeline study profiled --fem live --size 3"
    assert data["case"]["eccentricity_m"] == 1e-4
    assert data["case"]["roller"]["profile"] == {"kind": "crown"}
    assert "profile_m" not in data["case"]["roller"]
    assert data["errors"] and all(entry["difference_max"] == 0.0 for entry in data["errors"])
    other = json.loads((runs[0] / "request.json").read_text())
    other["case"]["eccentricity_m"] = 2e-4
    (runs[0] / "request.json").write_text(json.dumps(other))
    with pytest.raises(FemError, match="holds another case"):
        keep(runs[:1], tmp_path / "kept", print)


@pytest.mark.parametrize("engines", [("fenicsx", "calculix"), ("calculix", "fenicsx")])
def test_a_record_is_of_one_code(tmp_path, engines):
    case = steel_case(5e-4, 5.0, 1.0)
    first, second = (finish(made_up_run(tmp_path / engine, case, 3.0 - number, engine))
                     for number, engine in enumerate(engines))
    kept = tmp_path / "kept" / "test"
    keep([first], tmp_path / "kept", print)
    before = {path.name: path.read_bytes() for path in kept.iterdir()}
    message = f"{kept}/record.json: holds meshes by {engines[0]}, but the run {second} is by {engines[1]}; "
    with pytest.raises(FemError, match=re.escape(message)):
        keep([second], tmp_path / "kept", print)
    # Nor does the recorder take a mesh of that size for its own.
    with pytest.raises(FemError, match=f"but size 3 is by {engines[1]}"):
        record(case, 3.0, tmp_path / "kept", print, Run(engine=engines[1]))
    assert {path.name: path.read_bytes() for path in kept.iterdir()} == before
    keep([second], tmp_path / "other", print)


@pytest.mark.parametrize(("change", "engine", "complaint"), [
    ({}, "calculix", "second: is by calculix, but .*first is by fenicsx"),
    ({"eccentricity_m": 1e-4}, "fenicsx", "second: holds another case than .*first"),
    ({"name": "other"}, "calculix", "other/record.json: holds meshes by fenicsx, but the run .*second is by calculix"),
    ({"name": "other", "eccentricity_m": 1e-4}, "fenicsx", "other/record.json: holds another case"),
    ({"name": "../other"}, "fenicsx", "second/request.json: the case's name '../other' is not valid"),
    ({"name": ""}, "fenicsx", "second/request.json: the case's name '' is not valid"),
])
def test_runs_are_checked_against_each_other_and_their_records_first(tmp_path, change, engine, complaint):
    case = steel_case(5e-4, 5.0, 1.0)
    kept = tmp_path / "kept"
    keep([finish(made_up_run(tmp_path / "before", dataclasses.replace(case, name="other"), 3.0))], kept, print)
    before = {path: path.read_bytes() for path in kept.rglob("*") if path.is_file()}
    first = finish(made_up_run(tmp_path / "first", case, 4.0))
    second = finish(made_up_run(tmp_path / "second", dataclasses.replace(case, **change), 3.0, engine))
    with pytest.raises(FemError, match=complaint):
        keep([first, second], kept, print)
    assert {path: path.read_bytes() for path in kept.rglob("*") if path.is_file()} == before


def test_one_run_of_each_size_is_kept(tmp_path):
    case = steel_case(5e-4, 5.0, 1.0)
    runs = [finish(made_up_run(tmp_path / name, case, 3.0)) for name in ("one", "two")]
    with pytest.raises(FemError, match="two: is of the same size as .*one; give one of them"):
        keep(runs, tmp_path / "kept", print)
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize("profile", [{"kind": "table", "file": "drop.csv"}, {}])
def test_a_table_as_profile_is_not_kept(tmp_path, profile):
    case = steel_case(5e-4, 5.0, 1.0)
    runs = [finish(made_up_run(tmp_path / "straight", case, 3.0)),
            finish(made_up_run(tmp_path / "measured", case, 2.0, profile=profile))]
    message = "measured/request.json: the roller's profile is a table, .* give the profile as a formula"
    with pytest.raises(FemError, match=message):
        keep(runs, tmp_path / "kept", print)
    assert not (tmp_path / "kept").exists()


def swapped(text):
    lines = text.splitlines()
    lines[1], lines[2] = lines[2], lines[1]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    "name, change, complaint",
    [
        ("curves.csv", lambda text: text.replace("1e9", "nan", 1), "line 2 has a value that is no finite"),
        ("curves.csv", swapped, "line 2 is not the point that the request has there"),
        ("curves.csv", lambda text: text[: len(text) // 2], "points, the request"),
        ("pressure.csv", lambda text: "", "has 0 points"),
        ("pressure.csv", None, "has 0 points"),
        ("fem.json", lambda text: "{}", "'schema' is missing"),
        ("fem.json", lambda text: text.replace("7", "NaN"), "not finite"),
    ],
)
def test_a_damaged_run_leaves_all_records_alone(tmp_path, name, change, complaint):
    case = steel_case(5e-4, 5.0, 1.0)
    runs = [finish(made_up_run(tmp_path / f"run-{size:g}", case, size)) for size in (4.0, 3.0)]
    path = runs[1] / name
    if change is None:
        path.unlink()
    else:
        path.write_text(change(path.read_text()))
    with pytest.raises(FemError, match=f"run-3/{name}: .*{complaint}"):
        keep(runs, tmp_path / "kept", print)
    assert not (tmp_path / "kept").exists()


def test_a_run_is_given_once(tmp_path):
    run = finish(made_up_run(tmp_path / "run", steel_case(5e-4, 5.0, 1.0), 3.0))
    with pytest.raises(FemError, match="is given twice"):
        keep([run, run], tmp_path / "kept", print)


def test_a_size_is_what_is_written_of_it(tmp_path):
    case = steel_case(5e-4, 5.0, 1.0)
    unround = 1.4 * 1.4
    assert unround != 1.96
    run = finish(made_up_run(tmp_path / "run", case, unround))
    keep([run], tmp_path / "kept", print)
    kept = tmp_path / "kept" / "test"
    before = {name: (kept / name).read_bytes() for name in ("curves.csv", "pressure.csv")}
    keep([run], tmp_path / "kept", print)
    assert {name: (kept / name).read_bytes() for name in before} == before
    # It has that mesh, and does not solve it.
    assert not record(case, 1.96, tmp_path / "kept", print)
    assert not record(case, unround, tmp_path / "kept", print)


def test_every_case_on_record_converges_to_what_is_promised():
    """Positive orders; the two finest meshes within 0.5 % of p0 in pressure and 1.1 % in stresses.

    The finest one's error, Richardson's estimate or, where there is none, that difference: 1 % in stresses and
    0.5 % in pressure.
    """
    folder = FEM.parent / "results/reference"
    for name, case in read_cases(folder / "cases.toml").items():
        data = json.loads((folder / name / "record.json").read_text())
        finer = ["0.85"] if name == "w1e-3_sl20_lr0.5" else []
        assert list(data["meshes"]) == ["2", "1.4", "1", *finer], name
        assert all(order is not None and order > 0.0 for order in data["orders"].values()), name
        scales = case.scales()
        again = observed_orders(folder / name, 0.5 * case.roller_length_m, scales.c_m, scales.p0_pa)
        assert again == data["orders"], name
        for entry in data["errors"]:
            pressure = entry["component"] == "pressure"
            assert entry["difference_max"] <= (0.005 if pressure else 0.011), (name, entry)
            error = entry["difference_max"] if entry["error_max"] is None else entry["error_max"]
            assert error <= (0.005 if pressure else 0.01), (name, entry)


def test_two_processes_do_not_record_one_case(tmp_path):
    case = steel_case(5e-4, 5.0, 1.0)
    (tmp_path / "test").mkdir()
    handle = os.open(tmp_path / "test", os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        with pytest.raises(FemError, match="another process is recording"):
            record(case, 4.0, tmp_path, print)
    finally:
        os.close(handle)


@pytest.mark.slow
def test_the_cluster_script_records_with_two_ranks(tmp_path):
    (tmp_path / "cases.toml").write_text(
        '["other"]\nW = 1e-4\nS_l = 5.0\nL_r = 1.0\n'
        "roller = { radius_m = 0.01, young_pa = 210e9, poisson = 0.3 }\n"
        "block = { young_pa = 210e9, poisson = 0.3 }\n"
        '["flush"]\nW = 5e-4\nS_l = 3.0\nL_r = 1.0\n'
        "roller = { radius_m = 0.01, young_pa = 210e9, poisson = 0.3 }\n"
        "block = { young_pa = 210e9, poisson = 0.3 }\n"
    )
    environment = {
        **os.environ, "SLURM_ARRAY_TASK_ID": "2", "SLURM_NTASKS": "2", "SLURM_SUBMIT_DIR": str(FEM.parent),
        "LAUNCHER": "mpirun --oversubscribe -n {ranks}", "PYTHON": sys.executable,
        "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    }
    script = FEM.parent / "docs/cluster/record.sbatch"
    done = subprocess.run(["bash", str(script), str(tmp_path), "4", "3"], capture_output=True, text=True,
                          env=environment, cwd="/", check=False)
    assert done.returncode == 0, done.stderr
    data = json.loads((tmp_path / "flush" / "record.json").read_text())
    assert [data["meshes"][size]["ranks"] for size in ("4", "3")] == [2, 2]
    assert not (tmp_path / "other").exists()
