"""Scenes without symmetry along y: the half model against the quarter model, and known answers."""

import csv
import dataclasses
import json
import math

import numpy as np
import pytest

from conftest import run_stage, steel_case
from edgeline_fem.record import standard_request
from edgeline_fem.request import Curve


def solved(folder, case, size, curves=None, lines=None, **mesh):
    """A case solved by the command line: its fem.json, and the rows of curves.csv and pressure.csv."""
    folder.mkdir(exist_ok=True)
    request = standard_request(case, size, **mesh)
    metres = case.scales().c_m
    if curves is not None:
        wanted = [Curve(body, name, (np.array(points) * metres).tolist()) for body, name, points in curves]
        request = dataclasses.replace(request, curves=wanted)
    if lines is not None:
        request = dataclasses.replace(request, pressure_points_m={
            name: (np.array(points) * metres).tolist() for name, points in lines.items()
        })
    path = folder / "request.json"
    path.write_text(json.dumps(request.to_json()))
    for stage in ("mesh", "solve"):
        done = run_stage(stage, path, folder)
        assert done.returncode == 0, done.stderr
    tables = []
    for name in ("curves.csv", "pressure.csv"):
        with open(folder / name, newline="", encoding="utf-8") as file:
            tables.append(list(csv.DictReader(file)))
    return json.loads((folder / "fem.json").read_text()), *tables


def in_p0(case, rows, *columns):
    """Columns of a table in p0, (n, columns)."""
    return np.array([[float(row[name]) for name in columns] for row in rows]) / case.scales().p0_pa


STRESSES = [f"sigma_{c}_pa" for c in ("xx", "yy", "zz", "xy", "xz", "yz")]


@pytest.mark.parametrize("length_ratio", [0.75, 1.0, 1.25])
def test_a_symmetric_scene_is_that_of_the_quarter_model(tmp_path, length_ratio):
    """The same pressure and stresses to 1e-6 p0, at both ends, and no tilt."""
    case = steel_case(1e-3, 3.0, length_ratio)
    summary, curves, pressure = solved(tmp_path / "quarter", case, 4.0)
    assert "tilt_rad" not in summary
    whole, same, line = solved(tmp_path / "half", dataclasses.replace(case, eccentricity_m=0.0), 4.0)
    assert whole["unknowns"] > 1.7 * summary["unknowns"]
    assert abs(whole["tilt_rad"]) < 1e-9 and abs(whole["centre_of_pressure_m"][1]) < 1e-9 * case.roller_length_m
    for key in ("p_centre_pa", "approach_m"):
        assert whole[key] == pytest.approx(summary[key], rel=1e-6), key
    assert whole["load_error_rel"] < 1e-10 and whole["equilibrium_residual"] < 1e-8
    assert in_p0(case, same, *STRESSES) == pytest.approx(in_p0(case, curves, *STRESSES), abs=1e-6)
    assert in_p0(case, line, "p_pa") == pytest.approx(in_p0(case, pressure, "p_pa"), abs=1e-6)

    # At the other end sigma_xy and sigma_yz change sign, everything else does not.
    scales = case.scales()
    turned = [(row["body"], row["curve"], [[float(row["x_m"]) / scales.c_m, -float(row["y_m"]) / scales.c_m,
                                            float(row["z_m"]) / scales.c_m]]) for row in same[::7]]
    _, other, _ = solved(tmp_path / "half", dataclasses.replace(case, eccentricity_m=0.0), 4.0, turned)
    mirrored = in_p0(case, same[::7], *STRESSES) * [1, 1, 1, -1, 1, -1]
    assert in_p0(case, other, *STRESSES) == pytest.approx(mirrored, abs=1e-6)


def test_an_eccentric_load(tmp_path):
    """S_l = 5 flush, the load 0.08 L1 off the middle: an independent semi-analytical calculation's pressures."""
    case = steel_case(5e-4, 5.0, 1.0)
    case = dataclasses.replace(case, eccentricity_m=0.08 * case.roller_length_m)
    expected = {-4.7: 0.613, -4.0: 0.757, -2.0: 0.913, 0.0: 1.018, 2.0: 1.107, 4.0: 1.161, 4.7: 1.071}
    summary, _, line = solved(tmp_path, case, 2.0, [], {"along-y": [[0.0, y] for y in expected]})
    found = in_p0(case, line, "p_pa")[:, 0]
    assert found == pytest.approx(list(expected.values()), abs=0.008)
    assert math.sqrt(np.mean((found - list(expected.values())) ** 2)) < 0.005
    assert summary["load_error_rel"] < 1e-10
    assert summary["centre_of_pressure_m"][1] == pytest.approx(case.eccentricity_m, rel=1e-9)
    assert summary["tilt_rad"] > 0.0, "the side of larger y is pressed deeper"
    assert summary["compliance_applications"] < 40


LINE = {"along-y": [[0.0, y] for y in np.linspace(-2.9, 2.9, 13)]}


