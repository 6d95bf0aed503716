"""The two-body model of one case: solve the contact, recover stresses, write the results."""

import dataclasses
import json
import resource
import time
from pathlib import Path

import numpy as np

from . import compat
from .contact import (
    ContactGrid, ContactSolution, half_space_compliance, interpolation, solve_contact, with_middles,
)
from .elasticity import Body, load_mesh
from .meshing import processor_seconds, read_summary, write_atomically
from .request import FemError
from .results import CURVE_HEADER, blas, curve_table, machine_versions, table
from .sampling import Sampler
from .scene import BODIES, Scene, surface_depth, surface_slope

PRESSURE_HEADER = ("line", "x_m", "y_m", "p_pa", "p_lumped_pa", "p_stress_pa")


def boundary_conditions(scene):
    """What holds the bodies of a ``scene``, in words."""
    planes = "x = 0 and y = 0: symmetry planes" if scene.symmetric else (
        "x = 0: symmetry plane; one node pinned along y")
    tilt = "" if scene.moment is None else ", that of their moments the load's"
    return {
        "block": f"{planes}; bottom z = block_depth: u_z = 0, free of shear; far side x = block_width, end faces "
        "and surface: free of traction",
        "roller": f"{planes}; mid-plane z = R: u_z uniform (the approach"
        f"{'' if scene.symmetric else ') or linear in y (the tilt'}), free of shear; end faces and surface: free of "
        "traction",
        "contact": "frictionless; nodal gaps along z, at fixed x, are never negative, nodal forces are normal to "
        f"the unloaded surfaces and never pull, the sum of their z components is the load{tilt}",
        **({} if not scene.friction else {
            "sliding": "a second solve of each body under tractions of friction times the nodal forces, along the "
            "surface; x = 0: plane of antisymmetry (u_y = u_z = 0); bottom and mid-plane: u_x = u_z = 0",
        }),
    }


