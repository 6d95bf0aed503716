"""One body: constant stress, and a pressed rectangle against Boussinesq and Love."""

import math

import numpy as np
import pytest
from mpi4py import MPI

from edgeline_fem.contact import ContactGrid
from edgeline_fem.elasticity import Body, load_mesh
from edgeline_fem.meshing import Section, box_geo, graded_axis, run_gmsh
from edgeline_fem.request import FemError

POISSON = 0.3
YOUNG = 1.0 - POISSON**2  # so that E / (1 - nu^2) is 1


def plane(axis, value, scale=1.0):
    return lambda x: np.abs(x[axis] - value) < 1e-9 * scale


def mesh_of(text, folder, name):
    geo, msh = folder / f"{name}.geo", folder / f"{name}.msh"
    geo.write_text(text)
    run_gmsh("gmsh", geo, msh, False)
    return load_mesh(MPI.COMM_SELF, msh)


def press(body, grid, forces):
    """Load the body's nodes at z = 0 that ``grid`` has; returns displacement and support force."""
    body.number_contact_nodes(
        len(grid), lambda n: np.where(np.abs(n[:, 2]) < 1e-9, grid.find(n), -1)
    )
    displacement = body.press(forces)
    return displacement, body.keep()


@pytest.mark.parametrize("linear", ["direct", "iterative"])
def test_patch(tmp_path, linear):
    """Skewed elements under uniform pressure hold a constant stress, to rounding."""
    x, y, z = np.array([0.0, 0.4, 0.7, 1.5]), np.array([0.0, 0.3, 1.0]), np.array([0.0, 0.2, 1.0])
    section = Section()
    section.chain("left-top", [(v, 0.0) for v in x[:2]])
    section.chain("right-top", [(v, 0.0) for v in x[1:]])
    section.chain("left", [(0.0, v) for v in z])
    section.chain("slant", [(0.4, 0.0), (0.55, 0.3), (0.75, 1.0)])
    section.chain("right", [(1.5, v) for v in z])
    section.chain("left-bottom", [(0.0, 1.0), (0.75, 1.0)])
    section.chain("right-bottom", [(0.75, 1.0), (1.0, 1.0), (1.5, 1.0)])
    section.patch("left-top", "slant", "-left-bottom", "-left")
    section.patch("right-top", "right", "-right-bottom", "-slant")
    domain = mesh_of(section.geo("patch", y, {}), tmp_path, "patch")
    fixed = [(0, plane(0, 0.0)), (1, plane(1, 0.0)), (2, plane(2, 1.0))]
    body = Body(domain, YOUNG, POISSON, fixed, linear, 1e-13)
    grid = ContactGrid(x, y)
    displacement, support = press(body, grid, 0.01 * grid.weights)
    assert support == pytest.approx(0.01 * 1.5, rel=1e-10)
    assert displacement == pytest.approx(np.full(len(grid), 0.01 / YOUNG), rel=1e-9)
    field = body.stress_field()
    expected = np.array([0.0, 0.0, -0.01, 0.0, 0.0, 0.0])
    inside = [(0.1, 0.2, 0.3), (0.6, 0.9, 0.5), (1.5, 1.0, 0.0), (1.2, 0.0, 1.0)]
    for singular in (None, np.ones(len(inside), dtype=bool)):
        assert np.abs(field.sample(inside, singular) - expected).max() < 1e-12


