"""Stresses at points: superconvergent patch recovery, and known tractions put in.

The stress of a quadratic hexahedron is a full order more accurate at its 2 x 2 x 2 Gauss points than
anywhere else. Around every inner vertex of the mesh a triquadratic polynomial is fitted to those values in
the elements that share the vertex (Zienkiewicz and Zhu, Int. J. Numer. Meth. Engng. 33 (1992) 1331-1364);
between vertices the fits are blended linearly. Planes of symmetry are crossed with mirror images. A
polynomial over several elements smears a singularity, so next to one the elements are asked one by one.
"""

import itertools

import numpy as np

from .request import FemError

_POWERS = np.array(list(itertools.product(range(3), repeat=3)))
# What is left of a fit's weight where the point lies on the rim of the patch: decides nothing where another
# patch has the point inside, and takes over on the body's faces, where none has.
_RIM = 1e-9
_LINEAR = np.array(list(itertools.product(range(2), repeat=3)))


def _linear_terms(t):
    """Trilinear monomials of local coordinates (n, 3), as (n, 8)."""
    return np.prod(t[:, None, :] ** _LINEAR[None, :, :], axis=2)


def _terms(t):
    """Triquadratic monomials of local coordinates (n, 3), as (n, 27)."""
    powers = np.stack([np.ones_like(t), t, t * t], axis=-1)
    return np.prod([powers[:, axis, _POWERS[:, axis]] for axis in range(3)], axis=0)


def _mirror(axis, flipped, points, stress, corners):
    """Elements joined by the images in the plane ``axis`` = 0 of those that touch it."""
    touching = np.abs(corners[:, :, axis]).min(axis=1) < 1e-9
    sign = np.ones(3)
    sign[axis] = -1.0
    parity = np.ones(6)
    parity[list(flipped)] = -1.0
    return (
        np.concatenate([points, points[touching] * sign]),
        np.concatenate([stress, stress[touching] * parity]),
        np.concatenate([corners, corners[touching] * sign]),
    )