def build_bodies(comm, folder, request, y_contact, plane_strain=False, sliding=False):
    """Both bodies as ``{"block": Body, "roller": Body}`` from the meshes in ``folder``.

    ``y_contact``: the meshes' element boundaries along the overlap. ``plane_strain`` also holds the end faces
    along y. ``sliding``: x = 0 is the plane of antisymmetry of what friction does, and the supports hold along x as well. Returns the
    bodies and the seconds spent reading.
    """
    case, scene = request.case, Scene.of(request.case)
    scales = case.scales()
    supports = {"block": request.mesh.block_depth, "roller": scales.radius}
    bodies, seconds = {}, 0.0
    for name in BODIES:
        began = time.perf_counter()
        domain = load_mesh(comm, Path(folder) / f"{name}.msh")
        seconds += time.perf_counter() - began
        material = getattr(case, name)

        def on(axis, value, tolerance=1e-7 * supports[name]):
            return lambda x: np.abs(x[axis] - value) < tolerance

        support = on(2, supports[name])
        fixed = [(0, on(0, 0.0)), (2, support)]
        if sliding:
            fixed = [(1, on(0, 0.0)), (2, on(0, 0.0)), (0, support), (2, support)]
        pinned = []
        if scene.symmetric:
            fixed.insert(1, (1, on(1, 0.0)))
        elif not sliding:
            middle = y_contact[len(y_contact) // 2]
            pinned.append((1, lambda x: on(0, 0.0)(x) & on(1, middle)(x) & on(2, supports[name])(x)))
        if plane_strain:
            fixed += [(1, on(1, end)) for end in scene.free_ends(name)]
        bodies[name] = Body(
            domain, material.young_pa / scales.p0_pa, material.poisson, fixed,
            request.solver.linear, request.solver.linear_tolerance, pinned,
        )
    return bodies, seconds


def far_slope(block, grid, z_nodes, radius):
    """Slope along y of the block's sinking on the line x = 0 one ``radius`` below its surface.

    Least squares over the overlap, of the last solve. ``z_nodes``: the block's element boundaries. The tilt between
    the far supports is larger than that of the lines by it: the roller's line lies on its support.
    """
    z = with_middles(np.asarray(z_nodes))
    first = min(2 * max(np.searchsorted(z[::2], radius) - 1, 0), len(z) - 3)
    weights = interpolation(z, [radius])[0, first : first + 3]
    sinking = sum(
        weight * block.displacement_at(2, np.array([(0.0, y, depth) for y in grid.y]))
        for weight, depth in zip(weights, z[first : first + 3])
    )
    return np.polyfit(grid.y, sinking, 1, w=np.sqrt(grid.lengths))[0]


@dataclasses.dataclass(frozen=True)
class Pressed:
    """A solved contact: its :class:`~edgeline_fem.contact.ContactSolution`, the ``tilt`` between the lines
    x = 0 one roller radius below both surfaces, and the relative error of the supports' reactions, the larger of both
    bodies."""

    solution: ContactSolution
    tilt: float
    reaction_error: float


def drag_bodies(bodies, grid, scene, forces):
    """Leave ``bodies``, built for sliding, in their state under the scene's friction and the nodal ``forces``.

    Tractions are those of pressures, along the surface: towards +x on the block, towards -x on the roller. Returns
    the relative error of the supports' reactions, the larger of both bodies.
    """
    _number_contact(bodies, grid, scene.radius)
    errors = []
    for name, towards in (("block", 1.0), ("roller", -1.0)):
        bodies[name].drag(towards * scene.friction * forces)
        errors.append(abs(towards * bodies[name].keep(0) / (scene.friction * scene.load) - 1.0))
    return max(errors)


def _number_contact(bodies, grid, radius):
    for name, body in bodies.items():
        def find(nodes, name=name):
            surface = surface_depth(name, np.minimum(nodes[:, 0], radius), radius)
            numbers = grid.find(nodes)
            return np.where(np.abs(nodes[:, 2] - surface) < 1e-6, numbers, -1)

        body.number_contact_nodes(len(grid), find, lambda x, name=name: surface_slope(name, x, radius))


def press_bodies(bodies, grid, scene, solver, log, z_nodes=None):
    """Solve the contact of ``bodies`` on ``grid`` in a ``scene``, and leave them in their final state.

    ``z_nodes``: the block's element boundaries in depth, which tilts are measured with; a symmetric scene does
    without. Returns the :class:`Pressed`.
    """
    radius = scene.radius
    _number_contact(bodies, grid, radius)
    softness = {name: (1.0 - body.poisson**2) / body.young for name, body in bodies.items()}
    model = half_space_compliance(grid, sum(softness.values()), [
        (end.y, sum(softness[name] for name in BODIES if not end.goes_on(name))) for end in scene.ends
    ])
    y = np.tile(grid.y, grid.shape[0])
    gap = bodies["roller"].contact_coordinates(2) - bodies["block"].contact_coordinates(2) + scene.drop(y)
    rows, wanted = [np.ones(len(grid))], [scene.load]
    if scene.moment is not None:
        rows.append(y)
        wanted.append(scene.moment)

    def press(held):
        """The contact between supports held at a tilt; its solution, and the slope of the block's far line."""
        solution = solve_contact(
            compliance=lambda forces: bodies["block"].press(forces) + bodies["roller"].press(forces),
            gap=gap - held * y,
            weights=grid.weights,
            constraints=np.array(rows),
            wanted=np.array(wanted),
            model=model,
            scale=0.5 / radius,
            tolerance=solver.tolerance,
            max_iterations=solver.max_iterations,
            progress=lambda i, r: log(f"contact iteration {i}, residual {r:.1e}"),
        )
        for body in bodies.values():
            body.press(solution.forces)
        return solution, 0.0 if scene.symmetric else far_slope(bodies["block"], grid, z_nodes, radius)

    if scene.symmetric or scene.moment is not None:
        solution, slope = press(0.0)
        tilt = 0.0 if scene.symmetric else solution.multipliers[1] - slope
    else:
        solution, tilt = _hold(press, scene, solver.tolerance)
    if np.any(solution.forces.reshape(grid.shape)[-1] > 0.0):
        raise FemError(
            f"contact reaches the edge of the strip where it is looked for, x = {grid.x[-1]:.3g} C: enlarge "
            "contact_reach in the request's mesh"
        )
    worst = max(abs(body.keep() / scene.load - 1.0) for body in bodies.values())
    return Pressed(solution, tilt, worst)


def _hold(press, scene, tolerance):
    """The contact whose far lines are held at the scene's tilt, by a secant on that of the supports.

    Returns the solution and the tilt.
    """
    held, previous = scene.tilt, None
    enough = 10.0 * tolerance * 0.5 / (scene.radius * (scene.stop - scene.start))
    for _ in range(12):
        solution, slope = press(held)
        missing = held - slope - scene.tilt
        if abs(missing) <= enough:
            return solution, held - slope
        rate = 1.0 if previous is None else (missing - previous[1]) / (held - previous[0])
        previous = held, missing
        held -= missing / rate
    raise FemError(f"no tilt of the supports was found that holds tilt_rad = {scene.tilt:g}")


def peak_memory(comm):
    """Largest resident memory so far, summed over the ranks (MiB)."""
    return comm.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) / 1024.0


def versions():
    """Versions of everything that a result depends on, and the processor."""
    return {**compat.versions(), "blas": blas(), **machine_versions()}


def _pressures(request, sampler):
    """The text of pressure.csv."""
    scales, rows = request.case.scales(), []
    for line, points in request.pressure_points_m.items():
        values = sampler.pressures(np.array(points) / scales.c_m) * scales.p0_pa
        rows += [((line,), point + list(row)) for point, row in zip(points, values)]
    return table(PRESSURE_HEADER, rows)


