"""Bodies that slide on each other: known answers, and the laws of what friction adds."""

import dataclasses

import numpy as np
import pytest

from conftest import steel_case
from edgeline_fem.recovery import enforce_tractions, hertz_traction_stress
from edgeline_fem.request import FemError, parse_request
from edgeline_fem.standard_points import CURVES, standard_curves
from test_half import STRESSES, in_p0, solved


def test_curves_of_bodies_that_slide_stand_on_both_sides():
    curves = standard_curves(5.0, 10.0, slides=True)
    assert tuple(curves)[: len(CURVES)] == CURVES and len(curves) == len(CURVES) + 6
    across = [x for x, _, _ in curves["surface-along-x"]]
    assert len(across) == 69 and across == sorted(across) and across[0] == -3.0
    assert curves["depth-end-x1.4-xneg"][0] == (-1.4, 5.0, 0.0)
    assert curves["depth-end"] == standard_curves(5.0, 10.0)["depth-end"]


def test_hertz_traction_stress_against_integrated_line_loads():
    half_width, peak, poisson = 0.8, 1.3, 0.3
    t, weight = np.polynomial.legendre.leggauss(400)
    angle = 0.5 * np.pi * t
    load = peak * half_width * np.cos(angle) ** 2 * 0.5 * np.pi * weight
    for x, z in ((0.3, 0.4), (-0.9, 0.2), (-1.5, 0.6), (0.5, 1.0)):
        d = x - half_width * np.sin(angle)
        square = (d**2 + z**2) ** 2
        along, across, shear = (-2.0 / np.pi * load @ (part / square) for part in (d**3, d * z**2, d**2 * z))
        found = hertz_traction_stress([[x, 0.0, z]], half_width, peak, poisson, np.inf)[0]
        expected = [along, poisson * (along + across), across, 0.0, shear, 0.0]
        assert found == pytest.approx(expected, abs=1e-12)
    # Under an arc the stress is turned with the surface: there is a traction along it alone.
    radius, x = 20.0, 0.5
    depth = x**2 / (radius + np.sqrt(radius**2 - x**2))
    xx, _, zz, _, xz, _ = hertz_traction_stress([[x, 0.0, depth]], 1.0, 1.0, 0.3, radius)[0]
    s, c = x / radius, np.sqrt(1.0 - (x / radius) ** 2)
    arc = radius * np.arcsin(s)
    assert xx * s**2 - 2.0 * xz * s * c + zz * c**2 == pytest.approx(0.0, abs=1e-3)
    assert (zz - xx) * s * c + xz * (c**2 - s**2) == pytest.approx(-np.sqrt(1.0 - arc**2), abs=1e-3)


def test_a_known_traction_is_enforced():
    points = np.array([[0.5, 0.2, 0.0], [0.0, 0.3, 0.4]])
    stress = np.full((2, 6), 0.1)
    enforce_tractions(points, stress, 0.3, [1.0], np.inf, np.zeros(2), sliding=np.array([0.2, 0.0]))
    assert stress[0, [2, 4, 5]] == pytest.approx([0.0, -0.2, 0.0])
    assert stress[1] == pytest.approx([0.0, 0.0, 0.0, 0.1, 0.1, 0.0]), "in x = 0 shears along x alone"


def test_frictions_out_of_range_are_refused():
    case = steel_case(1e-3, 3.0, 1.0).to_json()
    for friction in (-0.1, 1.5, "much"):
        with pytest.raises(FemError, match="friction"):
            parse_request({"schema": 1, "case": {**case, "friction": friction}})


def test_without_lateral_strain_flush_bodies_are_in_plane_strain(tmp_path):
    """At W = 1e-5, where the roller is all but flat: the closed form of a Hertz traction, in the middle and at the end."""
    plain = steel_case(1e-5, 2.0, 1.0)
    material = dataclasses.replace(plain.roller, poisson=0.0)
    case = dataclasses.replace(plain, roller=material, block=material, friction=0.3)
    end = case.contact_half_length()
    ahead = [[x, y, z] for x in (0.0, 0.5, 1.4) for y in (0.0, end) for z in (0.4, 1.0)]
    curves = [(body, str(side), [[side * x, y, z] for x, y, z in ahead])
              for body in ("block", "roller") for side in (1, -1)]
    summary, rows, _ = solved(tmp_path, case, 3.0, curves, {"along-y": [[0.0, 0.0]]})
    assert summary["equilibrium_residual"] < 1e-8 and "sliding" in summary["boundary_conditions"]
    found = in_p0(case, rows, *STRESSES).reshape(2, 2, len(ahead), 6)
    for (front, back), sign in zip(found, (1.0, -1.0)):
        # What friction adds is what is not the mirror image.
        added = 0.5 * (front - back * [1, 1, 1, -1, -1, 1])
        expected = sign * 0.3 * hertz_traction_stress(ahead, 1.0, 1.0, 0.0, np.inf)
        assert np.abs(added - expected).max() < 5e-3
