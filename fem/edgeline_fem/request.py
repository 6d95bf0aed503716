"""The request that describes one calculation, and the scales that make it dimensionless."""

import dataclasses
import json
import math
import re
from pathlib import Path

import numpy as np

SCHEMA = 1
# The codes that solve a request.
ENGINES = ("fenicsx", "calculix")


class FemError(Exception):
    """A calculation that is impossible; the message says what, where and what to do."""


@dataclasses.dataclass(frozen=True)
class Material:
    """An isotropic elastic material. ``young_pa`` > 0 (Pa); 0 <= ``poisson`` < 0.5."""

    young_pa: float
    poisson: float


@dataclasses.dataclass(frozen=True)
class Scales:
    """Hertz scales of the line contact (Johnson, Contact Mechanics, 1985, Eqs. 4.43 to 4.45).

    ``c_m`` (m) half-width, ``p0_pa`` (Pa) maximum pressure, ``radius`` the roller's radius in units of
    C; in these units the contact modulus E* is ``2 * radius``.
    """

    c_m: float
    p0_pa: float
    radius: float

    @property
    def e_star(self):
        """Contact modulus in units of p0."""
        return 2.0 * self.radius


@dataclasses.dataclass(frozen=True)
class Case:
    """Two bodies and what presses them together (SI units).

    A profile is a table of (y, drop): how far the generatrix lies below the straight one, over y from the body's
    own middle, straight between its points. ``eccentricity_m`` is y of the force's line of action from the
    roller's middle; the tilt is then what that asks for. Without it the bodies are held at ``tilt_rad``, or parallel.
    ``offset_m`` is y of the block's middle from the roller's. ``friction``: the traction on the block along +x, and on
    the roller along -x, in pressures.
    """

    name: str
    radius_m: float
    roller_length_m: float
    block_length_m: float
    roller: Material
    block: Material
    force_n: float
    roller_profile_m: tuple | None = None
    block_profile_m: tuple | None = None
    eccentricity_m: float | None = None
    tilt_rad: float | None = None
    offset_m: float = 0.0
    friction: float = 0.0

    def scales(self):
        """The case's :class:`Scales`, from the mean load of the shorter body."""
        compliance = sum((1.0 - m.poisson**2) / m.young_pa for m in (self.roller, self.block))
        e_star_pa = 1.0 / compliance
        length_m = min(self.roller_length_m, self.block_length_m)
        w = self.force_n / (e_star_pa * self.radius_m * length_m)
        c_m = 2.0 * self.radius_m * math.sqrt(w / math.pi)
        return Scales(c_m, e_star_pa * c_m / (2.0 * self.radius_m), self.radius_m / c_m)

    def roller_half_length(self):
        """Half the roller's length (units of C)."""
        return 0.5 * self.roller_length_m / self.scales().c_m

    def block_half_length(self):
        """Half the block's length (units of C)."""
        return 0.5 * self.block_length_m / self.scales().c_m

    def contact_half_length(self):
        """Half the shorter body's length, S_l (units of C)."""
        return min(self.roller_half_length(), self.block_half_length())

    def is_symmetric(self):
        """Whether y = 0 is a plane of symmetry: parallel axes, no offset, even profiles."""
        def even(table):
            if table is None:
                return True
            points = np.array(table)
            unlike = np.abs(points - points[::-1] * [-1.0, 1.0]).max(axis=0)
            return bool(np.all(unlike <= 1e-9 * np.abs(points).max(axis=0)))

        held = self.eccentricity_m is None and not self.tilt_rad
        return held and self.offset_m == 0.0 and even(self.roller_profile_m) and even(self.block_profile_m)

    def to_json(self):
        """The ``case`` object of a request; what is left out there is left out here."""
        def body(profile, **values):
            return values if profile is None else {**values, "profile_m": [list(point) for point in profile]}

        position = {"eccentricity_m": self.eccentricity_m, "tilt_rad": self.tilt_rad,
                    "offset_m": self.offset_m or None, "friction": self.friction or None}
        return {
            "name": self.name,
            "roller": body(self.roller_profile_m, radius_m=self.radius_m, length_m=self.roller_length_m,
                           **dataclasses.asdict(self.roller)),
            "block": body(self.block_profile_m, length_m=self.block_length_m, **dataclasses.asdict(self.block)),
            "force_n": self.force_n,
            **{key: value for key, value in position.items() if value is not None},
        }

    @staticmethod
    def from_dimensionless(name, load_factor, slenderness, length_ratio, radius_m, roller, block):
        """The case with W = ``load_factor``, S_l = ``slenderness`` and L_r = ``length_ratio``."""
        e_star_pa = 1.0 / sum((1.0 - m.poisson**2) / m.young_pa for m in (roller, block))
        c_m = 2.0 * radius_m * math.sqrt(load_factor / math.pi)
        length_m = 2.0 * c_m * slenderness
        force_n = load_factor * e_star_pa * radius_m * length_m
        return Case(name, radius_m, length_m, length_m / length_ratio, roller, block, force_n)


