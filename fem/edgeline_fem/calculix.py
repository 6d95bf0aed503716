"""The model of one case by CalculiX: the deck of :mod:`edgeline_fem.deck`, run, and its results read.

The contact is CalculiX's own, surface to surface by a penalty. It gives both bodies one normal and opposite forces, so
one of them, or both, gets a shear traction of the order of p x / R that a frictionless contact does not have: 0.02 p0 at
W = 1e-3. Its nodal forces are therefore turned to the normals of both unloaded surfaces, as in the other engine, and a
second, linear run under these gives the stresses.
"""

import dataclasses
import json
import math
import re
import time
from pathlib import Path

import numpy as np

from .contact import ContactGrid
from .deck import STIFFNESS, write_deck, write_forces
from .meshing import processor_seconds, write_atomically
from .programs import run_program
from .recovery import StressField
from .request import FemError
from .results import CURVE_HEADER, curve_table, machine_versions, peak_memory_kib, table
from .sampling import Sampler
from .scene import BODIES, Scene

PRESSURE_HEADER = ("line", "x_m", "y_m", "p_pa", "p_stress_pa")
_STRESSES = re.compile(r"stresses .* for set (\S+) and time\s+(\S+)")
_MOVED = re.compile(r"displacements .* for set (\S+) and time\s+(\S+)")


def ccx_version(program):
    """The version that the CalculiX program prints; :class:`FemError` if it cannot be run."""
    _, said = run_program([program, "-v"], "CalculiX")
    found = re.search(r"[Vv]ersion\s+(\S+)", said)
    if found is None:
        raise FemError(f"CalculiX program '{program}' does not tell its version: {said.strip()[:200]}")
    return found.group(1)


def _block(lines, first, width, path):
    """The rows of numbers below line ``first``, each of ``width``, up to the next heading."""
    rows = []
    for number, line in enumerate(lines[first:], first + 1):
        if not line.strip():
            if rows:
                break
            continue
        words = line.split()
        try:
            row = [float(word) for word in words]
        except ValueError as error:
            raise FemError(f"{path}:{number}: '{line.strip()[:80]}' are not numbers; run it again") from error
        if len(row) != width or not all(map(math.isfinite, row)):
            raise FemError(f"{path}:{number}: '{line.strip()[:80]}' is not a row of {width} numbers; run it again")
        rows.append(row)
    return np.array(rows)


