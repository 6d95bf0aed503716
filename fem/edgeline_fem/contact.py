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


def interpolation(nodes, at):
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


def _gauss_points(nodes):
    """The two Gauss points of every quadratic element between ``nodes``, ascending."""
    corners = nodes[::2]
    middles, halves = 0.5 * (corners[1:] + corners[:-1]), 0.5 * np.diff(corners)
    return (middles[:, None] + halves[:, None] * np.array([-1.0, 1.0]) / 3**0.5).ravel()


def _mirrored(values):
    """``values`` of an even function at Gauss points, preceded by the images of the first two."""
    return np.concatenate([values[1::-1], values])


def _mirrored_places(points):
    """Gauss ``points``, preceded by the images of the first two."""
    return np.concatenate([-points[1::-1], points])


def _through_nearest(points, at):
    """Weights of cubic interpolation to ``at`` of a function known at ascending Gauss ``points``.

    They are those of the four nearest, or of the last four beyond an end.
    """
    first = int(np.clip(np.searchsorted(points, at) - 2, 0, len(points) - 4))
    near = points[first : first + 4]
    weights = np.zeros(len(points))
    for i in range(4):
        others = np.delete(near, i)
        weights[first + i] = np.prod((at - others) / (near[i] - others))
    return weights


# The square of a pressure (p0) that is none.
_NO_CONTACT = 1e-6


class ContactGrid:
    """The tensor grid of nodes where contact may happen: the element boundaries ``x`` times ``y``.

    x = 0 is a plane of symmetry, and with ``even`` so is y = 0, where the grid then begins. Nodes are numbered
    with y running fastest. ``weights`` are the nodes' shares of the area and ``lengths`` those of the length along
    y, lumped from the consistent mass matrix; all are positive, as bounds on nodal forces require.

    Pressures are handled at the elements' 2 x 2 Gauss points, ``gauss_x`` times ``gauss_y``. Where no pair of
    nodes may penetrate, corner nodes carry a little too much and middle ones too little (0.1 to 0.2 % of p0 on
    the meshes in use); to second degree that vanishes at the Gauss points, where the stress is best as well.
    """

    def __init__(self, x, y, even=True):
        self.even = even
        self.x, self.y = with_middles(np.asarray(x)), with_middles(np.asarray(y))
        self.gauss_x, self.gauss_y = _gauss_points(self.x), _gauss_points(self.y)
        self._mass_x, self._mass_y = _line_mass(self.x), _line_mass(self.y)
        self.shape = (len(self.x), len(self.y))
        self.lengths = self._mass_y.sum(axis=0)
        self.weights = np.outer(self._mass_x.sum(axis=0), self.lengths).ravel()

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

    def _at_gauss_points(self, nodal):
        across, along = interpolation(self.x, self.gauss_x), interpolation(self.y, self.gauss_y)
        return across @ nodal @ along.T

    def lumped_pressure(self, forces):
        """Pressure whose lumped nodal forces are ``forces`` (n,), at the Gauss points."""
        return self._at_gauss_points((forces / self.weights).reshape(self.shape))

    def pressure(self, forces):
        """Pressure at the Gauss points, (len(gauss_x), len(gauss_y)), from nodal ``forces`` (n,).

        Lumping is off by h^2 p'' / 20 with alternating signs. Across the contact the consistent mass matrix
        is inverted; in the element that the contact's edge cuts that overshoots, but :meth:`sample` does not
        look there. Along y one Richardson step from the lumped to the consistent matrix takes most of the
        error away; the inverse would carry the overshoot at a longer block's corner far along the line.
        """
        across = np.linalg.solve(self._mass_x, forces.reshape(self.shape))
        lumped = across / self.lengths
        return self._at_gauss_points(lumped + (across - lumped @ self._mass_y) / self.lengths)

    def _profile(self, pressure, y):
        """The square of the pressure across the contact at ``y``, and how it goes on to the contact's edge.

        Returns ``(square, sound, edge, slope)``: values at ``gauss_x``; the largest x that does not see the
        edge; the x at which the square falls to 0, and its slope with x^2 on the way there. The last two are
        ``None`` where too few elements lie within the contact to tell.
        """
        y = min(max(y, self.y[0]), self.y[-1])
        if self.even:
            line = _mirrored(pressure.T).T @ _through_nearest(_mirrored_places(self.gauss_y), y)
        else:
            line = pressure @ _through_nearest(self.gauss_y, y)
        square = np.maximum(line, 0.0) ** 2
        if square.max() < _NO_CONTACT:
            return 0.0 * square, self.x[-1], None, None
        cut = np.flatnonzero(line > 0.02 * line.max())[-1] // 2
        fit = slice(0, 2 * (cut - 1))
        if cut < 3:
            return square, self.x[-1], None, None
        # A Hertz pressure's square is linear in x^2; many points average what the edge does to the last.
        slope, level = np.polyfit(self.gauss_x[fit] ** 2, square[fit], 1)
        sound = self.gauss_x[fit][-1]
        if slope >= 0.0 or -level / slope <= sound**2:
            return square, self.x[-1], None, None
        return square, sound, np.sqrt(-level / slope), slope

    def hertz_at(self, pressure, y):
        """Half-width and peak (floats) of the Hertz pressure that falls to 0 at ``y`` as ``pressure`` does.

        Where the contact is too coarse to tell, the half-width is that of the points with pressure and the
        peak the pressure at x = 0. ``None`` where the bodies do not touch.
        """
        square, _, edge, slope = self._profile(pressure, y)
        if not square.any():
            return None
        if edge is None:
            touching = np.flatnonzero(square > 4e-4 * square.max())
            return self.gauss_x[touching[-1]], np.sqrt(square[0])
        return edge, edge * np.sqrt(-slope)

    def sample(self, pressure, points):
        """``pressure`` interpolated to ``points`` (n, 2); 0 outside the contact, never negative.

        Across the contact the square of the pressure is interpolated: it is smooth up to the contact's
        edge, where the pressure falls like a square root. The element that the edge cuts and the one before
        it see the cut; there the square goes on as a Hertz pressure's does, a straight line in x^2.
        """
        found = np.zeros(len(points))
        slack = 1e-9 * np.array([self.x[-1], np.ptp(self.y)])
        for number, (x, y) in enumerate(points):
            if x > self.x[-1] + slack[0] or not self.y[0] - slack[1] <= y <= self.y[-1] + slack[1]:
                continue
            square, sound, edge, slope = self._profile(pressure, y)
            if x <= sound:
                value = _through_nearest(_mirrored_places(self.gauss_x), x) @ _mirrored(square)
            else:
                value = slope * (x**2 - edge**2)
            found[number] = np.sqrt(max(value, 0.0))
        return found


