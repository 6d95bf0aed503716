"""20-node bricks: the gmsh grid without its middle nodes, for codes that have no element of 27 nodes.

Coordinates are those of one system of axes for both bodies, z into the block, in units of C. An element's nodes are in
the order of Abaqus, CalculiX and VTK: corners around the bottom, around the top, then the middles of the edges below,
above and between.
"""

import dataclasses
import functools

import numpy as np

from .meshing import read_msh
from .scene import surface_depth

# gmsh's numbers of an element's first 20 nodes in that order.
_FROM_GMSH = (0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)
# Bottom and top exchanged, which turns a left-handed element.
_UPSIDE_DOWN = (4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19)
# Corners and middle nodes of the faces S1 to S6, around each of them.
FACES = (
    (0, 1, 2, 3, 8, 9, 10, 11), (4, 5, 6, 7, 12, 13, 14, 15), (0, 1, 5, 4, 8, 17, 12, 16),
    (1, 2, 6, 5, 9, 18, 13, 17), (2, 3, 7, 6, 10, 19, 14, 18), (3, 0, 4, 7, 11, 16, 15, 19),
)
_NATURAL = np.array([
    (-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1),
    (0, -1, -1), (1, 0, -1), (0, 1, -1), (-1, 0, -1), (0, -1, 1), (1, 0, 1), (0, 1, 1), (-1, 0, 1),
    (-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0),
], dtype=float)
# The reduced integration's points, the first coordinate fastest, as CalculiX numbers them.
_GAUSS = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) / 3**0.5


def _shapes(natural, at):
    """Serendipity shape functions of nodes at ``natural`` (n, d) and their derivatives at ``at`` (d,): (n,), (n, d).

    A corner's is prod(1 + q) (sum q + 1 - d) / 2^d, that of an edge's middle (1 - t^2) prod(1 + q) / 2^(d - 1), with
    q = coordinate times the node's own, t along the edge.
    """
    dimension = len(at)
    values, slopes = np.empty(len(natural)), np.empty((len(natural), dimension))
    for number, own in enumerate(natural):
        q = own * at
        along = own == 0.0
        factors = np.where(along, 1.0 - at**2, 1.0 + q)
        bends = np.where(along, -2.0 * at, own)
        others = np.array([np.prod(np.delete(factors, k)) for k in range(dimension)])
        if along.any():
            values[number] = np.prod(factors) / 2 ** (dimension - 1)
            slopes[number] = bends * others / 2 ** (dimension - 1)
        else:
            rest = q.sum() + 1.0 - dimension
            values[number] = np.prod(factors) * rest / 2**dimension
            slopes[number] = (bends * others * rest + np.prod(factors) * own) / 2**dimension
    return values, slopes


@functools.lru_cache(maxsize=None)
def _at_gauss_points():
    values, slopes = zip(*(_shapes(_NATURAL, at) for at in _GAUSS))
    return np.array(values), np.array(slopes)


@dataclasses.dataclass(frozen=True)
class Bricks:
    """One body's mesh: ``points`` (n, 3), ``cells`` (m, 20), and rows of nodes by what holds them.

    ``sets``: ``symmetry_x``, ``symmetry_y``, ``support``; ``faces``: pairs of an element and a face 0 to 5 that make
    up the surface where contact is looked for.
    """

    points: np.ndarray
    cells: np.ndarray
    sets: dict
    faces: list

    @staticmethod
    def read(path, body, scene, support, contact):
        """The bricks of a ``body`` in the .msh file at ``path``.

        ``support``: depth of its support; ``contact``: x and y up to which contact is looked for.
        """
        points, cells, _ = read_msh(path)
        cells = cells[:, _FROM_GMSH]
        used, cells = np.unique(cells, return_inverse=True)
        points, cells = points[used], cells.reshape(-1, 20)
        x, y, depth = points.T
        near = 1e-7 * support
        sets = {
            "symmetry_x": np.flatnonzero(np.abs(x) < near),
            "symmetry_y": np.flatnonzero(np.abs(y) < near),
            "support": np.flatnonzero(np.abs(depth - support) < near),
        }
        surface = surface_depth(body, np.minimum(x, scene.radius), scene.radius)
        on = (np.abs(depth - surface) < 1e-6) & (x < contact[0] + 1e-6) & (y < contact[1] + 1e-6)
        if body == "roller":
            points = points * [1.0, 1.0, -1.0]
        first, second, third = (points[cells[:, k]] - points[cells[:, 0]] for k in (1, 3, 4))
        left = np.einsum("ij,ij->i", np.cross(first, second), third) < 0.0
        cells[left] = cells[left][:, _UPSIDE_DOWN]
        faces = [
            (int(cell), face)
            for face, nodes in enumerate(FACES)
            for cell in np.flatnonzero(on[cells[:, nodes[:4]]].all(axis=1))
        ]
        return Bricks(points, cells, sets, faces)

    @functools.cached_property
    def surface(self):
        """The :class:`Surface` where contact is looked for."""
        return Surface(self)

    def gauss_points(self):
        """The elements' 2 x 2 x 2 integration points, (m, 8, 3)."""
        return np.einsum("gn,enk->egk", _at_gauss_points()[0], self.points[self.cells])

    def nodal_forces(self, stress):
        """Forces (n, 3) on the nodes that balance the ``stress`` (m, 8, 6) at the integration points."""
        corners = self.points[self.cells]
        jacobian = np.einsum("gna,enk->egak", _at_gauss_points()[1], corners)
        gradients = np.einsum("egka,gna->egnk", np.linalg.inv(jacobian), _at_gauss_points()[1])
        rows = [np.stack([stress[..., k] for k in row], -1) for row in ((0, 3, 4), (3, 1, 5), (4, 5, 2))]
        parts = np.einsum("eg,egnk,egkl->enl", np.linalg.det(jacobian), gradients, np.stack(rows, -2))
        forces = np.zeros_like(self.points)
        np.add.at(forces, self.cells, parts)
        return forces