def read_dat(path, bodies):
    """Stresses and the pushed node's displacement in CalculiX' ``.dat`` file, those of its last time.

    Returns ``({body: (elements, 8, 6)}, displacement)`` in the file's units and the elements' order. Raises
    :class:`FemError` with the line where the file is damaged, or if it ends too early.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise FemError(f"{path}: CalculiX left no results ({error.strerror})") from error
    places = {}
    for number, line in enumerate(lines, 1):
        for pattern, kind in ((_STRESSES, "stress"), (_MOVED, "moved")):
            found = pattern.search(line)
            if found is not None:
                places[kind, found.group(1)] = number
    first, stresses = 1, {}
    for name, body in bodies.items():
        if ("stress", name.upper()) not in places:
            raise FemError(f"{path}: holds no stresses of the {name}; run it again")
        rows = _block(lines, places["stress", name.upper()], 8, path)
        count = len(body.cells)
        numbers = np.repeat(np.arange(first, first + count), 8), np.tile(np.arange(1, 9), count)
        if len(rows) != 8 * count or np.any(rows[:, :2] != np.stack(numbers, axis=1)):
            raise FemError(f"{path}: holds {len(rows)} stresses of the {name} instead of {8 * count}, or in another "
                           "order: it is damaged or not complete; run it again")
        # CalculiX writes xx yy zz xy xz yz.
        stresses[name] = rows[:, 2:].reshape(count, 8, 6)
        first += count
    moved = _block(lines, places.get(("moved", "PUSHED"), len(lines)), 4, path)
    if len(moved) != 1:
        raise FemError(f"{path}: holds no displacement of the pushed node; run it again")
    return stresses, moved[0, 3]


def run_ccx(program, folder, job, log):
    """Run the deck ``job``.inp in ``folder``; returns the wall-clock seconds."""
    began = time.perf_counter()
    dat = Path(folder) / f"{job}.dat"
    # Results of an earlier run must not be taken for those of this one.
    dat.unlink(missing_ok=True)
    code, said = run_program([program, "-i", job], "CalculiX", folder)
    write_atomically(Path(folder) / f"{job}.log", said)
    tail = "\n".join(line for line in said.strip().splitlines()[-12:] if line.strip())
    if code != 0 or "*ERROR" in said:
        stopped = f"was killed by signal {-code}" if code < 0 else f"failed on {job}.inp (exit code {code})"
        remedy = ""
        if "diverge" in said or "increment size" in said:
            remedy = "\nits iteration did not converge: try another --size, or --engine fenicsx"
        raise FemError(f"CalculiX {stopped}: {tail}{remedy}")
    if "Job finished" not in said:
        raise FemError(f"CalculiX ended without finishing {job}.inp: {tail}")
    if not dat.exists():
        raise FemError(f"CalculiX left no {job}.dat in {folder}: {tail}")
    seconds = time.perf_counter() - began
    log(f"ccx {job}: {seconds:.1f} s")
    return seconds


class _Grid(ContactGrid):
    """The contact grid, where the pressure is known already."""

    def __init__(self, grid, pressure):
        super().__init__(grid.x[::2], grid.y[::2], grid.even)
        self._known = pressure

    def pressure(self, forces):
        return self._known

    lumped_pressure = pressure


class _Body:
    """What :class:`~edgeline_fem.sampling.Sampler` asks of a body."""

    def __init__(self, name, bricks, stress, poisson):
        self._name, self._bricks, self._stress, self.poisson = name, bricks, stress, poisson

    def stress_field(self, **options):
        """Its stresses in its own axes, z into the body."""
        points, corners = self._bricks.gauss_points(), self._bricks.points[self._bricks.cells[:, :8]]
        stress = self._stress
        if self._name == "roller":
            up = np.array([1.0, 1.0, -1.0])
            points, corners, stress = points * up, corners * up, stress * [1, 1, 1, 1, -1, -1]
        return StressField(points, stress, corners, **options)


@dataclasses.dataclass(frozen=True)
class _Contact:
    """What the contact's run left: ``forces`` on the nodes of :func:`ending_surface`, ``approach``, and errors."""

    forces: np.ndarray
    approach: float
    reaction_error: float
    load_error: float


def _contact(bodies, stresses, approach, scene):
    """The contact forces that balance the stresses of the body that ends where the contact does.

    Where both touched, unloaded, is known of this body alone: its end slides outwards on the other one as they strain.
    """
    inner = {name: bodies[name].nodal_forces(stresses[name])[:, 2] for name in BODIES}
    name, surface = ending_surface(bodies, scene)
    forces = inner[name][surface.rows] * (1.0 if name == "block" else -1.0)
    reactions = [abs(inner[body][bodies[body].sets["support"]].sum()) for body in BODIES]
    worst = max(abs(reaction / scene.load - 1.0) for reaction in reactions)
    return _Contact(forces, approach, worst, abs(forces.sum() / scene.load - 1.0))


def ending_surface(bodies, scene):
    """The body that ends where the contact does, the block if both do, and its surface: ``(name, Surface)``."""
    name = "roller" if scene.ends[-1].goes_on("block") else "block"
    return name, bodies[name].surface


def matching(surface, other):
    """For each node of the ``surface``, that of the ``other`` one opposite to it."""
    distances = (np.abs(other.places - place).max(axis=1) for place in surface.places)
    found, nearest = zip(*((int(np.argmin(away)), away.min()) for away in distances))
    if max(nearest) > 1e-3:
        raise FemError("the nodes of both contact surfaces do not match")
    return np.array(found)


def apply_forces(request, folder, bodies, forces, log):
    """Stresses (units of p0) of both bodies under ``forces`` on the nodes of :func:`ending_surface`, by a linear run.

    Returns ``({body: (m, 8, 6)}, seconds)``.
    """
    _, surface = ending_surface(bodies, Scene.of(request.case))
    on_bodies = {}
    for body, bricks in bodies.items():
        on_bodies[body] = np.zeros(len(bricks.surface.rows))
        on_bodies[body][matching(surface, bricks.surface)] = forces
    write_forces(request, folder, bodies, on_bodies)
    seconds = run_ccx(request.ccx, folder, "forces", log)
    stresses, _ = read_dat(Path(folder) / "forces.dat", bodies)
    return {name: s / (request.case.scales().p0_pa * 1e-6) for name, s in stresses.items()}, seconds


