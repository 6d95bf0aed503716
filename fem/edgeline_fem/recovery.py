"""Stresses at points: superconvergent patch recovery, and enforcement of known tractions.

The stress of a quadratic hexahedron is a full order more accurate at its 2 x 2 x 2 Gauss points than
anywhere else. Around every inner vertex of the mesh a triquadratic polynomial is fitted to those values in
the elements that share the vertex (Zienkiewicz and Zhu, Int. J. Numer. Meth. Engng. 33 (1992) 1331-1364);
between vertices the fits are blended linearly. Planes of symmetry are crossed with mirror images. A part
of the stress that is known and steep, the Hertz field of the load on the line, is left out of the fits and put
back at the end. A polynomial over several elements smears a singularity, so next to one the elements are
asked one by one.
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


# Components of xx, yy, zz, xy, xz, yz that change sign with x: of what pressure does, and of what friction does.
ODD_WHEN_PRESSED, ODD_WHEN_SLIDING = (3, 4), (0, 1, 2, 5)


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


def around_the_arc(radius):
    """The frame in which a roller's elements are boxes: x along its surface, z along the normals there.

    Elements below the surface narrow towards the disc's centre. A narrow one is inclined by several of its
    widths over its depth, so a box around it in x and z contains points far beside it.
    """

    def frame(points):
        x, y, z = np.moveaxis(points, -1, 0)
        return np.stack([radius * np.arctan2(x, radius - z), y, radius - np.hypot(x, radius - z)], axis=-1)

    return frame


class StressField:
    """Stress anywhere in a body, from its values at the elements' superconvergent points.

    ``points`` (m, 8, 3) and ``stress`` (m, 8, 6: xx, yy, zz, xy, xz, yz) are those of m elements, and
    ``corners`` (m, 8, 3) their vertices; all of the body's elements must be there, in any order. x = 0 is a
    plane of symmetry, of antisymmetry if the stress is that of a ``sliding`` body, and y = 0 is one of symmetry if
    the field is ``even``. ``frame`` maps points (..., 3) to
    coordinates in which elements are boxes; stresses stay in the axes x, y, z.
    """

    def __init__(self, points, stress, corners, frame=lambda points: points, even=True, sliding=False):
        flipped = ODD_WHEN_SLIDING if sliding else ODD_WHEN_PRESSED
        points, stress, corners = _mirror(0, flipped, points, stress, corners)
        if even:
            points, stress, corners = _mirror(1, (3, 5), points, stress, corners)
        # A fixed order makes results independent of the distribution of elements over ranks.
        centres = corners.mean(axis=1)
        order = np.lexsort(np.round(centres, 9).T)
        self._frame = frame
        self._points, self._stress, corners = points[order], stress[order], frame(corners[order])
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

    def _rest(self, elements, known):
        """Values at the points of ``elements``, less the stress ``known`` there: (8 a piece, 6)."""
        values = self._stress[elements].reshape(-1, 6)
        return values if known is None else values - known(self._points[elements].reshape(-1, 3))

    def _fit(self, vertex, known):
        """Coefficients (27, 6) of a vertex's polynomial in coordinates scaled by its patch."""
        if (vertex, known) not in self._fits:
            elements = self._members[vertex]
            at = self._local(vertex, self._frame(self._points[elements].reshape(-1, 3)))
            values = self._rest(elements, known)
            self._fits[vertex, known] = np.linalg.lstsq(_terms(at), values, rcond=None)[0]
        return self._fits[vertex, known]

    def _local(self, vertex, points):
        scale = 0.5 * (self._high[vertex] - self._low[vertex])
        return (points - self._vertices[vertex]) / scale

    def _by_patch(self, point, known):
        """Stress at a point from the fits around the vertices near it."""
        away = point - self._vertices
        relative = np.maximum(away / self._high, away / self._low)
        # On curved faces points lie slightly outside the box of the patch's vertices.
        weight = np.prod(np.clip(1.0 - relative, _RIM, None), axis=1)
        weight[np.any(relative > 1.0 + 1e-6, axis=1)] = 0.0
        if not weight.any():
            weight[np.argmin(relative.max(axis=1))] = 1.0
        chosen = np.flatnonzero(weight > _RIM * weight.max())
        parts = [weight[v] * (_terms(self._local(v, point[None, :])) @ self._fit(v, known)) for v in chosen]
        return sum(parts)[0] / weight[chosen].sum()

    def _by_element(self, point, known):
        """Stress at a point, trilinear through its element's points; a mean where elements meet."""
        size = self._element_high - self._element_low
        outside = np.maximum(self._element_low - point, point - self._element_high) / size
        chosen = np.flatnonzero(outside.max(axis=1) <= max(1e-6, outside.max(axis=1).min()))
        values = []
        for element in chosen:
            points = self._frame(self._points[element])
            middle, half = points.mean(axis=0), 0.5 * np.ptp(points, axis=0)
            at = (points - middle) / half
            coefficients = np.linalg.lstsq(_linear_terms(at), self._rest([element], known), rcond=None)[0]
            values.append(_linear_terms((point - middle)[None, :] / half)[0] @ coefficients)
        return np.mean(values, axis=0)

    def sample(self, points, singular=None, known=None):
        """Stress at ``points`` (n, 3) in the body, (n, 6).

        ``singular`` (n,): true for points next to a singularity of the stress. ``known`` (n,): for each
        point a function from points (m, 3) to stresses (m, 6) that has the stress's steep part; polynomials
        are fitted to what is left. Raises :class:`FemError` for a point outside the body.
        """
        found = np.empty((len(points), 6))
        slack = 1e-3 * (self._box[1] - self._box[0])
        points = np.asarray(points, dtype=float)
        for number, (place, point) in enumerate(zip(points, self._frame(points))):
            if np.any(point < self._box[0] - slack) or np.any(point > self._box[1] + slack):
                raise FemError(f"the point {place.tolist()} (units of C, z is depth) lies outside the body")
            alone = singular is not None and singular[number]
            steep = None if known is None else known[number]
            found[number] = (self._by_element if alone else self._by_patch)(point, steep)
            if steep is not None:
                found[number] += steep(place[None, :])[0]
        return found