class Surface:
    """The contact surface of bricks: rectangles with 8 nodes in x and y.

    ``rows``: its nodes among those of the body. Forces on them, or pressures at them, are given in that order.
    """

    def __init__(self, bricks):
        self._quads = np.array([bricks.cells[cell][list(FACES[face])] for cell, face in bricks.faces])
        self.rows, local = np.unique(self._quads, return_inverse=True)
        self._local = local.reshape(self._quads.shape)
        self.places = bricks.points[self.rows][:, :2]
        corners = bricks.points[self._quads[:, :4]][:, :, :2]
        self._low, self._high = corners.min(axis=1), corners.max(axis=1)
        # Where each node stands in its rectangle, whichever way the face is numbered.
        middle, half = 0.5 * (self._low + self._high), 0.5 * (self._high - self._low)
        places = bricks.points[self._quads][:, :, :2]
        self._natural = np.round((places - middle[:, None]) / half[:, None])

    def _rectangles(self, points, weights):
        """Shape functions at natural ``points`` of every rectangle: (number, values (k, 8), areas (k,))."""
        for number, natural in enumerate(self._natural):
            values = np.array([_shapes(natural, at)[0] for at in points])
            area = np.prod(self._high[number] - self._low[number])
            yield number, values, 0.25 * area * weights

    def pressure(self, forces, grid):
        """Pressure at the ``grid``'s Gauss points, (len(gauss_x), len(gauss_y)), whose consistent forces are ``forces``.

        The pressure is one of the elements' own functions, and its forces are theirs: the consistent mass matrix is
        solved for its nodal values.
        """
        at, weight = np.polynomial.legendre.leggauss(3)
        points = np.array([(a, b) for a in at for b in at])
        weights = np.outer(weight, weight).ravel()
        mass = np.zeros((len(self.rows), len(self.rows)))
        for number, values, areas in self._rectangles(points, weights):
            nodes = self._local[number]
            mass[np.ix_(nodes, nodes)] += (values * areas[:, None]).T @ values
        nodal = np.linalg.solve(mass, forces)
        pressure = np.zeros((len(grid.gauss_x), len(grid.gauss_y)))
        for number, rows, columns, values in self._at_grid(grid):
            pressure[rows, columns] = values @ nodal[self._local[number]]
        return pressure

    def forces(self, pressure, grid):
        """Consistent forces of a ``pressure`` that is known at the ``grid``'s Gauss points, where it integrates them."""
        forces = np.zeros(len(self.rows))
        for number, rows, columns, values in self._at_grid(grid):
            area = 0.25 * np.prod(self._high[number] - self._low[number])
            np.add.at(forces, self._local[number], area * (values.T @ pressure[rows, columns]))
        return forces

    def _at_grid(self, grid):
        """For every rectangle: its number, the grid's Gauss points in it by row and column, shape functions there."""
        for number, natural in enumerate(self._natural):
            low, high = self._low[number], self._high[number]
            rows = np.flatnonzero((grid.gauss_x > low[0]) & (grid.gauss_x < high[0]))
            columns = np.flatnonzero((grid.gauss_y > low[1]) & (grid.gauss_y < high[1]))
            rows, columns = np.repeat(rows, len(columns)), np.tile(columns, len(rows))
            places = np.column_stack([grid.gauss_x[rows], grid.gauss_y[columns]])
            at = 2.0 * (places - low) / (high - low) - 1.0
            yield number, rows, columns, np.array([_shapes(natural, place)[0] for place in at])
