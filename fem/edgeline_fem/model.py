"""The two-body model of one case: solve the contact, recover stresses, write the results."""

import csv
import dataclasses
import functools
import io
import json
import os
import platform
import resource
import time
from pathlib import Path

import numpy as np

from . import compat
from .contact import ContactGrid, half_space_compliance, solve_contact
from .elasticity import Body, load_mesh
from .meshing import processor_seconds, write_atomically
from .recovery import around_the_arc, enforce_tractions, hertz_stress, invariants
from .request import FemError

CURVE_HEADER = ("body", "curve", "x_m", "y_m", "z_m",
                *(f"sigma_{c}_pa" for c in ("xx", "yy", "zz", "xy", "xz", "yz")), "von_mises_pa", "tau_max_pa")
PRESSURE_HEADER = ("line", "x_m", "y_m", "p_pa", "p_lumped_pa", "p_stress_pa")

# Nearer than this to a roller's end on a longer block (units of C), stresses belong to the mesh.
SINGULAR_RANGE = 0.099

BOUNDARY_CONDITIONS = {
    "block": "x = 0 and y = 0: symmetry planes; bottom z = block_depth: u_z = 0, free of shear; far side "
    "x = block_width, end face and surface: free of traction",
    "roller": "x = 0 and y = 0: symmetry planes; mid-plane z = R: u_z uniform (the approach), free of "
    "shear; end face and surface: free of traction",
    "contact": "frictionless; nodal gaps along z, at fixed x, are never negative, nodal forces are normal to "
    "the unloaded surfaces and never pull, the sum of their z components is the load",
}


def processor():
    """The processor's name as the system states it."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def blas():
    """File name of the BLAS library that this process has loaded."""
    try:
        maps = Path("/proc/self/maps").read_text(encoding="utf-8")
    except OSError:
        return "unknown"
    names = {os.path.realpath(line.split()[-1]) for line in maps.splitlines() if "blas" in line}
    kept = sorted({"/".join(Path(name).parts[-2:]) for name in names if "libblas" in name})
    return kept[0] if kept else "unknown"


def build_bodies(comm, folder, request, plane_strain=False):
    """Both bodies as ``{"block": Body, "roller": Body}`` from the meshes in ``folder``.

    ``plane_strain`` also holds the end faces along y. Returns the bodies and the seconds spent reading.
    """
    case, options = request.case, request.mesh
    scales = case.scales()
    supports = {"block": options.block_depth, "roller": scales.radius}
    ends = {"block": case.block_half_length(), "roller": case.roller_half_length()}
    bodies, seconds = {}, 0.0
    for name in ("block", "roller"):
        began = time.perf_counter()
        domain = load_mesh(comm, Path(folder) / f"{name}.msh")
        seconds += time.perf_counter() - began
        material = getattr(case, name)

        def on(axis, value, tolerance=1e-7 * supports[name]):
            return lambda x: np.abs(x[axis] - value) < tolerance

        fixed = [(0, on(0, 0.0)), (1, on(1, 0.0)), (2, on(2, supports[name]))]
        if plane_strain:
            fixed.append((1, on(1, ends[name])))
        bodies[name] = Body(
            domain, material.young_pa / scales.p0_pa, material.poisson, fixed,
            request.solver.linear, request.solver.linear_tolerance,
        )
    return bodies, seconds


def surface_depth(name, x, radius):
    """z of a body's unloaded surface at ``x`` (units of C): 0 on the block, the arc on the roller."""
    x = np.asarray(x, dtype=float)
    return np.zeros_like(x) if name == "block" else x**2 / (radius + np.sqrt(radius**2 - x**2))


def surface_slope(name, x, radius):
    """dz/dx of a body's unloaded surface at ``x`` (units of C)."""
    x = np.asarray(x, dtype=float)
    return np.zeros_like(x) if name == "block" else x / np.sqrt(radius**2 - x**2)


def near_singularity(points, case):
    """Whether ``points`` (n, 3: x, y, depth) lie where no polynomial over several elements holds.

    That is around the roller's end face, where the block goes on beyond it.
    """
    longer = case.block_length_m > case.roller_length_m * (1.0 + 1e-9)
    return longer & (np.hypot(points[:, 1] - case.roller_half_length(), points[:, 2]) < SINGULAR_RANGE)


