"""Stresses of a CalculiX run at the elements' integration points, as curves that `edgeline compare` reads.

Nothing lies between the run and these numbers: no recovery, no extrapolation. So they also serve where the tractions
on the surfaces are not known beforehand, as under large displacements.
"""

from pathlib import Path

import numpy as np

from .calculix import read_dat
from .deck import read_bricks
from .meshing import write_atomically
from .results import table
from .scene import BODIES, Scene, surface_depth

# How far from the axis, and how deep, points are taken (units of C).
REACH = 2.0
# What the meshes do not resolve is left out: this near to the contact's edge, where p has a vertical tangent, and this
# near to the corner of an end (units of C).
EDGE, CORNER = 0.2, 0.1
HEADER = ("body", "x_m", "y_m", "z_m", *(f"sigma_{name}_pa" for name in ("xx", "yy", "zz", "xy", "xz", "yz")))


def near_the_contact(name, points, scene):
    """Which ``points`` (n, 3) of the unloaded body, x, y and depth below its surface in units of C, are taken."""
    x, y, depth = points.T
    end = scene.stop
    return ((x < REACH) & (depth > 0.0) & (depth < REACH) & (y < end)
            & (np.hypot(x - 1.0, depth) > EDGE) & (np.hypot(end - y, depth) > CORNER))


def write_points(request, folder, job="model"):
    """Write ``JOB-points.csv`` from ``JOB.dat`` in the ``folder`` of a deck; returns its path and the number of points.

    Places are those of the unloaded bodies; z is the depth below the surface there, stresses are in the body's own
    axes, z into it (with large displacements Cauchy's, still in the fixed axes). Raises :class:`FemError` if the deck's
    or CalculiX' files are missing or damaged.
    """
    folder, scene, scales = Path(folder), Scene.of(request.case), request.case.scales()
    bodies, _ = read_bricks(request, folder)
    stresses, _ = read_dat(folder / f"{job}.dat", bodies)
    rows = []
    for name in BODIES:
        up = 1.0 if name == "block" else -1.0
        points = bodies[name].gauss_points().reshape(-1, 3) * [1.0, 1.0, up]
        points[:, 2] -= surface_depth(name, np.minimum(points[:, 0], scene.radius), scene.radius)
        chosen = near_the_contact(name, points, scene)
        stress = stresses[name].reshape(-1, 6) * [1, 1, 1, 1, up, up] * 1e6
        rows += [((name,), list(place) + list(s))
                 for place, s in zip(points[chosen] * scales.c_m, stress[chosen])]
    path = folder / f"{job}-points.csv"
    write_atomically(path, table(HEADER, rows))
    return path, len(rows)