def sampler(request, bodies, meshed, stresses, forces):
    """A :class:`~edgeline_fem.sampling.Sampler` of ``stresses`` under ``forces`` on the nodes of :func:`ending_surface`."""
    scene, axes = Scene.of(request.case), meshed["axes_c"]
    grid = ContactGrid(axes["x_contact"], axes["y_contact"], scene.symmetric)
    grid = _Grid(grid, ending_surface(bodies, scene)[1].pressure(forces, grid))
    models = {
        name: _Body(name, bodies[name], stresses[name], getattr(request.case, name).poisson) for name in BODIES
    }
    return grid, Sampler(scene, models, grid, None)


def _pressure_table(request, samples):
    scales, rows = request.case.scales(), []
    for line, points in request.pressure_points_m.items():
        places = np.array(points) / scales.c_m
        values = np.stack([samples.pressure(places), samples.raised_pressure(places)], axis=1) * scales.p0_pa
        rows += [((line,), point + list(row)) for point, row in zip(points, values)]
    return table(PRESSURE_HEADER, rows)


def solve_case(request, folder, log, stiffness=STIFFNESS):
    """Solve the case meshed in ``folder``; write curves.csv, pressure.csv and, last, fem.json there.

    Returns the content of fem.json. The deck and the raw results stay beside them.
    """
    began, used_before = time.perf_counter(), processor_seconds()
    folder = Path(folder)
    (folder / "fem.json").unlink(missing_ok=True)
    version = ccx_version(request.ccx)
    scene, scales = Scene.of(request.case), request.case.scales()
    bodies, meshed = write_deck(request, folder, stiffness)
    seconds = {"mesh": sum(meshed["seconds"].values()), "deck": time.perf_counter() - began}
    seconds["contact"] = run_ccx(request.ccx, folder, "model", log)
    raw, moved = read_dat(folder / "model.dat", bodies)
    raw = {name: s / (scales.p0_pa * 1e-6) for name, s in raw.items()}
    contact = _contact(bodies, raw, moved * 1e-3 / scales.c_m, scene)
    stresses, seconds["forces"] = apply_forces(request, folder, bodies, contact.forces, log)
    mark = time.perf_counter()
    grid, samples = sampler(request, bodies, meshed, stresses, contact.forces)
    tables = {
        "curves.csv": table(CURVE_HEADER, curve_table(request, samples)),
        "pressure.csv": _pressure_table(request, samples),
    }
    seconds["sample"] = time.perf_counter() - mark
    seconds["total"] = time.perf_counter() - began + seconds["mesh"]
    along = samples.pressure([(0.0, y) for y in grid.y])
    peak = int(np.argmax(along))
    summary = {
        "schema": 1,
        "engine": "calculix",
        "case": request.case.name,
        "versions": {"ccx": version, "gmsh": meshed["gmsh"], "numpy": np.__version__, **machine_versions()},
        "ranks": 1,
        "hertz": {"c_m": scales.c_m, "p0_pa": scales.p0_pa},
        "mesh": {key: meshed[key] for key in ("options", "contact_ends_c", "smallest_c")},
        "solver": {"contact_stiffness": stiffness, "element": "C3D20R"},
        "unknowns": 3 * sum(len(body.points) for body in bodies.values()),
        "contact_nodes": len(contact.forces),
        "load_error_rel": contact.load_error,
        "equilibrium_residual": contact.reaction_error,
        # What the penalty lets the surfaces overlap, in parts of the gap C^2 / 2 R, as p / stiffness.
        "complementarity_residual": float(along[peak]) / stiffness,
        "approach_m": contact.approach * scales.c_m,
        "p_centre_pa": float(samples.pressure([(0.0, scene.middle)])[0]) * scales.p0_pa,
        "p_max_pa": float(along[peak]) * scales.p0_pa,
        "p_max_at_m": [0.0, float(grid.y[peak]) * scales.c_m],
        "traction_error_before_enforcing": samples.face_errors,
        "seconds": {key: round(value, 3) for key, value in seconds.items()},
        "cpu_seconds": round(meshed["cpu_seconds"] + processor_seconds() - used_before, 3),
        "peak_memory_mib": round(peak_memory_kib() / 1024.0, 1),
    }
    for name, text in tables.items():
        write_atomically(folder / name, text)
    write_atomically(folder / "fem.json", json.dumps(summary, indent=1) + "\n")
    return summary