def _contact_summary(scene, bodies, grid, pressed, sampler, scales):
    """What fem.json says of the contact."""
    solution = pressed.solution
    along = sampler.pressure([(0.0, y) for y in grid.y])
    peak = int(np.argmax(along))
    summary = {
        "contact_nodes": len(grid),
        "contact_iterations": solution.iterations,
        "compliance_applications": solution.applications,
        "linear_iterations": sum(body.iterations for body in bodies.values()),
        "complementarity_residual": solution.residual,
        "smallest_gap_rel": solution.smallest_gap,
        "load_error_rel": abs(float(solution.forces.sum()) / scene.load - 1.0),
        "equilibrium_residual": pressed.reaction_error,
        "approach_m": solution.approach * scales.c_m,
        "p_centre_pa": float(sampler.pressure([(0.0, scene.middle)])[0]) * scales.p0_pa,
        "p_max_pa": float(along[peak]) * scales.p0_pa,
        "p_max_at_m": [0.0, float(grid.y[peak]) * scales.c_m],
    }
    if not scene.symmetric:
        arm = float(solution.forces @ np.tile(grid.y, grid.shape[0])) / scene.load
        summary["tilt_rad"] = float(pressed.tilt)
        summary["centre_of_pressure_m"] = [0.0, arm * scales.c_m]
    return summary


def solve_case(request, folder, comm, log):
    """Solve the case meshed in ``folder``; write curves.csv, pressure.csv and, last, fem.json there.

    Returns the content of fem.json. Works on any number of ranks; rank 0 writes.
    """
    began, used_before = time.perf_counter(), processor_seconds()
    folder = Path(folder)
    case, scales = request.case, request.case.scales()
    meshed = read_summary(folder)
    if comm.rank == 0:
        (folder / "fem.json").unlink(missing_ok=True)
    if (meshed["options"], meshed["contact_ends_c"]) != (dataclasses.asdict(request.mesh), request.tips()):
        raise FemError(f"{folder / 'mesh.json'}: was made for other mesh options; run the mesh stage again")

    seconds = {"mesh": sum(meshed["seconds"].values())}
    scene, axes = Scene.of(case), meshed["axes_c"]
    grid = ContactGrid(axes["x_contact"], axes["y_contact"], scene.symmetric)
    bodies, seconds["read"] = build_bodies(comm, folder, request, axes["y_contact"])
    for stage in ("assemble", "factor"):
        seconds[stage] = sum(body.seconds[stage] for body in bodies.values())
    log(f"stiffness assembled in {seconds['assemble']:.1f} s, solvers set up in {seconds['factor']:.1f} s")

    mark = time.perf_counter()
    pressed = press_bodies(bodies, grid, scene, request.solver, log, axes["z_block"])
    seconds["contact"] = time.perf_counter() - mark

    dragged = None
    if scene.friction:
        mark = time.perf_counter()
        for body in bodies.values():
            body.forget_solver()
        dragged, _ = build_bodies(comm, folder, request, axes["y_contact"], sliding=True)
        error = drag_bodies(dragged, grid, scene, pressed.solution.forces)
        pressed = dataclasses.replace(pressed, reaction_error=max(pressed.reaction_error, error))
        for body in dragged.values():
            body.forget_solver()
        seconds["drag"] = time.perf_counter() - mark
        log(f"tractions along x solved in {seconds['drag']:.1f} s")

    mark = time.perf_counter()
    sampler = Sampler(scene, bodies, grid, pressed.solution.forces, dragged)
    seconds["recover"] = time.perf_counter() - mark

    mark = time.perf_counter()
    tables = {"curves.csv": table(CURVE_HEADER, curve_table(request, sampler)), "pressure.csv": _pressures(request, sampler)}
    seconds["sample"] = time.perf_counter() - mark
    seconds["total"] = time.perf_counter() - began + seconds["mesh"]

    summary = {
        "schema": 1,
        "case": case.name,
        "versions": {**versions(), "gmsh": meshed["gmsh"]},
        "ranks": comm.size,
        "hertz": {"c_m": scales.c_m, "p0_pa": scales.p0_pa},
        "mesh": {key: meshed[key] for key in ("options", "contact_ends_c", "smallest_c", "bodies")},
        "solver": {**dataclasses.asdict(request.solver), "factorised_by": bodies["block"].factorised_by},
        "boundary_conditions": boundary_conditions(scene),
        "unknowns": sum(body["unknowns"] for body in meshed["bodies"].values()),
        **_contact_summary(scene, bodies, grid, pressed, sampler, scales),
        "traction_error_before_enforcing": sampler.face_errors,
        "seconds": {key: round(value, 3) for key, value in seconds.items()},
        "cpu_seconds": round(meshed["cpu_seconds"] + comm.allreduce(processor_seconds() - used_before), 3),
        "peak_memory_mib": round(peak_memory(comm), 1),
    }
    if comm.rank == 0:
        for name, text in tables.items():
            write_atomically(folder / name, text)
        write_atomically(folder / "fem.json", json.dumps(summary, indent=1) + "\n")
    return summary