@dataclasses.dataclass(frozen=True)
class MeshOptions:
    """The mesh family. All lengths are in units of C.

    ``size`` is the family's one parameter: every element is ``size`` times as large as in the
    production mesh, in every direction and everywhere. The rest shapes the family and is left alone
    except in studies of the mesh itself.
    """

    size: float = 1.0
    across: float = 0.16
    """Element size across the contact as far as ``contact_reach`` (size 1)."""
    edge: float = 0.02
    """The same at the contact's edge x = 1, where the pressure has a vertical tangent."""
    depth: float = 0.02
    """Element size at the surface, along z (size 1)."""
    end: float = 0.06
    """Element size at the roller's end, along y, if the block ends there as well (size 1)."""
    corner: float = 0.015
    """The same if the block goes on: the pressure is singular then (size 1)."""
    tip: float = 0.02
    """The same where the contact is expected to end before the bodies do (size 1)."""
    beyond: float = 0.5
    """Increase of element size per unit of distance along y, in the block beyond the roller's end."""
    free_end: float = 2.0
    """Element size at the end of a block that is longer than the roller, along y (size 1).

    Never more than a quarter of what the block is longer at that end.
    """
    growth: float = 0.42
    """Increase of element size per unit of distance along x and y, near the contact (size 1).

    Along the contact line it holds all the way.
    """
    along: float = 0.5
    """Largest element along the contact line of profiled bodies, which may part anywhere (size 1)."""
    depth_growth: float = 0.34
    """The same along z."""
    far_growth: float = 1.4
    """Increase of element size per unit of distance, in every direction, beyond ``far_from``."""
    far_from: float = 5.0
    """Distance at which the mesh starts to grow faster."""
    contact_reach: float = 1.5
    """Half-width of the strip of the surface in which contact is looked for."""
    block_width: float = 640.0
    """The block's half-width in x."""
    block_depth: float = 640.0
    """The block's depth in z."""
    vtk: bool = False
    """Also write the meshes as .vtk, for ParaView."""


@dataclasses.dataclass(frozen=True)
class SolverOptions:
    """``linear``: ``direct`` (sparse Cholesky) or ``iterative`` (CG with algebraic multigrid).

    ``tolerance`` bounds the contact's relative residual, ``linear_tolerance`` that of an iterative
    linear solve, ``max_iterations`` the number of contact iterations.
    """

    linear: str = "direct"
    tolerance: float = 1e-8
    linear_tolerance: float = 1e-10
    max_iterations: int = 200


@dataclasses.dataclass(frozen=True)
class Curve:
    """Points (x, y, z) of one body at which stresses are requested (m, z is depth below its surface)."""

    body: str
    name: str
    points_m: list