def steep_parts(points, case, grid, pressure, poisson, radius):
    """What :meth:`StressField.sample` takes as ``known`` at ``points`` (n, 3: x, y, depth).

    Under the contact line it is the Hertz field that falls to 0 across the contact as ``pressure`` does, which
    is given at the ``grid``'s Gauss points: stresses have a vertical tangent there that no polynomial follows.
    On a longer block the pressure at the roller's end has no limit, so there it is that of 0.5 C from the end;
    in the block, where the load stops, half of that as far as 0.5 C beyond, and then nothing.
    """
    length = case.roller_half_length()
    longer = case.block_length_m > case.roller_length_m * (1.0 + 1e-9)
    last = max(length - 0.5, 0.5 * length) if longer else length
    attached = longer and np.isinf(radius)

    @functools.lru_cache(maxsize=None)
    def at(y, share):
        half_width, peak = grid.hertz_at(pressure, y)
        return lambda p: hertz_stress(p, half_width, share * peak, poisson, radius)

    def part(y):
        if attached and y > last:
            return at(last, 0.5) if y < length + 0.5 else None
        return at(min(y, last), 1.0)

    return [part(y) for y in points[:, 1]]


def press_bodies(bodies, grid, case, solver, log):
    """Solve the contact of ``bodies`` on ``grid`` under the load of ``case``.

    Leaves the bodies in their final state. Returns the :class:`~edgeline_fem.contact.ContactSolution` and
    the relative error of the supports' reaction, the larger of both bodies.
    """
    radius = case.scales().radius
    # A quarter of the Hertz pressure's load on the whole contact line, pi/2 * 2 S_l.
    load = 0.25 * np.pi * case.roller_half_length()
    for name, body in bodies.items():
        def find(nodes, name=name):
            surface = surface_depth(name, np.minimum(nodes[:, 0], radius), radius)
            numbers = grid.find(nodes)
            return np.where(np.abs(nodes[:, 2] - surface) < 1e-6, numbers, -1)

        body.number_contact_nodes(len(grid), find, lambda x, name=name: surface_slope(name, x, radius))
    flush = case.block_length_m <= case.roller_length_m * (1.0 + 1e-9)
    roller, block = ((1.0 - bodies[n].poisson**2) / bodies[n].young for n in ("roller", "block"))
    gap = bodies["roller"].contact_coordinates(2) - bodies["block"].contact_coordinates(2)
    solution = solve_contact(
        compliance=lambda forces: bodies["block"].press(forces) + bodies["roller"].press(forces),
        gap=gap,
        weights=grid.weights,
        load=load,
        model=half_space_compliance(grid, roller + flush * block, (not flush) * block),
        scale=0.5 / radius,
        tolerance=solver.tolerance,
        max_iterations=solver.max_iterations,
        progress=lambda i, r: log(f"contact iteration {i}, residual {r:.1e}"),
    )
    edge = grid.x[-1]
    if np.any(solution.forces.reshape(grid.shape)[-1] > 0.0):
        raise FemError(
            f"contact reaches the edge of the strip where it is looked for, x = {edge:.3g} C: enlarge "
            "contact_reach in the request's mesh"
        )
    worst = 0.0
    for body in bodies.values():
        body.press(solution.forces)
        worst = max(worst, abs(body.keep() / load - 1.0))
    return solution, worst


def peak_memory(comm):
    """Largest resident memory so far, summed over the ranks (MiB)."""
    kib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return comm.allreduce(kib) / 1024.0


def versions():
    """Versions of everything that a result depends on, and the processor."""
    return {**compat.versions(), "blas": blas(), "python": platform.python_version(),
            "processor": processor()}