def _cells(nodes):
    """Boundaries of the cells around quadratic ``nodes`` whose widths are the lumped weights."""
    sixth = np.diff(nodes[::2]) / 6.0
    inner = np.stack([nodes[:-2:2] + sixth, nodes[2::2] - sixth], axis=1).ravel()
    return np.concatenate(([nodes[0]], inner, [nodes[-1]]))


def half_space_compliance(grid, bodies, ends):
    """A dense approximation of the contact compliance: displacement per nodal force, (n, n), symmetric.

    Forces are spread, and displacements averaged, over the cells around the nodes. Both bodies are taken
    as half-spaces with the grid's planes of symmetry. ``bodies``: (1 - nu^2) / E of them all; ``ends``: pairs of the
    place of an end of the grid and the sum of (1 - nu^2) / E over the bodies that end there. Those are mirrored
    in their end face, whose lack of support is made up for by the factor that Guilbault's correction has
    for nu = 0.3. It only speeds up :func:`solve_contact` and has no part in its result.
    """

    def potential(u, v):
        # d^4 / du^2 dv^2 of this is 1 / r. The tiny shift stands for the limits at u = 0 and v = 0.
        u, v = np.abs(u) + 1e-300, np.abs(v) + 1e-300
        straight = 0.5 * u * v * (u * np.arcsinh(v / u) + v * np.arcsinh(u / v))
        return straight - np.hypot(u, v) ** 3 / 6.0

    x, y = _cells(grid.x), _cells(grid.y)

    def influence(sign_x, sign_y, shift_y):
        """Integrals of 1 / r over all cells and all images of cells: (x, y, image x, image y)."""
        u = x[:, None] - sign_x * x[None, :]
        v = y[:, None] - sign_y * y[None, :] - shift_y
        whole = potential(u[:, None, :, None], v[None, :, None, :])
        for axis in range(4):
            whole = np.diff(whole, axis=axis)
        # Each reflection reverses a cell's boundaries.
        return sign_x * sign_y * whole

    signs_y = (1, -1) if grid.even else (1,)
    whole = bodies * sum(influence(sx, sy, 0.0) for sx in (1, -1) for sy in signs_y)
    for place, free in ends:
        # The image of y in the face is 2 place - y; with y = 0 a plane of symmetry, that of -y counts as well.
        mirrored = sum(influence(sx, -sy, 2.0 * place) for sx in (1, -1) for sy in signs_y)
        whole = whole + 1.39 * free * mirrored
    return whole.reshape(len(grid), len(grid)) / (np.pi * np.outer(grid.weights, grid.weights))


