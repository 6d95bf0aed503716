"""Where the bodies lie along y, and what presses them together, in units of C and p0.

y is measured from the roller's middle. A scene that looks alike from both ends is modelled from its middle on
(y >= 0), any other one over its whole length; x >= 0 in both.
"""

import dataclasses

import numpy as np

BODIES = ("block", "roller")
# Lengths that differ by less than this part are the same: those of a case come out of divisions.
_SAME = 1e-9


def surface_depth(body, x, radius):
    """z of a body's unloaded surface at ``x`` (units of C): 0 on the block, the arc on the roller."""
    x = np.asarray(x, dtype=float)
    return np.zeros_like(x) if body == "block" else x**2 / (radius + np.sqrt(radius**2 - x**2))


def surface_slope(body, x, radius):
    """dz/dx of a body's unloaded surface at ``x`` (units of C)."""
    x = np.asarray(x, dtype=float)
    return np.zeros_like(x) if body == "block" else x / np.sqrt(radius**2 - x**2)


@dataclasses.dataclass(frozen=True)
class End:
    """An end of the overlap: its place ``y``, and the body that goes on beyond it (``None`` if flush)."""

    y: float
    longer: str | None

    def goes_on(self, body):
        """Whether ``body`` goes on beyond this end."""
        return self.longer == body


@dataclasses.dataclass(frozen=True)
class Scene:
    """One case as it is modelled.

    ``radius`` of the roller; ``spans``: for each body the model's range of y; ``ends``: those of the overlap
    that are in the model, ascending in y; ``start``: where the overlap begins in the model; ``symmetric``:
    whether y = 0 is a plane of symmetry where the model begins; ``load``: the part of the force that the
    model carries; ``moment``: the same of its moment about x, positive where the side of larger y is pressed
    deeper (``None``: the tilt is held); ``tilt``: the held one, with the same sign, that of the lines x = 0 one
    roller radius below both surfaces; ``friction``: traction along x, in pressures.
    """

    radius: float
    spans: dict
    ends: tuple
    start: float
    symmetric: bool
    load: float
    moment: float | None
    tilt: float
    friction: float
    _profiles: dict

    @staticmethod
    def of(case):
        """The scene of a :class:`~edgeline_fem.request.Case`."""
        scales = case.scales()
        c_m = scales.c_m
        middles = {"roller": 0.0, "block": case.offset_m / c_m}
        halves = {"roller": case.roller_half_length(), "block": case.block_half_length()}
        symmetric = case.is_symmetric()
        spans = {
            name: (0.0 if symmetric else middles[name] - halves[name], middles[name] + halves[name])
            for name in BODIES
        }
        start, stop = max(low for low, _ in spans.values()), min(high for _, high in spans.values())
        same = _SAME * min(halves.values())

        def end(y, reaches):
            longer = [name for name, reach in reaches.items() if reach > same]
            return End(y, longer[0] if longer else None)

        ends = [end(stop, {name: high - stop for name, (_, high) in spans.items()})]
        if not symmetric:
            ends.insert(0, end(start, {name: start - low for name, (low, _) in spans.items()}))
        # The load of the Hertz pressure on the shorter body.
        load = (0.25 if symmetric else 0.5) * np.pi * case.contact_half_length()
        moment = None if case.eccentricity_m is None else load * case.eccentricity_m / c_m
        profiles = {
            name: (middles[name], np.array(table) / c_m)
            for name, table in (("roller", case.roller_profile_m), ("block", case.block_profile_m))
            if table is not None
        }
        return Scene(scales.radius, spans, tuple(ends), start, symmetric, load, moment,
                     case.tilt_rad or 0.0, case.friction, profiles)

    @property
    def stop(self):
        """Where the overlap ends."""
        return self.ends[-1].y

    @property
    def middle(self):
        """The middle of the overlap."""
        return 0.0 if self.symmetric else 0.5 * (self.start + self.stop)

    @property
    def profiled(self):
        """Whether a generatrix is not straight, so that the contact may end anywhere."""
        return bool(self._profiles)

    def drop(self, y):
        """What profiles add to the gap at ``y`` (n,)."""
        total = np.zeros(len(y))
        for middle, table in self._profiles.values():
            total += np.interp(y - middle, table[:, 0], table[:, 1])
        return total

    def free_ends(self, body):
        """Places of a body's end faces in the model."""
        low, high = self.spans[body]
        return (high,) if self.symmetric else (low, high)
