"""What a request must hold, and the scales that follow from it."""

import dataclasses
import json
import math

import pytest

from conftest import run_stage, steel_case
from edgeline_fem.record import standard_request
from edgeline_fem.request import FemError, parse_request


def sound():
    return json.loads(json.dumps(standard_request(steel_case(5e-4, 5.0, 0.5), 2.0).to_json()))


def test_scales_and_lengths():
    case = steel_case(5e-4, 5.0, 0.5)
    scales = case.scales()
    assert scales.radius == pytest.approx(1.0 / (2.0 * math.sqrt(5e-4 / math.pi)), rel=1e-12)
    assert scales.p0_pa == pytest.approx(210e9 / 1.82 * math.sqrt(5e-4 / math.pi), rel=1e-12)
    assert case.roller_half_length() == pytest.approx(5.0, rel=1e-12)
    assert case.block_half_length() == pytest.approx(10.0, rel=1e-12)
    # The load is that of the Hertz pressure on the whole length: pi/2 p0 C 2 S_l C.
    assert case.force_n == pytest.approx(math.pi * 5.0 * scales.p0_pa * scales.c_m**2, rel=1e-12)


def test_a_request_survives_its_own_json():
    assert parse_request(sound()) == standard_request(steel_case(5e-4, 5.0, 0.5), 2.0)


def test_a_scene_without_symmetry_survives_its_own_json():
    case = dataclasses.replace(
        steel_case(5e-4, 5.0, 1.25), eccentricity_m=1e-4, offset_m=-2e-4,
        roller_profile_m=((-1.0, 1e-6), (0.0, 0.0), (1.0, 2e-6)),
    )
    data = json.loads(json.dumps(standard_request(case, 2.0).to_json()))
    assert data["case"]["roller"]["profile_m"] == [[-1.0, 1e-6], [0.0, 0.0], [1.0, 2e-6]]
    assert not {"tilt_rad", "profile_m"} & {*data["case"], *data["case"]["block"]}
    assert parse_request(data) == standard_request(case, 2.0)
    ending = dataclasses.replace(standard_request(case, 2.0), contact_ends_m=(-2e-4, 3e-4))
    assert parse_request(json.loads(json.dumps(ending.to_json()))) == ending
    assert ending.tips() == pytest.approx([-2e-4 / case.scales().c_m, 3e-4 / case.scales().c_m])
    data["case"]["tilt_rad"] = 1e-4
    with pytest.raises(FemError, match="'eccentricity_m' and 'tilt_rad' exclude each other"):
        parse_request(data)


def test_what_is_symmetric():
    case = steel_case(5e-4, 5.0, 0.5)
    crown = ((-1.0, 1e-6), (-0.5, 0.0), (0.5, 0.0), (1.0, 1e-6))
    assert dataclasses.replace(case, roller_profile_m=crown, tilt_rad=0.0).is_symmetric()
    leaning = (*crown[:3], (1.0, 2e-6))
    for change in ({"block_profile_m": leaning}, {"eccentricity_m": 0.0}, {"tilt_rad": 1e-5}, {"offset_m": 1e-4}):
        assert not dataclasses.replace(case, **change).is_symmetric(), change


def change(data, path, value):
    *parents, last = path
    for key in parents:
        data = data[key]
    data[last] = value