@dataclasses.dataclass(frozen=True)
class ContactSolution:
    """Nodal ``forces`` of the contact, the ``multipliers`` of its constraints and how well they hold.

    The first multiplier, that of the load, is the approach; the second, if the moment is prescribed, the tilt.
    ``residual``: root mean square of the gap left in contact; ``smallest_gap``: the most negative gap
    anywhere (both relative to the gap scale ``C^2 / 2R``); ``iterations`` of the outer loop and
    ``applications`` of the compliance.
    """

    forces: np.ndarray
    multipliers: np.ndarray
    residual: float
    smallest_gap: float
    iterations: int
    applications: int

    @property
    def approach(self):
        """The approach of the bodies (units of C)."""
        return float(self.multipliers[0])


def _balanced(forces, constraints, wanted):
    """``forces`` >= 0, scaled over y so that ``constraints @ forces`` is ``wanted``.

    The factor is linear in the constraints' rows; nodes that it would make pull are left out.
    """
    for _ in range(100):
        factor = np.linalg.solve((constraints * forces) @ constraints.T, wanted) @ constraints
        forces = forces * factor
        if forces.min() >= 0.0:
            return forces
        forces = np.maximum(forces, 0.0)
    raise FemError("no pressing forces carry the load and its moment: reduce eccentricity_m")


def solve_contact(
    compliance, gap, weights, constraints, wanted, model, scale, tolerance, max_iterations, progress
):
    """Minimise f' S f / 2 + gap' f over nodal forces f >= 0 with ``constraints @ f = wanted``.

    Preconditioned conjugate gradients on the nodes in contact, restarted when that set changes. Directions
    keep the constraints, so that they hold without rescaling; their multipliers are the approach of the bodies
    and, if the moment is prescribed, their tilt. Nodes leave the set where their force would be tensile,
    and join it where the gap is negative, once the residual within the set is small enough.

    ``compliance(f)``: S f, the sum of both bodies' displacements, the only costly operation; ``gap``: at
    rest; ``weights``: areas of the nodes; ``constraints`` (m, n), the first row ones, and ``wanted`` (m,): the
    load and its moment; ``model``: a symmetric matrix (n, n) like S, which makes the first guess and the
    preconditioner; ``scale``: a gap to measure residuals with; ``progress(iteration, residual)`` is told of each
    iteration. Raises :class:`FemError` if ``tolerance`` is not met.
    """
    if compliance is None:
        start = np.where(gap <= np.quantile(gap, 0.5), weights, 0.0)
        forces = _balanced(start, constraints, wanted)

        def compliance(values):
            return model @ values
    else:
        forces = solve_contact(
            None, gap, weights, constraints, wanted, model, scale, max(1e-6, tolerance), 1000, lambda i, r: None
        ).forces
    applications = 0

    def deflection(values):
        nonlocal applications
        applications += 1
        return compliance(values)

    opening = deflection(forces) + gap
    touching = forces > 0.0
    inverse = None
    for iteration in range(1, max_iterations + 1):
        area, rows = weights[touching], constraints[:, touching]
        # The rigid motion that fits the opening best; it is the multipliers once nothing is left.
        multipliers = np.linalg.solve((rows * area) @ rows.T, rows @ (area * opening[touching]))
        left = opening - multipliers @ constraints
        residual = np.sqrt(np.sum(area * left[touching] ** 2) / np.sum(area)) / scale
        smallest = left.min() / scale
        progress(iteration, residual)
        if residual <= tolerance and smallest >= -10.0 * tolerance:
            return ContactSolution(forces, multipliers, residual, smallest, iteration, applications)
        entering = ~touching & (left < -2.0 * scale * residual)
        if entering.any():
            touching = touching | entering
            inverse = None
            rows = constraints[:, touching]
        if inverse is None:
            inverse = np.linalg.inv(model[np.ix_(touching, touching)])
            # Removes the part of a direction that changes what is constrained.
            lift = np.linalg.solve(rows @ inverse @ rows.T, rows @ inverse)
            direction, old = np.zeros(rows.shape[1]), 0.0
        rest = left[touching]
        descent = inverse @ rest
        descent -= (rows @ descent) @ lift
        new = rest @ descent
        direction = descent + (new / old if old > 0.0 else 0.0) * direction
        old = new
        step_of = np.zeros_like(gap)
        step_of[touching] = direction
        change = deflection(step_of)
        step = (rest @ direction) / (change[touching] @ direction)
        moved = forces - step * step_of
        leaving = touching & (moved < 0.0)
        if not leaving.any():
            forces, opening = moved, opening - step * change
            continue
        moved[leaving] = 0.0
        touching = touching & ~leaving
        inverse = None
        forces = _balanced(moved, constraints, wanted)
        touching = touching & (forces > 0.0)
        opening = deflection(forces) + gap
    raise FemError(
        f"contact did not converge in {max_iterations} iterations: residual {residual:.2e}, smallest gap "
        f"{smallest:.2e} (both relative to C^2/2R), tolerance {tolerance:.1e}"
    )