@dataclasses.dataclass(frozen=True)
class Request:
    """All input of a calculation.

    ``contact_ends_m``: where along y the contact is expected to end before the bodies do; meshes are finer there,
    and nothing else depends on it. ``large_displacements``: the deck's bodies are in equilibrium where they have
    moved to; nothing else takes that.
    """

    case: Case
    mesh: MeshOptions
    solver: SolverOptions
    curves: list
    pressure_points_m: dict
    gmsh: str = "gmsh"
    engine: str = "fenicsx"
    ccx: str = "ccx"
    contact_ends_m: tuple = ()
    large_displacements: bool = False

    def tips(self):
        """``contact_ends_m`` in units of C."""
        c_m = self.case.scales().c_m
        return [y_m / c_m for y_m in self.contact_ends_m]

    def to_json(self):
        """The request as the JSON object that :func:`read_request` accepts."""
        return {
            "schema": SCHEMA,
            "case": self.case.to_json(),
            "mesh": dataclasses.asdict(self.mesh),
            "solver": dataclasses.asdict(self.solver),
            "curves": [{"body": c.body, "curve": c.name, "points_m": c.points_m} for c in self.curves],
            "pressure_points_m": self.pressure_points_m,
            "gmsh": self.gmsh,
            **({} if self.engine == "fenicsx" else {"engine": self.engine, "ccx": self.ccx}),
            **({"contact_ends_m": list(self.contact_ends_m)} if self.contact_ends_m else {}),
            **({"large_displacements": True} if self.large_displacements else {}),
        }


def subtable(parent, key, where):
    """The object ``key`` of ``parent``."""
    value = parent.get(key)
    if not isinstance(value, dict):
        raise FemError(f"{where}: '{key}' is missing or is not an object")
    return value


def only_keys(table, known, where):
    """Raise :class:`FemError` where ``table`` has a key that is not ``known``."""
    unknown = sorted(set(table) - set(known))
    if unknown:
        raise FemError(f"{where}: unknown key '{unknown[0]}'; known are {', '.join(sorted(known))}")


def is_finite(value):
    """Whether a value is a finite number."""
    try:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    except OverflowError:  # a whole number that no float holds
        return False


def positive(table, key, where):
    """A finite number above 0."""
    value = table.get(key)
    if not is_finite(value) or value <= 0.0:
        raise FemError(f"{where}: '{key}' must be a finite number above 0, not {value!r}")
    return float(value)


def _number(table, key, where):
    """A finite number, or ``None`` where there is none."""
    value = table.get(key)
    if value is not None and not is_finite(value):
        raise FemError(f"{where}: '{key}' must be a finite number, not {value!r}")
    return None if value is None else float(value)


def _profile(table, length_m, where):
    """The profile of a body as a tuple of (y, drop), or ``None``."""
    if "profile_m" not in table:
        return None
    points = _points(table["profile_m"], 2, f"{where}.profile_m")
    y = [point[0] for point in points]
    if any(b <= a for a, b in zip(y, y[1:])):
        raise FemError(f"{where}.profile_m: y must ascend")
    if max(y[0] + 0.5 * length_m, 0.5 * length_m - y[-1]) > 1e-9 * length_m:
        raise FemError(f"{where}.profile_m: must reach from -{0.5 * length_m:g} to {0.5 * length_m:g} m, the "
                       f"body's ends; it goes from {y[0]:g} to {y[-1]:g} m")
    return tuple(map(tuple, points))


def material(table, where):
    """A :class:`Material` from the object of a body."""
    young_pa = positive(table, "young_pa", where)
    poisson = table.get("poisson")
    if not is_finite(poisson) or not 0.0 <= poisson < 0.5:
        raise FemError(f"{where}: 'poisson' must lie in [0, 0.5), not {poisson!r}")
    return Material(young_pa, float(poisson))


def _options(cls, table, where):
    """An options dataclass from a JSON object, each value checked against the default's type."""
    fields = {field.name: field for field in dataclasses.fields(cls)}
    only_keys(table, fields, where)
    values = {}
    for key, value in table.items():
        default = fields[key].default
        if isinstance(default, bool):
            if not isinstance(value, bool):
                raise FemError(f"{where}: '{key}' must be true or false, not {value!r}")
            values[key] = value
        elif isinstance(default, int):
            if not isinstance(value, int) or isinstance(value, bool) or value < 1:
                raise FemError(f"{where}: '{key}' must be a whole number above 0, not {value!r}")
            values[key] = value
        elif isinstance(default, float):
            values[key] = positive(table, key, where)
        else:
            values[key] = value
    return cls(**values)


