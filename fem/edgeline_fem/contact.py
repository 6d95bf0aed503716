"""Frictionless contact of two bodies on matching nodes, with exact non-penetration and exact load."""

import dataclasses

import numpy as np

from .request import FemError


def with_middles(corners):
    """Nodes of quadratic elements between ascending ``corners``: the corners and the middles."""
    nodes = np.empty(2 * len(corners) - 1)
    nodes[::2] = corners
    nodes[1::2] = 0.5 * (nodes[:-2:2] + nodes[2::2])
    return nodes


def _line_mass(nodes):
    """Consistent mass matrix of quadratic line elements with end and middle ``nodes``."""
    element = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) / 30.0
    mass = np.zeros((len(nodes), len(nodes)))
    for first in range(0, len(nodes) - 1, 2):
        part = slice(first, first + 3)
        mass[part, part] += element * (nodes[first + 2] - nodes[first])
    return mass


def _interpolation(nodes, at):
    """Matrix of quadratic interpolation from ``nodes`` to the points ``at`` (within their range)."""
    at = np.asarray(at, dtype=float)
    first = np.clip(np.searchsorted(nodes[::2], at, side="right") - 1, 0, len(nodes) // 2 - 1) * 2
    t = (at - nodes[first]) / (nodes[first + 2] - nodes[first])
    matrix = np.zeros((len(at), len(nodes)))
    rows = np.arange(len(at))
    matrix[rows, first] = (1.0 - t) * (1.0 - 2.0 * t)
    matrix[rows, first + 1] = 4.0 * t * (1.0 - t)
    matrix[rows, first + 2] = t * (2.0 * t - 1.0)
    return matrix


class ContactGrid:
    """The tensor grid of nodes where contact may happen: the element boundaries ``x`` times ``y``.

    Nodes are numbered with y running fastest. ``weights`` are the nodes' shares of the area, lumped from
    the consistent mass matrix; all are positive, which is what bounds on nodal forces need.
    """

    def __init__(self, x, y):
        self.x, self.y = with_middles(np.asarray(x)), with_middles(np.asarray(y))
        self._mass_x, self._mass_y = _line_mass(self.x), _line_mass(self.y)
        self.shape = (len(self.x), len(self.y))
        self.weights = np.outer(self._mass_x.sum(axis=0), self._mass_y.sum(axis=0)).ravel()

    def __len__(self):
        return self.shape[0] * self.shape[1]

    def find(self, nodes):
        """Numbers of ``nodes`` (n, 2 or more: x, y) of a contact surface in the grid, -1 outside it."""

        def nearest(axis, values):
            at = np.clip(np.searchsorted(axis, values), 1, len(axis) - 1)
            at -= values - axis[at - 1] < axis[at] - values
            # Middle nodes on an arc stand beside the chord's middle by a part in 1e5 of the element.
            return at, np.abs(axis[at] - values) < 1e-2 * np.diff(axis).min()

        i, on_x = nearest(self.x, nodes[:, 0])
        j, on_y = nearest(self.y, nodes[:, 1])
        return np.where(on_x & on_y, i * self.shape[1] + j, -1)

    def lumped_pressure(self, forces):
        """Pressure whose lumped nodal forces are ``forces``."""
        return forces / self.weights

    def pressure(self, forces):
        """Pressure from nodal ``forces``: lumped, and one Richardson step towards the consistent one.

        Lumping is off by h^2 p'' / 20 with alternating signs; the consistent mass matrix's inverse would
        be exact for a smooth pressure but rings at the edge of contact. One step removes the first and
        does not do the second.
        """
        lumped = self.lumped_pressure(forces)
        back = self._mass_x @ lumped.reshape(self.shape) @ self._mass_y
        return lumped + (forces - back.ravel()) / self.weights

    def sample(self, values, points):
        """Nodal ``values`` interpolated to ``points`` (n, 2); 0 outside the grid in x or beyond its end."""
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        limit = np.array([self.x[-1], self.y[-1]])
        inside = np.all(points <= limit * (1.0 + 1e-12), axis=1)
        clipped = np.minimum(points, limit)
        along = _interpolation(self.x, clipped[:, 0]) @ values.reshape(self.shape)
        found = np.sum(along * _interpolation(self.y, clipped[:, 1]), axis=1)
        return np.where(inside, found, 0.0)


@dataclasses.dataclass(frozen=True)
class ContactSolution:
    """Nodal ``forces`` of the contact, the ``approach`` (multiplier of the load) and how well they hold.

    ``residual``: root mean square of the gap left in contact; ``smallest_gap``: the most negative gap
    anywhere (both relative to the gap scale ``C^2 / 2R``); ``iterations`` of the outer loop and
    ``applications`` of the compliance.
    """

    forces: np.ndarray
    approach: float
    residual: float
    smallest_gap: float
    iterations: int
    applications: int


def solve_contact(compliance, gap, weights, load, start, scale, tolerance, max_iterations, progress):
    """Minimise f' S f / 2 + gap' f over nodal forces f >= 0 with sum(f) = ``load``.

    Conjugate gradients on the pressures f / weights, restarted when the set of nodes in contact changes
    (after Polonsky and Keer, Wear 231 (1999) 206-219). Directions keep the load, so that it holds without
    rescaling, and the multiplier of the load is the approach of the bodies.

    ``compliance(f)``: S f, the sum of both bodies' displacements; ``gap`` >= 0 at rest; ``start``:
    pressures to begin with; ``scale``: a gap to measure residuals with; ``progress(iteration, residual)``
    is told of each iteration. Raises :class:`FemError` if ``tolerance`` is not met.
    """
    applications = 0

    def deflection(pressure):
        nonlocal applications
        applications += 1
        return compliance(weights * pressure)

    pressure = start * load / np.sum(weights * start)
    opening = deflection(pressure) + gap
    direction, old_norm = np.zeros_like(gap), 0.0
    for iteration in range(1, max_iterations + 1):
        touching = pressure > 0.0
        area = weights[touching]
        approach = np.sum(area * opening[touching]) / np.sum(area)
        left = opening - approach
        norm = np.sum(area * left[touching] ** 2)
        residual = np.sqrt(norm / np.sum(area)) / scale
        smallest = left.min() / scale
        progress(iteration, residual)
        if residual <= tolerance and smallest >= -10.0 * tolerance:
            return ContactSolution(
                weights * pressure, approach, residual, smallest, iteration, applications
            )
        step_back = norm / old_norm if old_norm > 0.0 else 0.0
        direction = np.where(touching, left + step_back * direction, 0.0)
        # Rounding apart this is zero already; it is what keeps the load.
        direction[touching] -= np.sum(area * direction[touching]) / np.sum(area)
        change = deflection(direction)
        curvature = np.sum(area * direction[touching] * change[touching])
        step = np.sum(area * left[touching] * direction[touching]) / curvature
        moved = pressure - step * direction
        leaving = touching & (moved < 0.0)
        entering = ~touching & (left < 0.0)
        old_norm = norm
        if not leaving.any() and not entering.any():
            pressure, opening = moved, opening - step * change
            continue
        moved[leaving] = 0.0
        moved[entering] -= step * left[entering]
        if entering.any():
            old_norm = 0.0
        pressure = moved * load / np.sum(weights * moved)
        opening = deflection(pressure) + gap
    raise FemError(
        f"contact did not converge in {max_iterations} iterations: residual {residual:.2e}, smallest gap "
        f"{smallest:.2e} (both relative to C^2/2R), tolerance {tolerance:.1e}"
    )