class StressField:
    """Stress anywhere in a body, from its values at the elements' superconvergent points.

    ``points`` (m, 8, 3) and ``stress`` (m, 8, 6: xx, yy, zz, xy, xz, yz) are those of m elements, and
    ``corners`` (m, 8, 3) their vertices; all of the body's elements must be there, in any order. x = 0 and
    y = 0 are planes of symmetry.
    """

    def __init__(self, points, stress, corners):
        points, stress, corners = _mirror(0, (3, 4), points, stress, corners)
        points, stress, corners = _mirror(1, (3, 5), points, stress, corners)
        # A fixed order makes results independent of how elements were spread over ranks.
        centres = corners.mean(axis=1)
        order = np.lexsort(np.round(centres, 9).T)
        self._points, self._stress, corners = points[order], stress[order], corners[order]
        keys, owner = np.unique(np.round(corners.reshape(-1, 3), 7), axis=0, return_inverse=True)
        owner = owner.ravel()
        by_vertex = np.argsort(owner, kind="stable")
        counts = np.bincount(owner)
        members = np.split(by_vertex // 8, np.cumsum(counts)[:-1])
        low, high = corners.min(axis=1), corners.max(axis=1)
        self._element_low, self._element_high = low, high
        # An inner vertex has 8 elements, or 6 where the roller's three patches meet.
        inner = np.flatnonzero(counts >= 6)
        self._members = [members[v] for v in inner]
        self._vertices = keys[inner]
        self._low = np.array([low[m].min(axis=0) for m in self._members]) - self._vertices
        self._high = np.array([high[m].max(axis=0) for m in self._members]) - self._vertices
        self._box = low.min(axis=0), high.max(axis=0)
        self._fits = {}

    def _fit(self, vertex):
        """Coefficients (27, 6) of a vertex's polynomial in coordinates scaled by its patch."""
        if vertex not in self._fits:
            elements = self._members[vertex]
            at = self._local(vertex, self._points[elements].reshape(-1, 3))
            values = self._stress[elements].reshape(-1, 6)
            self._fits[vertex] = np.linalg.lstsq(_terms(at), values, rcond=None)[0]
        return self._fits[vertex]

    def _local(self, vertex, points):
        scale = 0.5 * (self._high[vertex] - self._low[vertex])
        return (points - self._vertices[vertex]) / scale

    def _by_patch(self, point):
        """Stress at a point from the fits around the vertices near it."""
        away = point - self._vertices
        relative = np.maximum(away / self._high, away / self._low)
        # Curved faces put points a little beyond the box of the patch's vertices.
        weight = np.prod(np.clip(1.0 - relative, _RIM, None), axis=1)
        weight[np.any(relative > 1.0 + 1e-6, axis=1)] = 0.0
        if not weight.any():
            weight[np.argmin(relative.max(axis=1))] = 1.0
        chosen = np.flatnonzero(weight > _RIM * weight.max())
        parts = [weight[v] * (_terms(self._local(v, point[None, :])) @ self._fit(v)) for v in chosen]
        return sum(parts)[0] / weight[chosen].sum()

    def _by_element(self, point):
        """Stress at a point, trilinear through its element's points; a mean where elements meet."""
        size = self._element_high - self._element_low
        outside = np.maximum(self._element_low - point, point - self._element_high) / size
        chosen = np.flatnonzero(outside.max(axis=1) <= max(1e-6, outside.max(axis=1).min()))
        values = []
        for element in chosen:
            middle = self._points[element].mean(axis=0)
            half = 0.5 * np.ptp(self._points[element], axis=0)
            at = (self._points[element] - middle) / half
            coefficients = np.linalg.lstsq(_linear_terms(at), self._stress[element], rcond=None)[0]
            values.append(_linear_terms((point - middle)[None, :] / half)[0] @ coefficients)
        return np.mean(values, axis=0)

    def sample(self, points, singular=None):
        """Stress at ``points`` (n, 3) in the body, (n, 6).

        ``singular`` (n,): true for points next to a singularity of the stress. Raises :class:`FemError` for
        a point outside the body.
        """
        found = np.empty((len(points), 6))
        slack = 1e-3 * (self._box[1] - self._box[0])
        for number, point in enumerate(np.asarray(points, dtype=float)):
            if np.any(point < self._box[0] - slack) or np.any(point > self._box[1] + slack):
                raise FemError(f"the point {point.tolist()} (units of C, z is depth) lies outside the body")
            alone = singular is not None and singular[number]
            found[number] = self._by_element(point) if alone else self._by_patch(point)
        return found


def enforce_tractions(points, stress, poisson, end, radius, pressure):
    """Put known tractions into ``stress`` (n, 6) at ``points`` (n, 3), in place.

    On a face the tractions are known, and the strains within the face are well resolved. So the normal and
    shear stresses are replaced and the stresses within the face follow at unchanged strains: both gain
    nu / (1 - nu) times the normal stress's change. Where two faces meet the strain along the edge is kept.
    On the planes of symmetry shear stresses are zero.

    ``points`` have z as depth below the body's surface; ``poisson``; ``end``: y of its free end face;
    ``radius``: of its surface (infinite for the block); ``pressure`` (n,): contact pressure, normal to the
    surface, at the points' x and y. Returns the largest errors of normal traction met on the end face
    and on the surface.
    """
    xx, yy, zz, xy, xz, yz = stress.T
    for shear, axis in ((xy, 0), (xz, 0), (xy, 1), (yz, 1)):
        shear[np.abs(points[:, axis]) < 1e-9] = 0.0
    share = poisson / (1.0 - poisson)
    at_end = np.abs(points[:, 1] - end) < 1e-7 * end
    on_surface = np.abs(points[:, 2]) < 1e-9
    free = at_end & ~on_surface
    end_error = np.abs(yy[free]).max(initial=0.0)
    for within in (xx, zz):
        within[free] -= share * yy[free]
    yy[free] = xy[free] = yz[free] = 0.0

    on = on_surface
    s = points[on, 0] / radius
    c = np.sqrt(1.0 - s**2)
    edge = at_end[on]
    # The surface's frame: t along it within the (x, z) plane, n into the body.
    nn = xx[on] * s**2 - 2.0 * xz[on] * s * c + zz[on] * c**2
    tt = xx[on] * c**2 + 2.0 * xz[on] * s * c + zz[on] * s**2
    along = np.where(edge, 0.0, xy[on] * c + yz[on] * s)
    normal = -pressure[on]
    change = normal - nn
    surface_error = np.abs(change[~edge]).max(initial=0.0)
    tt = tt + np.where(edge, poisson * (change - yy[on]), share * change)
    yy[on] = np.where(edge, 0.0, yy[on] + share * change)
    xx[on] = tt * c**2 + normal * s**2
    zz[on] = tt * s**2 + normal * c**2
    xz[on] = (tt - normal) * s * c
    xy[on], yz[on] = along * c, along * s
    return float(end_error), float(surface_error)


def invariants(stress):
    """Von Mises stress and largest shear stress of tensors (n, 6), as two arrays."""
    xx, yy, zz, xy, xz, yz = np.asarray(stress).T
    von_mises = np.sqrt(
        0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + xz**2 + yz**2)
    )
    rows = [np.stack(row, -1) for row in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))]
    principal = np.linalg.eigvalsh(np.stack(rows, -2))
    return von_mises, 0.5 * (principal[:, 2] - principal[:, 0])