@pytest.fixture(scope="module")
def eccentric(tmp_path_factory):
    """A load off the middle on a block that is shifted, coarse: (case, fem.json, pressures)."""
    case = steel_case(1e-3, 3.0, 0.75)
    case = dataclasses.replace(
        case, eccentricity_m=0.05 * case.roller_length_m, offset_m=0.1 * case.roller_length_m
    )
    summary, _, line = solved(tmp_path_factory.mktemp("eccentric"), case, 4.0, [], LINE)
    return case, summary, in_p0(case, line, "p_pa")[:, 0]


def test_the_tilt_that_an_eccentric_load_finds_holds_it(eccentric, tmp_path):
    case, summary, pressure = eccentric
    held = dataclasses.replace(case, eccentricity_m=None, tilt_rad=summary["tilt_rad"])
    again, _, line = solved(tmp_path, held, 4.0, [], LINE)
    assert again["tilt_rad"] == pytest.approx(summary["tilt_rad"], rel=1e-5)
    assert again["centre_of_pressure_m"][1] == pytest.approx(case.eccentricity_m, rel=1e-4)
    assert in_p0(case, line, "p_pa")[:, 0] == pytest.approx(pressure, abs=1e-4)


def test_the_other_way_round_is_the_mirror_image(eccentric, tmp_path):
    case, summary, pressure = eccentric
    turned = dataclasses.replace(case, eccentricity_m=-case.eccentricity_m, offset_m=-case.offset_m)
    again, _, line = solved(tmp_path, turned, 4.0, [], LINE)
    assert again["tilt_rad"] == pytest.approx(-summary["tilt_rad"], rel=1e-6)
    assert in_p0(case, line, "p_pa")[::-1, 0] == pytest.approx(pressure, abs=1e-6)


def test_a_slope_of_the_profile_changes_the_tilt_and_nothing_else(eccentric, tmp_path):
    case, summary, pressure = eccentric
    half, slope = 0.5 * case.roller_length_m, 1e-3
    leaning = dataclasses.replace(case, roller_profile_m=((-half, -slope * half), (half, slope * half)))
    again, _, line = solved(tmp_path, leaning, 4.0, [], LINE, along=100.0)
    assert again["tilt_rad"] == pytest.approx(summary["tilt_rad"] + slope, rel=1e-6)
    assert in_p0(case, line, "p_pa")[:, 0] == pytest.approx(pressure, abs=1e-6)
    assert again["centre_of_pressure_m"] == pytest.approx(summary["centre_of_pressure_m"], rel=1e-9)


def hertz_ellipse(curvatures, load):
    """Half-axes along y and x (units of C) and peak pressure (p0) of an elliptical contact.

    ``curvatures``: the ratio of the relative curvature across to that along, 1 / R; ``load``: in p0 C^2. The axes'
    ratio by bisection, elliptic integrals by quadrature (Johnson, Contact Mechanics, 1985, Eqs. 4.25 and 4.26).
    """
    angles = (np.arange(4000) + 0.5) * 0.5 * math.pi / 4000
    low, high = 1.0001, 100.0
    for _ in range(60):
        ratio = math.sqrt(low * high)
        e2 = 1.0 - ratio**-2
        root = np.sqrt(1.0 - e2 * np.sin(angles) ** 2)
        k, e = 0.5 * math.pi * np.mean(1.0 / root), 0.5 * math.pi * np.mean(root)
        low, high = (ratio, high) if (e * ratio**2 - k) / (k - e) < curvatures else (low, ratio)
    # E* is 2 R, so that R drops out.
    along = (3.0 * load * curvatures * (k - e) / (2.0 * math.pi * e2)) ** (1.0 / 3.0)
    return along, along / ratio, 1.5 * load * ratio / (math.pi * along**2)


def test_a_crown_that_ends_the_contact_is_hertzs_ellipse(tmp_path):
    """A crown of three roller radii, its contact far from the ends: peak pressure, and both half-axes by its fall."""
    case = steel_case(2e-5, 8.0, 1.0)
    half, crown_m = 0.5 * case.roller_length_m, 3.0 * case.radius_m
    y = np.linspace(-half, half, 801)
    profile = tuple((float(v), float(v * v / (2.0 * crown_m))) for v in y)
    profiled = dataclasses.replace(case, roller_profile_m=profile)
    assert profiled.is_symmetric()
    along, across, peak = hertz_ellipse(3.0, 8.0 * math.pi)
    assert along < 0.5 * case.roller_half_length()
    parts = (0.0, 0.5, 0.8, 0.9, 1.1)
    places = {"y": [[0.0, f * along] for f in parts], "x": [[f * across, 0.0] for f in parts]}
    _, _, line = solved(tmp_path, profiled, 2.0, [], places, along=0.2, contact_reach=2.4)
    found = in_p0(case, line, "p_pa")[:, 0] / peak
    assert found == pytest.approx([math.sqrt(max(0.0, 1.0 - f * f)) for f in parts * 2], abs=0.012)
