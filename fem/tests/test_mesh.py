"""The meshes: gradings, true geometry, matching nodes, quality."""

import dataclasses
import math

import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI

from conftest import steel_case
from edgeline_fem.elasticity import load_mesh
from edgeline_fem.meshing import graded_axis, make_axes, make_meshes, quality, read_msh
from edgeline_fem.record import standard_request
from edgeline_fem.request import FemError, MeshOptions


def test_a_graded_axis_follows_its_size():
    nodes = graded_axis(0.0, 50.0, lambda s: 0.1 + 0.3 * s)
    steps, middles = np.diff(nodes), 0.5 * (nodes[1:] + nodes[:-1])
    assert nodes[0] == 0.0 and nodes[-1] == 50.0
    assert np.all(steps > 0.0)
    assert np.all(np.abs(steps / (0.1 + 0.3 * middles) - 1.0) < 0.1)


def test_halving_the_size_doubles_every_axis():
    case = steel_case(1e-4, 5.0, 0.5)
    coarse, fine = (make_axes(case, MeshOptions(size=size)) for size in (1.0, 0.5))
    for name in ("arc", "roller_depth", "x", "z", "overlap"):
        one, two = len(getattr(coarse, name)) - 1, len(getattr(fine, name)) - 1
        # Rounding up to whole elements happens up to twice along an axis.
        assert 2 * one - 3 <= two <= 2 * one, name


def test_elements_are_small_where_the_contact_ends():
    """Beside an expected end as long as asked for, and growing from there; elsewhere as without one."""
    half_length = 5.0
    profile = tuple((y, abs(y)) for y in (-1.0, 0.0, 1.0))
    straight = steel_case(1e-4, half_length, 0.5)
    half_m = 0.5 * straight.roller_length_m
    ends_m = tuple((half_m * y, 1e-6 * drop) for y, drop in profile)
    for case in (dataclasses.replace(straight, roller_profile_m=ends_m),
                 dataclasses.replace(straight, roller_profile_m=ends_m, eccentricity_m=0.0)):
        options = MeshOptions()
        plain, finer = make_axes(case, options).overlap, make_axes(case, options, [-3.9, 3.7]).overlap
        steps, middles = np.diff(finer), 0.5 * (finer[1:] + finer[:-1])
        for tip in (-3.9, 3.7):
            if tip < finer[0]:
                continue
            near = np.abs(middles - tip) < 0.5
            wanted = np.minimum(options.along, options.tip + options.growth * np.abs(middles - tip))
            assert steps[near] == pytest.approx(wanted[near], rel=0.15)
        one, other = (np.diff(nodes[nodes > 4.9]) for nodes in (plain, finer))
        assert other[-3:] == pytest.approx(one[-3:], rel=0.1)


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mesh")
    case = steel_case(1e-3, 5.0, 0.5)
    summary = make_meshes(standard_request(case, 2.0, vtk=True), folder)
    return case, summary, {name: read_msh(folder / f"{name}.msh") for name in ("block", "roller")}, folder


def test_groups_are_named_and_counted(meshes):
    _, summary, read, _ = meshes
    for name, (points, cells, groups) in read.items():
        assert groups[name] == len(cells) == summary["bodies"][name]["elements"]
        assert {"contact", "support", "symmetry-x", "symmetry-y", "end", "free"} <= set(groups)
        assert len(np.unique(points.round(9), axis=0)) == len(points)
    assert read["block"][2]["contact"] > read["roller"][2]["contact"]


def test_the_roller_has_a_true_cylinders_volume(meshes):
    case, _, _, folder = meshes
    radius = case.scales().radius
    domain = load_mesh(MPI.COMM_SELF, folder / "roller.msh")
    volume = fem.assemble_scalar(fem.form(fem.Constant(domain, 1.0) * ufl.dx))
    # Quadratic edges follow the arc to fourth order.
    assert volume == pytest.approx(0.25 * math.pi * radius**2 * 5.0, rel=3e-4)


def test_surface_nodes_lie_on_the_true_arc_over_those_of_the_block(meshes):
    case, summary, read, _ = meshes
    radius = case.scales().radius
    points = read["roller"][0]
    on_arc = points[np.abs(np.hypot(points[:, 0], radius - points[:, 2]) - radius) < 1e-9 * radius]
    reach = summary["axes_c"]["x_contact"][-1]
    near = on_arc[on_arc[:, 0] < reach * (1.0 + 1e-9)]
    elements = read["roller"][2]["contact"]
    per_y = len(summary["axes_c"]["y_contact"]) - 1
    assert len(near) == (2 * elements // per_y + 1) * (2 * per_y + 1)
    block = read["block"][0]
    top = block[(np.abs(block[:, 2]) < 1e-12) & (block[:, 1] < 5.0 + 1e-9)]
    for x, y, _ in near:
        assert np.hypot(top[:, 0] - x, top[:, 1] - y).min() < 1e-4


def test_quality(meshes):
    _, summary, _, folder = meshes
    assert summary["bodies"]["block"]["quality_min"] == pytest.approx(1.0)
    assert summary["bodies"]["roller"]["quality_min"] > 0.75
    cube = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    cell = np.arange(8)[None, :]
    assert quality(cube.astype(float), cell) == (1.0, 1.0)
    assert quality(cube * [1.0, 1.0, -1.0], cell) == (1.0, 1.0)
    assert (folder / "roller.vtk").read_text(errors="replace").startswith("# vtk DataFile")


def test_a_contact_as_wide_as_the_roller_is_refused():
    with pytest.raises(FemError, match="too wide for the model"):
        make_axes(steel_case(0.3, 5.0, 1.0), MeshOptions())
