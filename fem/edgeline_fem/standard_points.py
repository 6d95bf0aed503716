"""The points at which all models and FEM are compared, in units of C.

They are those of the solver's ``standard_curves``; a test on either side pins them.
"""

import math

CURVES = (
    "surface-along-y",
    "surface-along-x",
    "depth-centre",
    "depth-0.9",
    "depth-end",
    "along-y-0.5C",
    "along-y-0.78C",
    "depth-centre-x0.7",
    "depth-0.9-x0.7",
    "depth-end-x0.7",
    "depth-centre-x1.4",
    "depth-0.9-x1.4",
    "depth-end-x1.4",
)

_NEAR = (0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5,
         3.0, 4.0, 5.0, 6.5, 8.0)
_DECADE = (1.0, 1.3, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0, 6.4, 8.0)
_OUTWARD = 3.0
# Depth profiles off the plane of symmetry, inside and outside the contact.
_OFF_PLANE = (0.7, 1.4)
# Lengths within this relative difference are equal: those of a case result from
# divisions.
_SAME = 1e-9


# Errors exclude points this close to the end of the contact line (units of C): for a longer block the
# pressure has no limit there.
EDGE_RANGE = 0.1


def away_from_edge(y, z, half_length):
    """Whether a point at ``y`` and depth ``z`` counts: at least ``EDGE_RANGE`` from the roller's edge.

    The tolerance covers coordinates that were read from files.
    """
    return math.hypot(abs(y) - half_length, z) >= EDGE_RANGE * (1.0 - 1e-3)


def end_distances(half_length):
    """Distances from the roller's end, ascending from 0 to ``half_length`` (> 0)."""
    below = half_length * (1.0 - _SAME)
    distances = [s for s in _NEAR if s < below]
    decade = 10.0
    while decade < below:
        distances += [decade * step for step in _DECADE if decade * step < below]
        decade *= 10.0
    return distances + [half_length]


def contact_line(half_length):
    """y from the middle of the contact line (0) to the roller's end (``half_length``)."""
    return [half_length - s for s in reversed(end_distances(half_length))]


def across_contact():
    """x across the contact, 0 to 1.5."""
    return [0.05 * i for i in range(31)]


def depths():
    """z of the depth profiles, 0 to 5."""
    return ([0.0, 0.02] + [0.05 * i for i in range(1, 31)] + [0.1 * i for i in range(16, 31)]
            + [3.5, 4.0, 5.0])


def behind(name):
    """Name of the curve at -x of the one called ``name`` off the plane x = 0."""
    return f"{name}-xneg"


def standard_curves(half_length, body_half_length, slides=False):
    """Curves of one body as ``{name: [(x, y, z), ...]}`` in the order of the running coordinate.

    ``half_length`` is half the contact's length, ``body_half_length`` (not less) that of the body; a
    longer body's curves along y continue beyond the contact's end for up to 3 C. z is the depth below the body's
    surface at the point's x. Of bodies that slide on each other the curve across the contact goes over both signs of x,
    and those off the plane x = 0 stand at both.
    """
    y = contact_line(half_length)
    ledge = body_half_length - half_length
    if ledge > _SAME * half_length:
        reach = min(ledge, _OUTWARD)
        y += [half_length + s for s in _NEAR if 0.0 < s < reach * (1.0 - _SAME)] + [half_length + reach]
    x = across_contact() + [1.75, 2.0, 2.5, 3.0]
    if slides:
        x = [-v for v in reversed(x[1:])] + x

    def along_y(depth):
        return [(0.0, v, depth) for v in y]

    def along_z(across):
        return [[(across, v, z) for z in depths()] for v in (0.0, 0.9 * half_length, half_length)]

    points = (along_y(0.0), [(v, 0.0, 0.0) for v in x], *along_z(0.0), along_y(0.5), along_y(0.78),
              *(curve for across in _OFF_PLANE for curve in along_z(across)))
    curves = dict(zip(CURVES, points))
    if slides:
        curves |= {
            behind(name): [(-x, y, z) for x, y, z in curve]
            for name, curve in curves.items() if curve[0][0] > 0.0
        }
    return curves


def pressure_lines(half_length):
    """Points (x, y) of the contact pressure: along the contact line and across its middle."""
    return {
        "along-y": [(0.0, y) for y in contact_line(half_length)],
        "along-x": [(x, 0.0) for x in across_contact()],
    }
