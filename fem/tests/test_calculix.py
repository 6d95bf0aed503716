"""The deck, its bricks, and CalculiX: alone, against the other engine, and failing in every way there is."""

import csv
import dataclasses
import json
import re
import shutil

import numpy as np
import pytest

from conftest import run_stage, steel_case
from edgeline_fem.bricks import FACES
from edgeline_fem.calculix import apply_forces, ending_surface, matching, read_dat, sampler
from edgeline_fem.contact import ContactGrid
from edgeline_fem.deck import FILES, SLIP, check_scene, estimated_approach, write_deck
from edgeline_fem.meshing import make_meshes
from edgeline_fem.points import near_the_contact, write_points
from edgeline_fem.record import standard_request
from edgeline_fem.request import FemError, parse_request
from edgeline_fem.scene import Scene

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")


@pytest.fixture(scope="module")
def deck(tmp_path_factory):
    """A coarse deck: (request, folder, bodies, meshed)."""
    folder = tmp_path_factory.mktemp("deck")
    request = dataclasses.replace(standard_request(steel_case(1e-3, 3.0, 0.75), 4.0), engine="calculix")
    make_meshes(request, folder)
    return request, folder, *write_deck(request, folder)


def test_bricks_hold_a_uniform_stress_in_balance(deck):
    """Inner nodes carry nothing; those of a face carry its traction times its area."""
    _, _, bodies, _ = deck
    block = bodies["block"]
    stress = np.tile([1.0, -2.0, 3.0, 0.5, -0.4, 0.3], (len(block.cells), 8, 1))
    forces = block.nodal_forces(stress)
    low, high = block.points.min(axis=0), block.points.max(axis=0)
    inner = np.all((block.points > low + 1e-6) & (block.points < high - 1e-6), axis=1)
    assert np.abs(forces[inner]).max() < 1e-9 * np.abs(forces).max()
    side, bottom = block.sets["symmetry_x"], block.sets["support"]
    areas = np.prod(np.delete(high - low, 0)), np.prod(np.delete(high - low, 2))
    outer = np.flatnonzero(block.points[:, 0] > high[0] - 1e-6)
    # A face's own part of the forces on its edges cancels between opposite faces.
    assert np.isclose(forces[outer, 0].sum() - forces[side, 0].sum(), 2.0 * areas[0])
    assert len(bottom) and np.isclose(forces.sum(axis=0), 0.0, atol=1e-6 * np.abs(forces).max()).all()


def test_pressures_and_their_forces_belong_together(deck):
    request, _, bodies, meshed = deck
    surface = bodies["roller"].surface
    grid = ContactGrid(meshed["axes_c"]["x_contact"], meshed["axes_c"]["y_contact"], True)
    x, y = np.meshgrid(grid.gauss_x, grid.gauss_y, indexing="ij")
    wanted = 1.0 - 0.3 * x**2 + 0.1 * x * y
    forces = surface.forces(wanted, grid)
    # Corner nodes of such rectangles are pulled by a uniform pressure, which is why none is bounded.
    assert forces.min() < 0.0
    area = np.prod(np.ptp(surface.places, axis=0))
    assert np.isclose(surface.forces(np.ones_like(wanted), grid).sum(), area)
    assert np.abs(surface.pressure(forces, grid) - wanted).max() < 0.02
    ones = surface.pressure(surface.forces(np.ones_like(wanted), grid), grid)
    assert np.abs(ones - 1.0).max() < 1e-9
    # The block goes on: what the roller's end may slide onto carries nothing under this pressure.
    block = bodies["block"].surface
    beyond = block.places[:, 1] > surface.places[:, 1].max() + 1e-6
    assert beyond.any() and not block.forces(wanted, grid)[beyond].any()
    assert np.isclose(block.forces(wanted, grid).sum(), forces.sum())
    assert np.abs(block.places[matching(surface, block)] - surface.places).max() < 1e-4
    assert ending_surface(bodies, Scene.of(request.case))[0] == "roller"


