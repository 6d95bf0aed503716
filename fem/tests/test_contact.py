"""The contact: grid, solver, Hertz's line contact in plane strain, and a live finite contact."""

import csv
import json
import math

import numpy as np
import pytest
from mpi4py import MPI

from conftest import FEM, run_stage, steel_case
from edgeline_fem.contact import ContactGrid, half_space_compliance, solve_contact
from edgeline_fem.meshing import make_axes, make_meshes
from edgeline_fem.model import build_bodies, press_bodies
from edgeline_fem.record import standard_request
from edgeline_fem.request import FemError, MeshOptions
from edgeline_fem.scene import Scene, surface_depth


def silent(*_):
    """A log that nobody reads."""


def test_grid_recovers_smooth_pressures():
    grid = ContactGrid([0.0, 0.2, 0.5, 1.0], [0.0, 1.0, 1.5])
    assert grid.weights.sum() == pytest.approx(1.5, rel=1e-12)
    assert np.all(grid.weights > 0.0)
    assert grid.gauss_x[:2] == pytest.approx([0.1 - 0.1 / math.sqrt(3.0), 0.1 + 0.1 / math.sqrt(3.0)])

    def smooth(x, y):
        return np.cos(0.8 * x)[:, None] * (1.0 - 0.3 * y**2)

    forces = (grid._mass_x @ smooth(grid.x, grid.y) @ grid._mass_y).ravel()
    expected = smooth(grid.gauss_x, grid.gauss_y)
    error = np.abs(grid.pressure(forces) - expected).max()
    assert error < 0.6 * np.abs(grid.lumped_pressure(forces) - expected).max()
    found = grid.find(np.array([[0.35, 1.25, 0.0], [0.2, 1.0, 0.0], [0.3, 1.0, 0.0]]))
    assert found.tolist() == [3 * 5 + 3, 2 * 5 + 2, -1]


def test_grid_does_not_see_what_corner_nodes_carry_too_much():
    grid = ContactGrid(np.linspace(0.0, 1.0, 6), [0.0, 1.0])
    nodal = np.ones(grid.shape)
    nodal[0::2] += 0.02
    nodal[1::2] -= 0.01
    forces = (grid._mass_x @ nodal @ grid._mass_y).ravel()
    assert grid.pressure(forces) == pytest.approx(np.ones((10, 2)), abs=1e-12)


def test_grid_samples_a_hertz_pressure_up_to_its_edge():
    """The square of a Hertz pressure is quadratic, so its samples are exact, between points as well.

    Wrong values next to the edge, as a cut element has them, do not matter.
    """
    grid = ContactGrid(np.linspace(0.0, 1.5, 16), [0.0, 1.0])
    pressure = np.sqrt(np.maximum(0.0, 1.02**2 - grid.gauss_x**2))[:, None] * np.ones(len(grid.gauss_y))
    pressure[(grid.gauss_x > 0.9) & (grid.gauss_x < 1.1)] *= 1.05
    points = [(0.3, 0.7), (0.83, 0.2), (0.95, 0.1), (1.0, 1.0), (1.04, 0.0), (1.7, 0.5)]
    expected = [math.sqrt(max(0.0, 1.02**2 - x * x)) for x, _ in points]
    assert grid.sample(pressure, points) == pytest.approx(expected, abs=1e-7)
    assert grid.hertz_at(pressure, 0.4) == pytest.approx((1.02, 1.02), abs=1e-9)


def test_the_half_space_model_is_love_in_the_mean():
    """One cell far from all others: the model's entry against the closed form at its centre."""
    grid = ContactGrid([0.0, 0.1, 0.2], [0.0, 0.1, 0.2])
    model = half_space_compliance(grid, 1.0, [])
    assert model == pytest.approx(model.T, rel=1e-12)
    assert np.linalg.eigvalsh(model).min() > 0.0
    # Corner to corner, with the images of both planes: 1 / (pi r) at sqrt(x^2 + y^2) from all four.
    assert model[-1, 0] == pytest.approx(4.0 / (math.pi * math.hypot(0.2, 0.2)), rel=0.05)