def check_case_name(name, where):
    """Raise :class:`FemError` unless a folder can be named after the case: the rule of case files."""
    if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,63}", name):
        raise FemError(f"{where}: the case's name {name!r} is not valid: a name is 1 to 64 letters, digits, '-', '_' and "
                       "'.', and does not start with '.'; choose such a name: folders are named after it")


def _column_text(name, key, where):
    """The name of a curve or line, as tables have it."""
    if not isinstance(name, str) or not name or "," in name:
        raise FemError(f"{where}: '{key}' must be a name without commas")
    return name


def _points(points, width, where):
    """A list of points with ``width`` finite coordinates each."""
    good = isinstance(points, list) and points and all(
        isinstance(p, list)
        and len(p) == width
        and all(is_finite(v) for v in p)
        for p in points
    )
    if not good:
        raise FemError(f"{where}: must be a non-empty list of points of {width} finite numbers")
    return [[float(v) for v in p] for p in points]


def parse_case(case, where):
    """A :class:`Case` from its JSON object."""
    only_keys(case, {"name", "roller", "block", "force_n", "eccentricity_m", "tilt_rad", "offset_m", "friction"},
          where)
    roller, block = subtable(case, "roller", where), subtable(case, "block", where)
    # The profile's own form is for those who read the request; its points count here.
    only_keys(roller, {"radius_m", "length_m", "young_pa", "poisson", "profile_m", "profile"}, f"{where}.roller")
    only_keys(block, {"length_m", "young_pa", "poisson", "profile_m", "profile"}, f"{where}.block")
    lengths = [positive(body, "length_m", f"{where}.{name}")
               for name, body in (("roller", roller), ("block", block))]
    parsed = Case(
        name=str(case.get("name", "")),
        radius_m=positive(roller, "radius_m", f"{where}.roller"),
        roller_length_m=lengths[0],
        block_length_m=lengths[1],
        roller=material(roller, f"{where}.roller"),
        block=material(block, f"{where}.block"),
        force_n=positive(case, "force_n", where),
        roller_profile_m=_profile(roller, lengths[0], f"{where}.roller"),
        block_profile_m=_profile(block, lengths[1], f"{where}.block"),
        eccentricity_m=_number(case, "eccentricity_m", where),
        tilt_rad=_number(case, "tilt_rad", where),
        offset_m=_number(case, "offset_m", where) or 0.0,
        friction=_number(case, "friction", where) or 0.0,
    )
    if not isinstance(case.get("name", ""), str):
        raise FemError(f"{where}: 'name' must be a text, not {case['name']!r}")
    try:
        scales = dataclasses.astuple(parsed.scales())
    except (ZeroDivisionError, OverflowError):
        scales = (0.0,)
    # Each number may be legal, and what follows from them out of reach of floating point.
    if not all(is_finite(scale) and scale > 0.0 for scale in scales):
        raise FemError(f"{where}: its half-width and pressure are no finite numbers above 0; check force, "
                       "lengths and moduli and their units")
    if not 0.0 <= parsed.friction <= 1.0:
        raise FemError(f"{where}: 'friction' must lie in [0, 1], not {parsed.friction:g}")
    if parsed.eccentricity_m is not None and parsed.tilt_rad is not None:
        raise FemError(f"{where}: 'eccentricity_m' and 'tilt_rad' exclude each other: leave one out")
    apart = abs(parsed.offset_m) - 0.5 * sum(lengths)
    if apart >= -1e-3 * parsed.scales().c_m:
        raise FemError(f"{where}: the bodies do not overlap: 'offset_m' = {parsed.offset_m:g} leaves them "
                       f"{max(apart, 0.0):g} m apart")
    return parsed