@pytest.mark.parametrize(
    ("path", "value", "complaint"),
    [
        (["schema"], 2, "'schema' is 2"),
        (["case", "force_n"], -1.0, "'force_n' must be a finite number above 0"),
        (["case", "force_n"], float("nan"), "'force_n' must be a finite number above 0"),
        (["case", "roller", "poisson"], 0.5, r"'poisson' must lie in \[0, 0.5\)"),
        (["case", "block", "profile_m"], [[-0.1, 0.0], [0.1]], "points of 2 finite numbers"),
        (["case", "roller", "profile_m"], [[-0.1, 0.0], [0.1, 0.0], [0.1, 0.0]], "y must ascend"),
        (["case", "roller", "profile_m"], [[0.0, 0.0], [0.1, 0.0]], "must reach from -"),
        (["case", "offset_m"], 1.0, "the bodies do not overlap: 'offset_m' = 1 leaves them"),
        (["case", "tilt_rad"], float("inf"), "'tilt_rad' must be a finite number"),
        (["case", "block", "lenght_m"], 1.0, "unknown key 'lenght_m'; known are length_m"),
        (["mesh", "sise"], 1.0, "unknown key 'sise'"),
        (["mesh", "size"], 0, "'size' must be a finite number above 0"),
        (["solver", "linear"], "magic", "'linear' must be direct or iterative"),
        (["solver", "max_iterations"], 1.5, "'max_iterations' must be a whole number"),
        (["curves", 0, "body"], "ball", "'body' must be block or roller"),
        (["curves", 0, "points_m"], [[0.0, 1.0]], "points of 3 finite numbers"),
        (["gmsh"], "", "'gmsh' must be"),
        (["gmsh"], "a\0b", "'gmsh' must be"),
        (["pressure_points_m", "a,b"], [[0.0, 0.0]], "pressure_points_m: 'a,b' must be a name without commas"),
        (["pressure_points_m", ""], [[0.0, 0.0]], "pressure_points_m: '' must be a name without commas"),
        (["curves"], 5, "'curves' must be a list of objects, not 5"),
        (["curves"], None, "'curves' must be a list of objects, not None"),
        (["case", "name"], 5, "'name' must be a text"),
        (["case", "force_n"], 10**400, "'force_n' must be a finite number above 0"),
        (["case", "force_n"], 1e-320, "half-width and pressure are no finite numbers"),
        (["mesh", "size"], 10**400, "'size' must be a finite number above 0"),
        (["contact_ends_m"], [0.0, "end"], "'contact_ends_m' must be a list of finite numbers"),
    ],
)
def test_a_bad_request_is_named(path, value, complaint):
    data = sound()
    change(data, path, value)
    with pytest.raises(FemError, match=complaint):
        parse_request(data)


def test_the_command_line_fails_with_code_2_and_leaves_nothing(tmp_path):
    request = tmp_path / "request.json"
    request.write_text("{")
    done = run_stage("mesh", request, tmp_path / "out")
    assert done.returncode == 2
    assert done.stderr.startswith("error: ") and "is not JSON" in done.stderr
    assert not (tmp_path / "out").exists()

    request.write_text("[" * 100_000)
    done = run_stage("mesh", request, tmp_path / "out")
    assert done.returncode == 2 and "is not JSON" in done.stderr

    request.write_text(json.dumps({**sound(), "gmsh": "\ud800"}))
    done = run_stage("mesh", request, tmp_path / "out")
    assert done.returncode == 2 and "has a lone surrogate in a text" in done.stderr, done.stderr

    data = sound()
    data["gmsh"] = "no-such-gmsh"
    request.write_text(json.dumps(data))
    done = run_stage("mesh", request, tmp_path / "out")
    assert done.returncode == 2 and "no-such-gmsh" in done.stderr
    assert not (tmp_path / "out" / "mesh.json").exists()

    done = run_stage("solve", request, tmp_path / "out")
    assert done.returncode == 2 and "run the mesh stage first" in done.stderr
    meshed = {"gmsh": "4", "options": {}, "contact_ends_c": [], "smallest_c": {}, "bodies": {"block": {"unknowns": 3}},
              "axes_c": dict.fromkeys(("x_contact", "y_contact", "z_block"), [0.0, 1.0]), "seconds": {"block": 1.0},
              "cpu_seconds": 1.0}
    for bad in ({}, {**meshed, "seconds": {"block": "1"}}, {**meshed, "bodies": {"block": 3}}, {**meshed, "gmsh": None},
                *({**meshed, "axes_c": {**meshed["axes_c"], "y_contact": axis}}
                  for axis in ([0.0, "1"], [0.0], [0.0, None], [1.0, 0.0], [0.0, [1.0]], 5))):
        (tmp_path / "out" / "mesh.json").write_text(json.dumps(bad))
        for stage in ("points", "solve"):
            done = run_stage(stage, request, tmp_path / "out")
            assert done.returncode == 2 and "run the mesh stage again" in done.stderr, (bad, done.stderr)