def _along_and_below(points, radius):
    """x along a surface of this ``radius`` and the depth below it at ``points`` (n, 3), and the sine of its slope."""
    x, _, z = np.asarray(points, dtype=float).T
    if np.isinf(radius):
        sine, depth = np.zeros_like(x), z
    else:
        distance = np.hypot(x, radius - z)
        sine, depth = x / distance, radius - distance
        x = radius * sine
    # Rounding may move points of the surface slightly above it.
    return x, np.maximum(depth, 0.0), sine


def hertz_stress(points, half_width, peak, poisson, radius):
    """Stress (n, 6) at ``points`` (n, 3) of a body in plane strain under a Hertz pressure along y.

    McEwen's form (Johnson, Contact Mechanics, 1985, Eqs. 4.49). ``half_width`` (C) and ``peak`` (p0) are the
    pressure's. On a surface of finite ``radius`` (C) depth runs along its normals.
    """
    x, depth, sine = _along_and_below(points, radius)
    half = half_width**2 - x**2 + depth**2
    root = np.hypot(half, 2.0 * x * depth)
    m = np.sqrt(0.5 * np.maximum(root + half, 0.0))
    n = np.sign(x) * np.sqrt(0.5 * np.maximum(root - half, 0.0))
    # root is 0 only at the contact's edge, where all stresses vanish.
    share = (depth**2 + n**2) / np.maximum(root, 1e-300)
    scale = -peak / half_width
    along, normal = scale * (m * (1.0 + share) - 2.0 * depth), scale * m * (1.0 - share)
    shear = scale * n * (m**2 - depth**2) / np.maximum(root, 1e-300)
    return _turned(along, normal, shear, sine, np.sqrt(1.0 - sine**2), poisson)


def _turned(along, normal, shear, sine, cosine, poisson):
    """Stresses (n, 6) in plane strain from those along and across a surface that rises by ``sine``."""
    zero = np.zeros_like(along)
    return np.stack([
        along * cosine**2 - 2.0 * shear * sine * cosine + normal * sine**2,
        poisson * (along + normal),
        along * sine**2 + 2.0 * shear * sine * cosine + normal * cosine**2,
        zero,
        (along - normal) * sine * cosine + shear * (cosine**2 - sine**2),
        zero,
    ], axis=1)


def hertz_traction_stress(points, half_width, peak, poisson, radius):
    """As :func:`hertz_stress`, under the same as a traction along the surface, towards +x.

    With F the potential of the pressure, pi sigma_xx = -2 Re F + Im(z F'), pi sigma_zz = -Im(z F') and
    pi sigma_xz = Im F + Re(z F') (Johnson, Contact Mechanics, 1985, section 7.1).
    """
    x, depth, sine = _along_and_below(points, radius)
    depth = depth / half_width
    # Just below the surface, to be on the branch that belongs to the body.
    place = x / half_width + 1j * np.maximum(depth, 1e-12)
    root = np.sqrt(place - 1.0) * np.sqrt(place + 1.0)
    potential = place - root
    slope = -depth * potential / root
    along, normal = -2.0 * potential.real + slope.imag, -slope.imag
    shear = potential.imag + slope.real
    return _turned(*(peak * part for part in (along, normal, shear)), sine, np.sqrt(1.0 - sine**2), poisson)


def enforce_tractions(points, stress, poisson, ends, radius, pressure, even=True, sliding=None):
    """Enforce known tractions on ``stress`` (n, 6) at ``points`` (n, 3), in place.

    On a face the tractions are known, and the strains within the face are well resolved. So the normal and
    shear stresses are replaced and the stresses within the face follow at unchanged strains: both gain
    nu / (1 - nu) times the normal stress's change. Where two faces meet the strain along the edge is kept.
    On the planes of symmetry shear stresses are zero.

    ``points`` have z as depth below the body's surface; ``poisson``; ``ends``: y of its free end
    faces; ``radius``: of its surface (infinite for the block); ``pressure`` (n,): contact pressure, normal to the
    surface, at the points' x and y; ``even``: whether y = 0 is a plane of symmetry. ``sliding`` (n,), if the stress is
    that of a sliding body, antisymmetric about x = 0: the traction along the surface, towards +x. Returns the
    largest errors of normal traction met on the end faces and on the surface.
    """
    xx, yy, zz, xy, xz, yz = stress.T
    odd = ODD_WHEN_PRESSED if sliding is None else ODD_WHEN_SLIDING
    across = [(stress[:, component], 0) for component in odd]
    for part, axis in (*across, *(((xy, 1), (yz, 1)) if even else ())):
        part[np.abs(points[:, axis]) < 1e-9] = 0.0
    share = poisson / (1.0 - poisson)
    at_end = np.abs(points[:, 1, None] - np.array(ends)).min(axis=1) < 1e-7 * np.abs(ends).max()
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
    # Outward the surface's normal is -n.
    tn = np.zeros_like(tt) if sliding is None else -sliding[on]
    xx[on] = tt * c**2 - 2.0 * tn * s * c + normal * s**2
    zz[on] = tt * s**2 + 2.0 * tn * s * c + normal * c**2
    xz[on] = (tt - normal) * s * c + tn * (c**2 - s**2)
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
