"""What is read off a solved contact: stresses at points of either body, and the contact pressure."""

import functools

import numpy as np

from .recovery import (
    ODD_WHEN_PRESSED, ODD_WHEN_SLIDING, around_the_arc, enforce_tractions, hertz_stress, hertz_traction_stress,
)
from .scene import surface_depth

# Nearer than this to the corner of a body that the other one goes on beyond (units of C), stresses belong to
# the mesh.
SINGULAR_RANGE = 0.099
# As far from such a corner the pressure is no longer its own.
_CORNER_REACH = 0.5


def near_singularity(points, scene):
    """Whether ``points`` (n, 3: x, y, depth) lie where no polynomial over several elements holds.

    That is around an end of the overlap beyond which one body goes on.
    """
    near = np.zeros(len(points), dtype=bool)
    for end in scene.ends:
        if end.longer is not None:
            near |= np.hypot(points[:, 1] - end.y, points[:, 2]) < SINGULAR_RANGE
    return near


# Direction of the traction on each body of a scene that slides.
_SLIDES = {"block": 1.0, "roller": -1.0}


class Sampler:
    """Samples of a ``scene`` whose ``bodies`` are in their final state under nodal ``forces`` on ``grid``.

    ``dragged``: the bodies under the tractions of the scene's friction, if it has any.

    ``face_errors``: for each body, the largest errors of normal traction met so far on its end faces and its
    surface, before the known ones were put in.
    """

    def __init__(self, scene, bodies, grid, forces, dragged=None):
        self._scene, self._grid = scene, grid
        self._poisson = {name: body.poisson for name, body in bodies.items()}
        self._radii = {"block": np.inf, "roller": scene.radius}
        self._pressure, self._lumped = grid.pressure(forces), grid.lumped_pressure(forces)
        frames = {"block": {}, "roller": {"frame": around_the_arc(scene.radius)}}
        self._fields = {
            name: body.stress_field(even=scene.symmetric, **frames[name]) for name, body in bodies.items()
        }
        self._dragged = {
            name: body.stress_field(even=scene.symmetric, sliding=True, **frames[name])
            for name, body in (dragged or {}).items()
        }
        self.face_errors = {name: {"end": 0.0, "surface": 0.0} for name in bodies}

    def _steep_parts(self, name, y, steep=hertz_stress, factor=1.0):
        """What :meth:`StressField.sample` takes as ``known`` for points of a body at ``y`` (n,).

        Under the contact line it is the Hertz field that falls to 0 across the contact as the pressure does:
        stresses have a vertical tangent there that no polynomial follows. At the end of the overlap beyond
        which a body goes on the pressure has no limit, so there it is that of 0.5 C from the end; in the body that
        goes on, half of that as far as 0.5 C beyond, and then nothing. Where the bodies do not touch there is none.
        """
        scene = self._scene
        reach = min(_CORNER_REACH, 0.5 * (scene.stop - scene.middle))

        @functools.lru_cache(maxsize=None)
        def at(y, share):
            found = self._grid.hertz_at(self._pressure, y)
            if found is None:
                return None
            half_width, peak = found
            peak *= share * factor
            return lambda p: steep(p, half_width, peak, self._poisson[name], self._radii[name])

        def part(y):
            for end in scene.ends:
                outwards = -1.0 if end.y < scene.middle else 1.0
                beyond = outwards * (y - end.y)
                if end.longer is None or beyond <= -reach:
                    continue
                last = end.y - outwards * reach
                if not end.goes_on(name):
                    return at(last, 1.0)
                return at(last, 0.5) if beyond < _CORNER_REACH else None
            return at(y, 1.0)

        return [part(v) for v in y]

    def stress(self, name, points):
        """Stress (n, 6) at ``points`` (n, 3: x, y, depth below the surface at that x) of a body."""
        behind = points[:, 0] < 0.0
        points = points.copy()
        points[:, 0] = np.abs(points[:, 0])
        inside = points.copy()
        inside[:, 2] += surface_depth(name, points[:, 0], self._scene.radius)
        singular = near_singularity(points, self._scene)
        pressure = self._grid.sample(self._pressure, points[:, :2])
        known = self._poisson[name], self._scene.free_ends(name), self._radii[name]
        met = self.face_errors[name]

        def enforced(stress, pressure, odd, sliding=None):
            errors = enforce_tractions(points, stress, *known, pressure, self._scene.symmetric, sliding)
            met["end"], met["surface"] = max(met["end"], errors[0]), max(met["surface"], errors[1])
            signs = np.ones_like(stress)
            signs[np.ix_(behind, odd)] = -1.0
            return signs * stress

        steep = self._steep_parts(name, points[:, 1])
        stress = enforced(self._fields[name].sample(inside, singular, steep), pressure, ODD_WHEN_PRESSED)
        if name in self._dragged:
            factor = _SLIDES[name] * self._scene.friction
            steep = self._steep_parts(name, points[:, 1], hertz_traction_stress, factor)
            found = self._dragged[name].sample(inside, singular, steep)
            stress += enforced(found, 0.0 * pressure, ODD_WHEN_SLIDING, factor * pressure)
        return stress

    def pressure(self, points):
        """Contact pressure at ``points`` (n, 2), (n,)."""
        return self._grid.sample(self._pressure, points)

    def pressures(self, points):
        """The same, from lumped forces and from the block's stress besides: (n, 3)."""
        lumped = self._grid.sample(self._lumped, points)
        return np.stack([self.pressure(points), lumped, self.raised_pressure(points)], axis=1)

    def raised_pressure(self, points):
        """Contact pressure at ``points`` (n, 2) from the block's stress, (n,)."""
        surface = np.column_stack([points, np.zeros(len(points))])
        steep = self._steep_parts("block", points[:, 1])
        return -self._fields["block"].sample(surface, near_singularity(surface, self._scene), steep)[:, 2]