def test_a_deck_is_whole_and_says_what_it_is(deck):
    request, folder, bodies, _ = deck
    texts = {name: (folder / name).read_text() for name in FILES}
    model, mesh = texts["model.inp"], texts["mesh.inp"]
    for words in ("*INCLUDE, INPUT=mesh.inp", "TYPE=SURFACE TO SURFACE", "ROLLER_CONTACT, BLOCK_CONTACT",
                  "*BOUNDARY, OP=NEW", "PUSHED, 3,", "*EL PRINT, ELSET=ROLLER", "** "):
        assert words in model, words
    load = float(re.search(r"\*CLOAD\nPUSHED, 3, (\S+)", model).group(1))
    assert np.isclose(load, 0.25 * request.case.force_n)
    nodes = sum(len(body.points) for body in bodies.values())
    rows = re.findall(r"^\d+, -?\d\.\d+e", mesh, flags=re.M)
    assert len(rows) == nodes
    for name in ("BLOCK_SUPPORT", "ROLLER_SYMMETRY_X", "PUSHED"):
        assert f"NSET={name}" in mesh
    assert all(len(line) <= 256 for text in (model, mesh) for line in text.splitlines())
    for body in bodies.values():
        # Right-handed elements, and contact faces that look at the other body.
        assert body.nodal_forces(np.ones((len(body.cells), 8, 6))).shape == body.points.shape
        assert max(face for _, face in body.faces) < len(FACES)
    # The roller ends with the contact; of the block a little more may be touched.
    ends = {name: body.surface.places[:, 1].max() for name, body in bodies.items()}
    assert np.isclose(ends["roller"], 3.0) and 3.0 < ends["block"] <= 3.0 + SLIP
    assert estimated_approach(request.case, 640.0) > 0.0


def test_scenes_that_the_deck_does_not_hold_are_refused():
    case = steel_case(1e-3, 3.0, 0.75)
    profile = ((-case.roller_length_m / 2, 1e-6), (0.0, 0.0), (case.roller_length_m / 2, 1e-6))
    for changed, wanted in (
        ({"eccentricity_m": 0.0}, "symmetric"), ({"tilt_rad": 1e-4}, "symmetric"), ({"offset_m": 1e-4}, "symmetric"),
        ({"roller_profile_m": profile}, "straight generatrices"), ({"friction": 0.1}, "frictionless"),
    ):
        with pytest.raises(FemError, match=wanted):
            check_scene(dataclasses.replace(case, **changed))
    asked = standard_request(case, 4.0).to_json()
    with pytest.raises(FemError, match="'engine' must be one of fenicsx, calculix"):
        parse_request({**asked, "engine": "ansys"})
    with pytest.raises(FemError, match="'ccx' must be the name"):
        parse_request({**asked, "engine": "calculix", "ccx": ""})





def _failing(folder, deck, script):
    """The solve stage with a shell script for ccx that knows its version."""
    request, meshes, _, _ = deck
    shutil.copytree(meshes, folder / "out")
    ccx = folder / "ccx"
    ccx.write_text(f'#!/bin/sh\n[ "$1" = -v ] && {{ echo "This is Version 2.20"; exit 0; }}\n{script}\n')
    ccx.chmod(0o755)
    (folder / "request.json").write_text(json.dumps({**request.to_json(), "ccx": str(ccx)}))
    return run_stage("solve", folder / "request.json", folder / "out")


HEAD = "' stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set BLOCK and time  0.2E+01\\n\\n'"


@pytest.mark.parametrize(("script", "wanted"), [
    ("echo no licence >&2; exit 3", "(exit code 3): no licence"),
    ("kill -9 $$", "was killed by signal 9"),
    ("echo '*ERROR: solution seems to diverge'; exit 201", "did not converge: try another --size"),
    ("echo ' *ERROR in u_calloc: out of memory'", "out of memory"),
    ("exit 0", "ended without finishing model.inp"),
    ("echo Job finished", "left no model.dat"),
    ("head -c 9000 /dev/urandom > model.dat; echo Job finished", "holds no stresses of the block"),
    (f"printf {HEAD} > model.dat; echo '1 1 1 2 3 4 5 6' >> model.dat; echo Job finished", "holds 1 stresses of the block"),
    (f"printf {HEAD} > model.dat; echo '1 1 1 2 x 4 5 6' >> model.dat; echo Job finished", "model.dat:3: '1 1 1 2 x"),
    (f"printf {HEAD} > model.dat; echo '1 1 1 2 NaN 4 5 6' >> model.dat; echo Job finished", "model.dat:3: '1 1 1 2 NaN"),
    ("exec yes", "printed more than 1 MiB and was stopped"),
])
def test_a_calculix_that_fails_is_told(tmp_path, deck, script, wanted):
    done = _failing(tmp_path, deck, script)
    assert done.returncode == 2, done.stderr
    assert wanted in done.stderr and "Traceback" not in done.stderr, done.stderr
    assert not any((tmp_path / "out" / name).exists() for name in ("fem.json", "curves.csv", "pressure.csv"))