def solve_case(request, folder, comm, log):
    """Solve the case meshed in ``folder``; write curves.csv, pressure.csv and, last, fem.json there.

    Returns the content of fem.json. Works on any number of ranks; rank 0 writes.
    """
    began, used_before = time.perf_counter(), processor_seconds()
    folder = Path(folder)
    case, scales = request.case, request.case.scales()
    try:
        meshed = json.loads((folder / "mesh.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise FemError(f"{folder / 'mesh.json'}: run the mesh stage first ({error})") from error
    if comm.rank == 0:
        (folder / "fem.json").unlink(missing_ok=True)
    if meshed["options"] != dataclasses.asdict(request.mesh):
        raise FemError(f"{folder / 'mesh.json'}: was made for other mesh options; run the mesh stage again")

    seconds = {"mesh": sum(meshed["seconds"].values())}
    grid = ContactGrid(meshed["axes_c"]["x_contact"], meshed["axes_c"]["y_contact"])
    bodies, seconds["read"] = build_bodies(comm, folder, request)
    for stage in ("assemble", "factor"):
        seconds[stage] = sum(body.seconds[stage] for body in bodies.values())
    log(f"stiffness assembled in {seconds['assemble']:.1f} s, solvers set up in {seconds['factor']:.1f} s")

    mark = time.perf_counter()
    solution, reaction_error = press_bodies(bodies, grid, case, request.solver, log)
    seconds["contact"] = time.perf_counter() - mark

    mark = time.perf_counter()
    pressure, lumped = grid.pressure(solution.forces), grid.lumped_pressure(solution.forces)
    fields = {"block": bodies["block"].stress_field(),
              "roller": bodies["roller"].stress_field(frame=around_the_arc(scales.radius))}
    seconds["recover"] = time.perf_counter() - mark

    mark = time.perf_counter()
    ends = {"block": case.block_half_length(), "roller": case.roller_half_length()}
    radii = {"block": np.inf, "roller": scales.radius}
    face_errors = {name: {"end": 0.0, "surface": 0.0} for name in bodies}
    curves = io.StringIO()
    writer = csv.writer(curves, lineterminator="\n")
    writer.writerow(CURVE_HEADER)
    for curve in request.curves:
        points = np.array(curve.points_m) / scales.c_m
        inside = points.copy()
        inside[:, 2] += surface_depth(curve.body, points[:, 0], scales.radius)
        poisson, radius = bodies[curve.body].poisson, radii[curve.body]
        steep = steep_parts(points, case, grid, pressure, poisson, radius)
        stress = fields[curve.body].sample(inside, near_singularity(points, case), steep)
        end_error, surface_error = enforce_tractions(
            points, stress, poisson, ends[curve.body], radius, grid.sample(pressure, points[:, :2])
        )
        met = face_errors[curve.body]
        met["end"], met["surface"] = max(met["end"], end_error), max(met["surface"], surface_error)
        derived = np.stack(invariants(stress), axis=1)
        for point, row in zip(curve.points_m, np.hstack([stress, derived]) * scales.p0_pa):
            writer.writerow([curve.body, curve.name, *(f"{v:.9g}" for v in point + list(row))])
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    writer.writerow(PRESSURE_HEADER)
    for line, points in request.pressure_points_m.items():
        at = np.array(points) / scales.c_m
        at_surface = np.column_stack([at, np.zeros(len(at))])
        steep = steep_parts(at_surface, case, grid, pressure, bodies["block"].poisson, np.inf)
        raised = -fields["block"].sample(at_surface, near_singularity(at_surface, case), steep)[:, 2]
        columns = np.stack([grid.sample(pressure, at), grid.sample(lumped, at), raised], axis=1)
        for point, row in zip(points, columns * scales.p0_pa):
            writer.writerow([line, *(f"{v:.9g}" for v in point + list(row))])
    seconds["sample"] = time.perf_counter() - mark
    seconds["total"] = time.perf_counter() - began + seconds["mesh"]

    along = grid.sample(pressure, [(0.0, y) for y in grid.y])
    peak = int(np.argmax(along))
    summary = {
        "schema": 1,
        "case": case.name,
        "versions": {**versions(), "gmsh": meshed["gmsh"]},
        "ranks": comm.size,
        "hertz": {"c_m": scales.c_m, "p0_pa": scales.p0_pa},
        "mesh": {key: meshed[key] for key in ("options", "smallest_c", "bodies")},
        "solver": {**dataclasses.asdict(request.solver), "factorised_by": bodies["block"].factorised_by},
        "boundary_conditions": BOUNDARY_CONDITIONS,
        "unknowns": sum(body["unknowns"] for body in meshed["bodies"].values()),
        "contact_nodes": len(grid),
        "contact_iterations": solution.iterations,
        "compliance_applications": solution.applications,
        "linear_iterations": sum(body.iterations for body in bodies.values()),
        "complementarity_residual": solution.residual,
        "smallest_gap_rel": solution.smallest_gap,
        "load_error_rel": abs(4.0 * float(solution.forces.sum()) / (np.pi * case.roller_half_length()) - 1.0),
        "equilibrium_residual": reaction_error,
        "approach_m": solution.approach * scales.c_m,
        "p_centre_pa": float(along[0]) * scales.p0_pa,
        "p_max_pa": float(along[peak]) * scales.p0_pa,
        "p_max_at_m": [0.0, grid.y[peak] * scales.c_m],
        "traction_error_before_enforcing": face_errors,
        "seconds": {key: round(value, 3) for key, value in seconds.items()},
        "cpu_seconds": round(meshed["cpu_seconds"] + comm.allreduce(processor_seconds() - used_before), 3),
        "peak_memory_mib": round(peak_memory(comm), 1),
    }
    if comm.rank == 0:
        write_atomically(folder / "curves.csv", curves.getvalue())
        write_atomically(folder / "pressure.csv", lines.getvalue())
        write_atomically(folder / "fem.json", json.dumps(summary, indent=1) + "\n")
    return summary
