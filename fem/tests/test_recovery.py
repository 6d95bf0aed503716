"""Recovery of stresses: what it reproduces, and the tractions put in afterwards."""

import itertools
import math

import numpy as np
import pytest

from edgeline_fem.recovery import StressField, around_the_arc, enforce_tractions, hertz_stress, invariants
from edgeline_fem.request import FemError


def box_field(stress_at):
    """A graded box of elements with values of ``stress_at(points)`` at the superconvergent points."""
    axes = [np.array([0.0, 0.2, 0.5, 1.0])] * 3
    points, corners = [], []
    for cell in itertools.product(range(3), repeat=3):
        low = np.array([axis[i] for axis, i in zip(axes, cell)])
        size = np.array([axis[i + 1] - axis[i] for axis, i in zip(axes, cell)])
        for collection, offset in ((points, 0.5 / math.sqrt(3.0)), (corners, 0.5)):
            signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
            collection.append(low + size * (0.5 + offset * signs))
    points = np.array(points)
    return StressField(points, stress_at(points.reshape(-1, 3)).reshape(-1, 8, 6), np.array(corners))


def quadratic(points):
    """A quadratic stress with the parities of the planes x = 0 and y = 0."""
    x, y, z = points.T
    even = 1.0 + x**2 - 0.5 * y**2 + 0.3 * z - z**2 + x**2 * y**2 * z
    return np.stack([even, 2.0 * even, z, x * y * z, x * z, y * (1.0 + z)], axis=1)


POINTS = [(0.0, 0.0, 0.0), (0.1, 0.7, 0.3), (1.0, 1.0, 1.0), (0.0, 1.0, 0.02), (0.2, 0.5, 0.5), (0.35, 0.0, 0.9)]


def test_patches_reproduce_quadratics_everywhere():
    field = box_field(quadratic)
    assert field.sample(POINTS) == pytest.approx(quadratic(np.array(POINTS)), abs=1e-10)


def test_elements_alone_reproduce_trilinear_fields():
    def trilinear(points):
        x, y, z = points.T
        return np.stack([1.0 + z, 2.0 - z, 3.0 * z, x * y, x * z, y], axis=1)

    field = box_field(trilinear)
    alone = np.ones(len(POINTS), dtype=bool)
    assert field.sample(POINTS, alone) == pytest.approx(trilinear(np.array(POINTS)), abs=1e-12)


def test_a_known_steep_part_is_reproduced_exactly():
    """A quadratic field and a Hertz field with its vertical tangent at x = 0.4, in elements 0.2 wide."""

    def steep(points):
        return hertz_stress(points, 0.4, 1.3, 0.3, np.inf)

    field = box_field(lambda points: quadratic(points) + steep(points))
    expected = quadratic(np.array(POINTS)) + steep(np.array(POINTS))
    assert field.sample(POINTS, known=[steep] * len(POINTS)) == pytest.approx(expected, abs=1e-10)
    assert np.abs(field.sample(POINTS) - expected).max() > 0.01


def test_hertz_stress_against_integrated_line_loads():
    """Johnson, Contact Mechanics, 1985, Eqs. 2.23: line loads p ds, integrated over the contact."""
    a, peak, poisson = 1.3, 0.9, 0.25
    angles = (np.arange(2000) + 0.5) * math.pi / 2000
    s, load = a * np.cos(angles), peak * np.sin(angles) * a * np.sin(angles) * math.pi / 2000
    points = np.array([[0.0, 0.0, 0.5], [0.7, 1.0, 0.3], [1.3, 0.0, 0.2], [-2.0, 0.0, 1.0]])
    found = hertz_stress(points, a, peak, poisson, np.inf)
    for (x, _, z), row in zip(points, found):
        r4 = ((x - s) ** 2 + z**2) ** 2
        xx, zz, xz = (-2.0 / math.pi * np.sum(load * part / r4)
                      for part in ((x - s) ** 2 * z, z**3, (x - s) * z**2))
        assert row == pytest.approx([xx, poisson * (xx + zz), zz, 0.0, xz, 0.0], abs=1e-6)
    # On the surface: the pressure both ways within the contact, nothing outside, no shear.
    surface = hertz_stress([[0.5, 0.0, 0.0], [a, 0.0, 0.0], [1.5, 0.0, 0.0]], a, peak, poisson, np.inf)
    pressure = peak * math.sqrt(1.0 - (0.5 / a) ** 2)
    assert surface[0, [0, 2, 4]] == pytest.approx([-pressure, -pressure, 0.0], abs=1e-12)
    assert surface[1:] == pytest.approx(np.zeros((2, 6)), abs=1e-12)