@pytest.mark.parametrize(("program", "wanted"), [("no-such-ccx", "cannot be run: No such file"), ("true", "its version")])
def test_a_missing_calculix_is_told(tmp_path, deck, program, wanted):
    request, meshes, _, _ = deck
    shutil.copytree(meshes, tmp_path / "out")
    (tmp_path / "request.json").write_text(json.dumps({**request.to_json(), "ccx": program}))
    done = run_stage("solve", tmp_path / "request.json", tmp_path / "out")
    assert done.returncode == 2 and "Traceback" not in done.stderr, done.stderr
    assert program in done.stderr and wanted in done.stderr


@pytest.fixture(scope="module")
def pressed(deck):
    """The deck's bodies under a Hertz pressure along the whole line: (deck, forces, stresses)."""
    request, folder, bodies, meshed = deck
    scene = Scene.of(request.case)
    grid = ContactGrid(meshed["axes_c"]["x_contact"], meshed["axes_c"]["y_contact"], True)
    across = np.sqrt(np.maximum(1.0 - grid.gauss_x**2, 0.0))
    pressure = np.outer(across, np.ones(len(grid.gauss_y)))
    forces = ending_surface(bodies, scene)[1].forces(pressure, grid)
    forces *= scene.load / forces.sum()
    stresses, _ = apply_forces(request, folder, bodies, forces, lambda text: None)
    return deck, forces, stresses