def test_contact_solver_on_a_small_dense_problem():
    """Against the optimality conditions: gap >= 0, force >= 0, one of them zero, load exact."""
    rng = np.random.default_rng(1)
    root = rng.normal(size=(30, 30))
    compliance = root @ root.T / 30.0 + np.eye(30)
    gap = np.linspace(0.0, 2.0, 30) ** 2
    weights = rng.uniform(0.5, 1.5, 30)
    model = np.diag(np.diag(compliance))
    one = (np.ones((1, 30)), np.ones(1))
    found = solve_contact(lambda f: compliance @ f, gap, weights, *one, model, 1.0, 1e-10, 200, silent)
    left = compliance @ found.forces + gap - found.approach
    assert found.forces.sum() == pytest.approx(1.0, rel=1e-12)
    assert found.forces.min() >= 0.0 and left.min() >= -1e-9
    assert np.abs(left * found.forces).max() < 1e-9
    with pytest.raises(FemError, match="did not converge in 2 iterations"):
        solve_contact(lambda f: compliance @ f, gap, weights, *one, model, 1.0, 1e-10, 2, silent)


def plane_slice(load_factor, folder):
    """A slice of unit length in plane strain: its bodies, contact grid, contact solution, reaction error."""
    case = steel_case(load_factor, 0.5, 1.0)
    request = standard_request(case, 1.0, end=1.0, free_end=1.0)
    meshed = make_meshes(request, folder)
    grid = ContactGrid(meshed["axes_c"]["x_contact"], meshed["axes_c"]["y_contact"])
    bodies, _ = build_bodies(MPI.COMM_SELF, folder, request, meshed["axes_c"]["y_contact"], plane_strain=True)
    pressed = press_bodies(bodies, grid, Scene.of(case), request.solver, silent)
    return bodies, grid, pressed.solution, pressed.reaction_error


def test_hertz_line_contact(tmp_path):
    """A slice in plane strain: peak pressure and half-width within half a percent, stresses too."""
    bodies, grid, solution, reaction_error = plane_slice(2e-5, tmp_path)
    assert solution.forces.sum() == pytest.approx(math.pi * 0.5 / 4.0, rel=1e-12)
    assert reaction_error < 1e-8
    assert solution.smallest_gap > -1e-7

    pressure = grid.pressure(solution.forces)
    assert grid.sample(pressure, [(0.0, 0.0), (0.0, 0.5)]) == pytest.approx(1.0, abs=5e-3)
    # The element that the edge cuts magnifies what the solver leaves.
    assert np.abs(pressure - pressure[:, :1]).max() < 5e-6
    # p^2 = p0^2 (1 - x^2 / a^2): the half-width from a straight line through the contact's inside.
    inside = pressure[:, 0] > 0.3
    slope, level = np.polyfit(grid.gauss_x[inside] ** 2, pressure[inside, 0] ** 2, 1)
    assert math.sqrt(-level / slope) == pytest.approx(1.0, abs=5e-3)
    assert grid.hertz_at(pressure, 0.2) == pytest.approx((1.0, 1.0), abs=5e-3)

    z = np.array([0.2, 0.5, 0.78, 1.0, 2.0])
    s = np.sqrt(1.0 + z**2)
    # Johnson, Contact Mechanics, 1985, Eq. 4.45.
    xx, zz = -((1.0 + 2.0 * z**2) / s - 2.0 * z), -1.0 / s
    for body in bodies.values():
        found = body.stress_field().sample([(0.0, 0.2, v) for v in z])
        assert found[:, 2] == pytest.approx(zz, abs=5e-3)
        assert found[:, 0] == pytest.approx(xx, abs=5e-3)
        assert found[:, 1] == pytest.approx(0.3 * (xx + zz), abs=5e-3)


@pytest.fixture(scope="module")
def round_slice(tmp_path_factory):
    """A slice under a roller of 28 C, as :func:`plane_slice` has it."""
    return plane_slice(1e-3, tmp_path_factory.mktemp("slice"))


def half_plane(x, z):
    """xx, zz, xz under a Hertz pressure, from line loads (Johnson, Contact Mechanics, 1985, Eqs. 2.23)."""
    angles = (np.arange(4000) + 0.5) * math.pi / 4000
    s, load = np.cos(angles), np.sin(angles) ** 2 * math.pi / 4000
    r4 = ((x - s) ** 2 + z**2) ** 2
    return [-2.0 / math.pi * np.sum(load * part / r4) for part in ((x - s) ** 2 * z, z**3, (x - s) * z**2)]