def test_hertz_stress_under_an_arc_is_turned_with_it():
    """On a roller's surface the traction is the pressure along the normal."""
    radius, x = 10.0, 0.6
    depth = radius - math.sqrt(radius**2 - x**2)
    xx, _, zz, _, xz, _ = hertz_stress([[x, 0.0, depth]], 1.0, 1.0, 0.3, radius)[0]
    sine, cosine = x / radius, math.sqrt(1.0 - (x / radius) ** 2)
    assert xx * sine - xz * cosine == pytest.approx(-0.8 * sine, abs=1e-7)
    assert xz * sine - zz * cosine == pytest.approx(0.8 * cosine, abs=1e-7)


def test_a_point_outside_is_named():
    with pytest.raises(FemError, match="outside the body"):
        box_field(quadratic).sample([(0.5, 0.5, 1.5)])


def test_invariants():
    von_mises, tau_max = invariants([[3.0, 1.0, 2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]])
    assert von_mises == pytest.approx([math.sqrt(3.0), math.sqrt(3.0)])
    assert tau_max == pytest.approx([1.0, 1.0])


def test_tractions_that_hold_are_left_alone_and_others_put_right():
    points = np.array([[0.3, 0.5, 0.0], [0.3, 1.0, 0.7], [0.3, 1.0, 0.0]])
    pressure = np.array([0.8, 0.0, 0.6])
    right = np.array([[-0.4, -0.3, -0.8, 0.02, 0.0, 0.0], [0.1, 0.0, -0.2, 0.0, 0.03, 0.0],
                      [-0.2, 0.0, -0.6, 0.0, 0.0, 0.0]])
    stress = right.copy()
    assert enforce_tractions(points, stress, 0.3, [1.0], np.inf, pressure) == pytest.approx((0.0, 0.0))
    assert stress == pytest.approx(right)
    stress[0, 2] -= 0.07
    stress[1, 1] += 0.05
    assert enforce_tractions(points, stress, 0.3, [1.0], np.inf, pressure) == pytest.approx((0.05, 0.07))
    assert stress[:, 2] == pytest.approx([-0.8, -0.2 - 0.05 * 0.3 / 0.7, -0.6])
    assert stress[0, 0] == pytest.approx(-0.4 + 0.07 * 0.3 / 0.7)
    assert stress[1:, 1] == pytest.approx([0.0, 0.0])


def test_tractions_on_the_arc_are_normal_to_it():
    """On a tilted surface sigma . n is the pressure along the normal, and nothing across."""
    points = np.array([[1.0, 0.5, 0.0]])
    stress = np.array([[-0.3, -0.2, -0.4, 0.05, 0.02, 0.01]])
    enforce_tractions(points, stress, 0.3, [5.0], 10.0, np.array([0.5]))
    xx, yy, zz, xy, xz, yz = stress[0]
    normal = np.array([0.1, 0.0, -math.sqrt(0.99)])  # outwards
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    assert tensor @ normal == pytest.approx(-0.5 * normal, abs=1e-12)


def test_narrow_elements_that_lean_are_boxes_around_the_arc():
    """Columns towards a disc's centre lean by several of their widths: their frame is the arc's.

    A field that is quadratic in that frame is reproduced in it, and not by boxes in x and z.
    """
    radius = 12.0
    along, down = np.linspace(0.0, 2.0, 41), np.array([0.0, 0.5, 1.2, 2.4, 4.6, 9.0])

    points, corners = [], []
    for i, j, k in itertools.product(range(len(along) - 1), range(2), range(len(down) - 1)):
        low, high = np.array([along[i], j, down[k]]), np.array([along[i + 1], j + 1.0, down[k + 1]])
        for collection, offset in ((points, 0.5 / math.sqrt(3.0)), (corners, 0.5)):
            t = np.array(list(itertools.product((-offset, offset), repeat=3)))
            arc, y, depth = (0.5 * (low + high) + t * (high - low)).T
            inner = radius - depth
            collection.append(
                np.stack([inner * np.sin(arc / radius), y, radius - inner * np.cos(arc / radius)], axis=1)
            )
    points, corners = np.array(points), np.array(corners)
    frame = around_the_arc(radius)

    def stress_at(p):
        return quadratic(frame(p))

    stress = stress_at(points.reshape(-1, 3)).reshape(-1, 8, 6)
    places = np.array([[0.7, 0.5, z] for z in (0.5, 1.0, 2.0, 3.0, 4.0)])
    found = StressField(points, stress, corners, frame).sample(places)
    assert found == pytest.approx(stress_at(places), abs=1e-8)
    assert np.abs(StressField(points, stress, corners).sample(places) - stress_at(places)).max() > 1e-3