def test_large_displacements_are_those_of_the_deck_alone(deck, tmp_path):
    request, meshes, _, _ = deck
    shutil.copytree(meshes, tmp_path / "out")
    large = dataclasses.replace(request, large_displacements=True)
    (tmp_path / "request.json").write_text(json.dumps(large.to_json()))
    done = run_stage("deck", tmp_path / "request.json", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    model = (tmp_path / "out" / "model.inp").read_text()
    assert model.count("*STEP, NLGEOM, INC=100") == model.count("*STEP") == 2
    assert "NLGEOM" not in (meshes / "model.inp").read_text()
    done = run_stage("solve", tmp_path / "request.json", tmp_path / "out")
    assert done.returncode == 2 and "for the deck alone" in done.stderr, done.stderr


@needs_ccx
def test_points_are_those_of_the_elements_in_each_body(pressed):
    """Under a Hertz pressure: its own values just below the surface, in both bodies' axes."""
    (request, folder, _, _), _, _ = pressed
    path, count = write_points(request, folder, "forces")
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == count > 200
    scales, values = request.case.scales(), {}
    for name in ("block", "roller"):
        own = [row for row in rows if row["body"] == name]
        x, y, z = (np.array([float(row[f"{axis}_m"]) for row in own]) / scales.c_m for axis in "xyz")
        assert near_the_contact(name, np.stack([x, y, z], axis=1), Scene.of(request.case)).all()
        stress = {key: np.array([float(row[f"sigma_{key}_pa"]) for row in own]) / scales.p0_pa for key in ("zz", "xz")}
        shallow = (y < 2.0) & (z < 0.1) & (x < 0.8)
        assert shallow.any() and np.abs(stress["zz"] + np.sqrt(1.0 - np.minimum(x, 1.0) ** 2))[shallow].max() < 0.06
        values[name] = stress["xz"][(y < 2.0) & (np.abs(x - 0.7) < 0.3) & (z > 0.2) & (z < 1.2)].mean()
    # The shear under one half of the contact has one sign in both, z into each body.
    assert values["block"] < -0.1 and abs(values["block"] - values["roller"]) < 0.03


@needs_ccx
def test_its_results_survive_no_damage(pressed, tmp_path):
    """Real results, cut at many places and with single bytes changed: refused or read, never a crash."""
    (_, folder, bodies, _), _, _ = pressed
    whole = (folder / "forces.dat").read_bytes()
    read_dat(folder / "forces.dat", bodies)
    damaged, refused = tmp_path / "d.dat", 0
    random = np.random.default_rng(1)
    for _ in range(12):
        damaged.write_bytes(whole[: random.integers(len(whole) - 100)])
        with pytest.raises(FemError):
            read_dat(damaged, bodies)
        changed = bytearray(whole)
        changed[random.integers(len(whole))] = random.integers(256)
        damaged.write_bytes(changed)
        try:
            read_dat(damaged, bodies)
        except FemError:
            refused += 1
    assert refused > 0


@needs_ccx
def test_elasticity_alone_is_that_of_the_other_engine(pressed):
    """The linear answer of both codes under the same contact forces: no contact algorithm takes part."""
    from mpi4py import MPI

    from edgeline_fem.model import _number_contact, build_bodies

    (request, folder, bodies, meshed), forces, stresses = pressed
    scene, axes = Scene.of(request.case), meshed["axes_c"]
    _, ours = sampler(request, bodies, meshed, stresses, forces)
    grid = ContactGrid(axes["x_contact"], axes["y_contact"], True)
    theirs, _ = build_bodies(MPI.COMM_SELF, folder, request, axes["y_contact"])
    _number_contact(theirs, grid, scene.radius)
    # The same pressure as forces on the 27-node faces, whose corner and middle nodes share it by other weights.
    across = np.sqrt(np.maximum(1.0 - grid.gauss_x**2, 0.0))
    nodal = _consistent(grid, np.outer(across, np.ones(len(grid.gauss_y))))
    nodal *= scene.load / nodal.sum()
    for body in theirs.values():
        body.press(nodal)
        assert abs(body.keep() / scene.load - 1.0) < 1e-8
    from edgeline_fem.sampling import Sampler

    other = Sampler(scene, theirs, grid, nodal)
    deep = [c for c in request.curves if c.name in ("depth-centre", "depth-0.9", "depth-centre-x1.4")]
    for curve in deep:
        places = np.array(curve.points_m) / request.case.scales().c_m
        places = places[places[:, 2] >= 0.5]
        difference = ours.stress(curve.body, places) - other.stress(curve.body, places)
        # The mesh is four times as coarse as that of production, the elements are different.
        assert np.sqrt(np.mean(difference**2)) < 0.006, (curve.body, curve.name)


def _consistent(grid, pressure):
    """Forces on the 27-node elements' faces of a pressure at their Gauss points."""
    from edgeline_fem.contact import interpolation

    across, along = interpolation(grid.x, grid.gauss_x), interpolation(grid.y, grid.gauss_y)
    weights = np.outer(np.repeat(0.5 * np.diff(grid.x[::2]), 2), np.repeat(0.5 * np.diff(grid.y[::2]), 2))
    return (across.T @ (pressure * weights) @ along).ravel()


@pytest.mark.slow
@needs_ccx
def test_a_whole_contact_is_that_of_the_other_engine(coarse, tmp_path):
    """The flush contact at size 2.8 by both engines: pressure and stresses within 0.008 p0 RMS."""
    case, request, folder = coarse
    asked = {**json.loads(request.read_text()), "engine": "calculix"}
    (tmp_path / "request.json").write_text(json.dumps(asked))
    for stage in ("mesh", "solve"):
        done = run_stage(stage, tmp_path / "request.json", tmp_path)
        assert done.returncode == 0, done.stderr
    scales, half = case.scales(), case.contact_half_length()

    def rows(path):
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def rms(name, columns, kept):
        pairs = [pair for pair in zip(rows(folder / name), rows(tmp_path / name)) if kept(pair[0])]
        difference = np.array([[float(a[c]) - float(b[c]) for c in columns] for a, b in pairs]) / scales.p0_pa
        return np.sqrt(np.mean(difference**2, axis=0)).max()

    def away(row):
        return np.hypot(float(row["y_m"]) / scales.c_m - half, float(row.get("z_m", 0.0)) / scales.c_m) > 0.2

    assert rms("pressure.csv", ["p_pa"], away) < 0.008
    columns = [f"sigma_{c}_pa" for c in ("xx", "yy", "zz", "xy", "xz", "yz")]
    assert rms("curves.csv", columns, away) < 0.008