def disc(radius, x, depth):
    """xx, zz, xz of a disc under opposite Hertz pressures, ``depth`` below its surface at ``x``.

    Every load causes the radial field of a half-plane behind its own tangent, and a uniform tension takes the
    normal traction off the circumference (Timoshenko and Goodier, Theory of Elasticity, 1970, article 41).
    """
    angles = (np.arange(4000) + 0.5) * math.pi / 4000
    s, load = np.cos(angles), np.sin(angles) ** 2 * math.pi / 4000
    z = radius - math.sqrt(radius**2 - x**2) + depth
    total = np.zeros(3)
    for side in (1.0, -1.0):
        sine, cosine = np.sin(s / radius), side * np.cos(s / radius)
        along, down = x - radius * sine, z - radius + radius * cosine
        radial = -2.0 / math.pi * load * (cosine * down - sine * along) / (along**2 + down**2) ** 2
        total += [np.sum(radial * part) for part in (along**2, down**2, along * down)]
    tension = load.sum() / (math.pi * radius)
    return total + [tension, tension, 0.0]


@pytest.mark.parametrize("x", [0.7, 1.4])
def test_stresses_off_the_plane_of_symmetry(round_slice, x):
    """Depth profiles beside the contact's middle: a half-plane's in the block, a whole disc's in the roller.

    Depths run from the surface at x, tensors stand in the fixed axes. What depth and axes along the surface's
    normal there would change is 0.02 p0.
    """
    bodies, _, _, _ = round_slice
    radius = steel_case(1e-3, 0.5, 1.0).scales().radius
    z = np.array([0.1, 0.3, 0.6, 1.0, 2.0, 4.0])
    expected = {"block": [half_plane(x, v) for v in z], "roller": [disc(radius, x, v) for v in z]}
    for name, body in bodies.items():
        points = [(x, 0.2, v + surface_depth(name, x, radius)) for v in z]
        xx, yy, zz, xy, xz, yz = body.stress_field().sample(points).T
        assert np.stack([xx, zz, xz], axis=1) == pytest.approx(np.array(expected[name]), abs=5e-3), name
        assert yy == pytest.approx(0.3 * (xx + zz), abs=5e-3), name
        assert np.abs([xy, yz]).max() < 1e-4, name


def test_the_contact_presses_along_the_rollers_normal(round_slice):
    """A roller of 28 C: its tilted surface carries the pressure, and no shear to 0.2 % of p0.

    Forces along z alone would leave a shear of p x / R, 0.019 p0 at x = 0.75.
    """
    bodies, grid, solution, reaction_error = round_slice
    assert reaction_error < 1e-8
    radius = steel_case(1e-3, 0.5, 1.0).scales().radius
    x = np.array([0.25, 0.5, 0.75])
    depth = surface_depth("roller", x, radius)
    xx, _, zz, _, xz, _ = bodies["roller"].stress_field().sample(np.stack([x, 0.2 + 0.0 * x, depth], axis=1)).T
    sine = x / radius
    cosine = np.sqrt(1.0 - sine**2)
    shear = (zz - xx) * sine * cosine + xz * (cosine**2 - sine**2)
    normal = xx * sine**2 - 2.0 * xz * sine * cosine + zz * cosine**2
    assert np.abs(shear).max() < 2e-3
    pressure = grid.sample(grid.pressure(solution.forces), [(v, 0.2) for v in x])
    assert -normal == pytest.approx(pressure, abs=5e-3)
    # The contact is Hertz's but for terms of order C / R.
    assert pressure == pytest.approx(np.sqrt(1.0 - x**2), abs=5e-3)

    # Force and sinking are conjugate.
    one, other = np.random.default_rng(2).uniform(size=(2, len(grid)))
    press = bodies["roller"].press
    assert one @ press(other) == pytest.approx(other @ press(one), rel=1e-9)


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_live_contact(live):
    """A coarse flush contact through the command line: balance, level, symmetry, shape of the files."""
    case, _, folder = live
    scales = case.scales()
    summary = json.loads((folder / "fem.json").read_text())
    assert summary["equilibrium_residual"] < 1e-8
    assert summary["load_error_rel"] < 1e-12
    assert summary["complementarity_residual"] <= 1e-8
    assert summary["smallest_gap_rel"] > -1e-7
    # An independent calculation gives 1.023 p0 in the middle and 0.735 p0 at 0.1 C from the end.
    assert summary["p_centre_pa"] / scales.p0_pa == pytest.approx(1.023, rel=0.02)
    pressure = {float(r["y_m"]) / scales.c_m: float(r["p_pa"]) / scales.p0_pa
                for r in rows(folder / "pressure.csv") if r["line"] == "along-y"}
    assert min(pressure.values()) > 0.4
    at = min(pressure, key=lambda y: abs(y - 4.9))
    assert pressure[at] == pytest.approx(0.735, abs=0.03)
    curves = rows(folder / "curves.csv")
    assert len(curves) == 2 * (20 + 35 + 9 * 50 + 2 * 20)
    for row in curves:
        if row["curve"] == "depth-end":
            assert abs(float(row["sigma_yy_pa"])) < 1e-9 * scales.p0_pa
        if row["curve"] == "surface-along-y":
            nearest = min(pressure, key=lambda y, row=row: abs(y - float(row["y_m"]) / scales.c_m))
            assert -float(row["sigma_zz_pa"]) / scales.p0_pa == pytest.approx(pressure[nearest], abs=0.02)
    # Like materials and nearly like shapes: the two bodies' stresses differ by the roller's roundness.
    both = [[float(r["von_mises_pa"]) / scales.p0_pa for r in curves
             if r["body"] == body and r["curve"] == "along-y-0.78C"] for body in ("block", "roller")]
    assert both[0] == pytest.approx(both[1], abs=0.03)