def rectangle_stress(point, a, b, poisson, order=80):
    """Stress at ``point`` (z > 0) under unit pressure on |x| <= ``a``, |y| <= ``b`` of a half-space.

    Boussinesq's point load in polar form (Johnson, Contact Mechanics, 1985, Eq. 3.19), integrated by
    Gauss points.
    """
    nodes, weights = np.polynomial.legendre.leggauss(order)
    u, v = point[0] - a * nodes[:, None], point[1] - b * nodes[None, :]
    z, r2 = point[2], u**2 + v**2
    rho = np.sqrt(r2 + z**2)
    k = 1.0 - 2.0 * poisson
    radial = k / (rho * (rho + z)) - 3.0 * z * r2 / rho**5
    hoop = -k * (1.0 / (rho * (rho + z)) - z / rho**3)
    # (sigma_r - sigma_theta) / r^2 has no limit at r = 0, but Gauss points never fall there here.
    turn = (radial - hoop) / r2
    parts = (hoop + turn * u**2, hoop + turn * v**2, -3.0 * z**3 / rho**5, turn * u * v,
             -3.0 * u * z**2 / rho**5, -3.0 * v * z**2 / rho**5)
    share = a * b * np.outer(weights, weights) / (2.0 * math.pi)
    return np.array([np.sum(share * part) for part in parts])


def test_the_closed_form_itself():
    known = [-0.03110431, -0.10227433, -0.06029421, -0.01521147, -0.01619224, -0.08653329]
    assert rectangle_stress((0.3, 0.9, 0.5), 0.7, 0.4, 0.3) == pytest.approx(known, abs=1e-8)


def test_pressed_rectangle_against_boussinesq(tmp_path):
    """A large block under unit pressure on a rectangle is a half-space to half a percent."""
    a, b, extent = 1.0, 0.8, 400.0

    def axis(edge):
        inner = graded_axis(0.0, edge, lambda s: min(0.3, 0.12 + 0.4 * abs(s - edge)))
        return np.concatenate((inner, graded_axis(edge, extent, lambda s: 0.12 + 0.8 * (s - edge))[1:]))

    x, y = axis(a), axis(b)
    z = graded_axis(0.0, extent, lambda s: 0.12 + 0.5 * s)
    domain = mesh_of(box_geo("block", x, y, z, 1), tmp_path, "block")
    fixed = [(0, plane(0, 0.0)), (1, plane(1, 0.0)), (2, plane(2, extent, extent))]
    body = Body(domain, YOUNG, POISSON, fixed)
    grid = ContactGrid(x[x <= a], y[y <= b])
    displacement, support = press(body, grid, grid.weights)
    assert support == pytest.approx(a * b, rel=1e-8)

    # Love's deflection of the rectangle's centre, E* = 1, less what the block's finite depth takes away.
    centre = 4.0 / math.pi * (a * math.asinh(b / a) + b * math.asinh(a / b))
    assert displacement[0] == pytest.approx(centre, abs=6.0 * a * b / extent)
    points = [(0.0, 0.0, 0.3), (0.0, 0.0, 0.8), (0.0, 0.0, 2.0), (0.5, 0.4, 0.5), (1.0, 0.8, 0.4),
              (0.0, 0.8, 0.6), (1.3, 0.2, 0.7), (1.5, 1.2, 1.0)]
    expected = np.array([rectangle_stress(p, a, b, POISSON) for p in points])
    assert np.abs(body.stress_field().sample(points) - expected).max() < 6e-3


def test_a_wrong_solve_is_refused(tmp_path):
    """An answer that does not balance its load ends the run, whoever computed it."""
    axis = np.array([0.0, 0.5, 1.0])
    domain = mesh_of(box_geo("block", axis, axis, axis, 1), tmp_path, "block")
    body = Body(domain, YOUNG, POISSON, [(0, plane(0, 0.0)), (1, plane(1, 0.0)), (2, plane(2, 1.0, 1.0))])
    grid = ContactGrid(axis, axis)
    press(body, grid, grid.weights)
    solver = body._solver

    class Careless:
        def solve(self, load, answer):
            solver.solve(load, answer)
            answer.array[np.argmax(np.abs(answer.array))] *= 1.01

        def __getattr__(self, name):
            return getattr(solver, name)

    body._solver = Careless()
    with pytest.raises(FemError, match="without balance"):
        body.press(grid.weights.ravel())