def parse_request(data, where="request"):
    """A :class:`Request` from a JSON object.

    Raises :class:`FemError` that names the key at fault and, through ``where``, the file.
    """
    if not isinstance(data, dict):
        raise FemError(f"{where}: must be a JSON object")
    only_keys(data, {"schema", "case", "mesh", "solver", "curves", "pressure_points_m", "gmsh", "engine", "ccx",
                 "contact_ends_m", "large_displacements"}, where)
    if data.get("schema") != SCHEMA:
        raise FemError(f"{where}: 'schema' is {data.get('schema')!r}, this program reads {SCHEMA}")

    parsed = parse_case(subtable(data, "case", where), f"{where}: case")

    solver = _options(SolverOptions, subtable(data, "solver", where) if "solver" in data else {},
                      f"{where}: solver")
    if solver.linear not in ("direct", "iterative"):
        raise FemError(f"{where}: solver: 'linear' must be direct or iterative, not {solver.linear!r}")

    curves = []
    listed = data.get("curves", [])
    if not isinstance(listed, list):
        raise FemError(f"{where}: 'curves' must be a list of objects, not {listed!r}")
    for number, curve in enumerate(listed):
        at = f"{where}: curves[{number}]"
        if not isinstance(curve, dict):
            raise FemError(f"{at}: must be an object")
        only_keys(curve, {"body", "curve", "points_m"}, at)
        if curve.get("body") not in ("block", "roller"):
            raise FemError(f"{at}: 'body' must be block or roller, not {curve.get('body')!r}")
        name = _column_text(curve.get("curve"), "curve", at)
        curves.append(Curve(curve["body"], name, _points(curve.get("points_m"), 3, f"{at}.points_m")))

    lines = data.get("pressure_points_m", {})
    if not isinstance(lines, dict):
        raise FemError(f"{where}: 'pressure_points_m' must be an object of lists of points")
    lines = {
        _column_text(name, name, f"{where}: pressure_points_m"): _points(points, 2, f"{where}: pressure_points_m.{name}")
        for name, points in lines.items()
    }
    programs = {}
    for key, name in (("gmsh", "gmsh"), ("ccx", "CalculiX")):
        programs[key] = data.get(key, key)
        if not isinstance(programs[key], str) or not programs[key] or "\0" in programs[key]:
            raise FemError(f"{where}: '{key}' must be the name or path of the {name} program")
    engine = data.get("engine", "fenicsx")
    if engine not in ENGINES:
        raise FemError(f"{where}: 'engine' must be one of {', '.join(ENGINES)}, not {engine!r}")
    contact_ends = data.get("contact_ends_m", [])
    if not isinstance(contact_ends, list) or not all(is_finite(y) for y in contact_ends):
        raise FemError(f"{where}: 'contact_ends_m' must be a list of finite numbers, not {contact_ends!r}")
    large = data.get("large_displacements", False)
    if not isinstance(large, bool):
        raise FemError(f"{where}: 'large_displacements' must be true or false, not {large!r}")
    mesh = _options(MeshOptions, subtable(data, "mesh", where) if "mesh" in data else {},
                    f"{where}: mesh")
    return Request(parsed, mesh, solver, curves, lines, engine=engine, contact_ends_m=tuple(contact_ends),
                   large_displacements=large, **programs)


def read_json(path):
    """What the JSON file at ``path`` holds; :class:`FemError` if it cannot be read."""
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8"))
        # An escape such as \ud800 alone is legal JSON, but no text that a file or a command can hold.
        json.dumps(data, ensure_ascii=False).encode()
        return data
    except OSError as error:
        raise FemError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeEncodeError as error:
        raise FemError(f"{path}: has a lone surrogate in a text: {error}; remove it") from error
    except (ValueError, RecursionError) as error:
        raise FemError(f"{path}: is not JSON: {error}") from error


def read_request(path):
    """The request in the file at ``path``; :class:`FemError` if it cannot be read or used."""
    return parse_request(read_json(path), str(path))