def test_recorded_value_is_met_live(tmp_path):
    """A coarse live run of a recorded case against its production mesh: 3 % in the middle."""
    record = json.loads((FEM.parent / "results/reference/w1e-3_sl5_lr1/record.json").read_text())
    request = tmp_path / "request.json"
    request.write_text(json.dumps(standard_request(steel_case(1e-3, 5.0, 1.0), 2.0).to_json()))
    for stage in ("mesh", "solve"):
        assert run_stage(stage, request, tmp_path).returncode == 0
    found = json.loads((tmp_path / "fem.json").read_text())
    assert found["p_centre_pa"] == pytest.approx(record["meshes"]["1"]["p_centre_pa"], rel=0.03)
    assert found["equilibrium_residual"] < 1e-6


def deviation(one, other, p0_pa):
    """Largest difference between two folders' curves and pressures (units of p0)."""
    worst = 0.0
    for name in ("curves.csv", "pressure.csv"):
        for a, b in zip(rows(one / name), rows(other / name), strict=True):
            worst = max([worst, *(abs(float(a[k]) - float(b[k])) / p0_pa for k in a if k.endswith("_pa"))])
    return worst


@pytest.mark.parametrize(
    ("linear", "ranks"),
    [("direct", 2), ("iterative", 1), pytest.param("iterative", 2, marks=pytest.mark.slow)],
)
def test_solvers_and_ranks_agree(small, tmp_path, linear, ranks):
    """Iterative against direct, two ranks against one: the same curves to 1e-6 p0."""
    case, request, reference = small
    data = json.loads(request.read_text())
    data["solver"]["linear"] = linear
    changed = tmp_path / "request.json"
    changed.write_text(json.dumps(data))
    assert run_stage("mesh", changed, tmp_path).returncode == 0
    done = run_stage("solve", changed, tmp_path, ranks)
    assert done.returncode == 0, done.stderr
    assert json.loads((tmp_path / "fem.json").read_text())["ranks"] == ranks
    assert deviation(reference, tmp_path, case.scales().p0_pa) < 1e-6


def farther(case, size, option, axis):
    """A far boundary that adds one element to ``axis`` and leaves the rest of the mesh as it is.

    Regrading alone moves nodes near the contact, which would hide the boundary's own small influence.
    """
    base = getattr(make_axes(case, MeshOptions(size=size)), axis)
    near = len(base) // 2
    low, high = 640.0, 640.0 * 4096.0
    for _ in range(60):
        middle = math.sqrt(low * high)
        nodes = getattr(make_axes(case, MeshOptions(size=size, **{option: middle})), axis)
        closer = len(nodes) == len(base) + 1 and nodes[near] < base[near]
        low, high = (middle, high) if len(nodes) <= len(base) or closer else (low, middle)
    return low


@pytest.mark.slow
def test_far_boundaries_do_not_matter(tmp_path):
    """A block more than twice as wide, or as deep, changes no curve by more than 0.5 % of p0."""
    case = steel_case(5e-4, 5.0, 1.0)
    variants = {
        "as-is": {},
        "wide": {"block_width": farther(case, 2.0, "block_width", "x")},
        "deep": {"block_depth": farther(case, 2.0, "block_depth", "z")},
    }
    for name, far in variants.items():
        assert all(value > 1280.0 for value in far.values())
        folder = tmp_path / name
        folder.mkdir()
        request = folder / "request.json"
        request.write_text(json.dumps(standard_request(case, 2.0, **far).to_json()))
        for stage in ("mesh", "solve"):
            done = run_stage(stage, request, folder)
            assert done.returncode == 0, done.stderr
    for name in ("wide", "deep"):
        assert deviation(tmp_path / "as-is", tmp_path / name, case.scales().p0_pa) < 5e-3
