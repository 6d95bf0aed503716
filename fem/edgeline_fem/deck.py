"""The input deck of a case for CalculiX and Abaqus, in mm, N and MPa.

``model.inp`` includes ``mesh.inp`` (nodes, elements, sets, surfaces) and ``bodies.inp`` (materials, symmetry). The mesh is
the one of the other engine with bricks of 20 nodes; it is also written as .vtu.
"""

import math
from pathlib import Path

import numpy as np

from .bricks import Bricks
from .meshing import read_summary, write_atomically
from .request import FemError
from .scene import BODIES, Scene, surface_slope

# Contact stiffness in units of E* / C: the surfaces then overlap by p / stiffness, a few 1e-4 of the gap at x = C.
STIFFNESS = 2000.0
# How far beyond an end the surface of the body that goes on may be touched: a body that ends slides outwards by about
# C / R, 0.05 at W = 1e-3, since both strain.
SLIP = 0.3
_ELEMENT = "C3D20R"
_PER_LINE = 12
FILES = ("model.inp", "mesh.inp", "bodies.inp", "block.vtu", "roller.vtu")


def check_scene(case):
    """Raise :class:`FemError` unless the deck's quarter model holds the case."""
    if not case.is_symmetric():
        raise FemError("the deck models a quarter of the bodies (x >= 0, y >= 0), so the scene has to be symmetric about "
                       "y = 0: leave out eccentricity_m, tilt_rad and offset_m, or take --engine fenicsx")
    if case.friction:
        raise FemError("the deck's contact is frictionless: leave out friction, or take --engine fenicsx")
    if case.roller_profile_m is not None or case.block_profile_m is not None:
        raise FemError("the deck takes straight generatrices only: leave out the profile, or take --engine fenicsx")


def read_bricks(request, folder):
    """The meshes of both bodies in ``folder``, and the content of ``mesh.json``: ``({body: Bricks}, meshed)``."""
    folder, scene = Path(folder), Scene.of(request.case)
    meshed = read_summary(folder)
    support = {"block": request.mesh.block_depth, "roller": scene.radius}
    across = meshed["axes_c"]["x_contact"][-1]
    bodies = {
        name: Bricks.read(folder / f"{name}.msh", name, scene, support[name],
                          (across, scene.stop + (SLIP if scene.ends[-1].goes_on(name) else 0.0)))
        for name in BODIES
    }
    return bodies, meshed


def _first(bodies):
    """What is added to the numbers of each body's nodes and elements: ``{body: (nodes, elements)}``."""
    block = bodies["block"]
    return {"block": (1, 1), "roller": (1 + len(block.points), 1 + len(block.cells))}


def _listed(numbers):
    """``numbers`` as lines of a deck."""
    numbers = list(map(str, numbers))
    return [", ".join(numbers[at : at + _PER_LINE]) + "," for at in range(0, len(numbers), _PER_LINE)]


def _mesh_text(bodies, c_mm):
    lines = ["** Nodes (mm), elements, sets and surfaces. x: across the contact, y: along it, z: into the block."]
    for name, body in bodies.items():
        node, element = _first(bodies)[name]
        upper = name.upper()
        lines.append(f"*NODE, NSET={upper}_NODES")
        lines += [
            f"{number}, {x:.12e}, {y:.12e}, {z:.12e}"
            for number, (x, y, z) in enumerate((body.points * c_mm).tolist(), node)
        ]
        lines.append(f"*ELEMENT, TYPE={_ELEMENT}, ELSET={upper}")
        for number, nodes in enumerate((body.cells + node).tolist(), element):
            lines.append(f"{number}, " + ", ".join(map(str, nodes[:10])) + ",")
            lines.append(", ".join(map(str, nodes[10:])))
        for kind, rows in body.sets.items():
            lines += [f"*NSET, NSET={upper}_{kind.upper()}", *_listed(rows + node)]
        lines.append(f"*SURFACE, NAME={upper}_CONTACT, TYPE=ELEMENT")
        lines += [f"{cell + element}, S{face + 1}" for cell, face in body.faces]
    lines += ["** The node of the roller's mid-plane that all its nodes follow along z.",
              "*NSET, NSET=PUSHED", f"{_pushed(bodies)},"]
    return "\n".join(lines) + "\n"


def _pushed(bodies):
    return int(bodies["roller"].sets["support"][0]) + _first(bodies)["roller"][0]


def _bodies_text(case):
    lines = ["** Materials (MPa), and what the planes of symmetry hold."]
    for name in BODIES:
        material, upper = getattr(case, name), name.upper()
        lines += [
            f"*MATERIAL, NAME={upper}_MATERIAL", "*ELASTIC",
            f"{material.young_pa * 1e-6:.12g}, {material.poisson:.12g}",
            f"*SOLID SECTION, ELSET={upper}, MATERIAL={upper}_MATERIAL",
        ]
    return "\n".join([*lines, "*BOUNDARY", *_symmetry()]) + "\n"


def _symmetry():
    return [f"{name.upper()}_SYMMETRY_{axis}, {number}, {number}"
            for name in BODIES for axis, number in (("X", 1), ("Y", 2))]


def estimated_approach(case, block_depth):
    """About how far the roller's mid-plane approaches the block's bottom (units of C).

    Half a roller sinks by w (1 - nu^2) / (pi E) (2 ln(4 R / C) - 1) (Johnson, Contact Mechanics, 1985, section 5.6); a
    block by the same with 2 ln(2 d / C) down to a depth d of about the load's length. Further down the load has spread
    over the block's length, in plane stress along it. Within 5 % of the solution for the cases on record.
    """
    scales, load, block = case.scales(), case.contact_half_length(), case.block_half_length()
    line = 0.5 * math.pi * scales.p0_pa / math.pi
    near, spread = min(1.2 * load, block_depth), min(1.2 * block, block_depth)

    def sinking(material, strain, stress):
        return line / material.young_pa * ((1.0 - material.poisson**2) * strain + stress)

    return (sinking(case.roller, max(2.0 * math.log(4.0 * scales.radius) - 1.0, 1.0), 0.0)
            + sinking(case.block, 2.0 * math.log(2.0 * near), 2.0 * load / block * math.log(block_depth / spread)))


def _model_text(request, bodies, stiffness):
    case = request.case
    scales = case.scales()
    c_mm = scales.c_m * 1e3
    pushed, followers = _pushed(bodies), bodies["roller"].sets["support"][1:] + _first(bodies)["roller"][0]
    equations = [line for node in followers for line in ("*EQUATION", "2", f"{node}, 3, 1., {pushed}, 3, -1.")]
    slope = stiffness * scales.e_star * scales.p0_pa * 1e-6 / c_mm
    down = estimated_approach(case, request.mesh.block_depth) * c_mm
    step = "*STEP, NLGEOM, INC=100" if request.large_displacements else "*STEP, INC=100"
    lines = [
        "*HEADING",
        f"{case.name or 'case'}: roller on a block, a quarter of both (x >= 0, y >= 0); mm, N, MPa",
        f"** Hertz: half-width {c_mm:.8g} mm, pressure {scales.p0_pa * 1e-6:.8g} MPa. Load of the whole contact "
        f"{case.force_n:.8g} N.",
        "*INCLUDE, INPUT=mesh.inp",
        "*INCLUDE, INPUT=bodies.inp",
        "** The block's bottom carries; the roller's mid-plane stays plane and level.",
        "*BOUNDARY", "BLOCK_SUPPORT, 3, 3",
        *equations,
        f"** Frictionless contact by a penalty: pressure = {slope:.6g} N/mm^3 times the overlap. Twice as much changes the",
        "** pressure by less than 0.2 % (docs/fem.md).",
        "*SURFACE INTERACTION, NAME=FRICTIONLESS",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{slope:.10g}",
        "*CONTACT PAIR, INTERACTION=FRICTIONLESS, TYPE=SURFACE TO SURFACE",
        "ROLLER_CONTACT, BLOCK_CONTACT",
        *(["** Large displacements: equilibrium where the bodies have moved to; stresses are Cauchy's in the fixed axes."]
          if request.large_displacements else []),
        "** Step 1 brings the bodies together by a displacement, so that contact holds the roller.",
        step, "*STATIC, DIRECT", "1., 1.",
        "*BOUNDARY", f"PUSHED, 3, 3, {down:.10g}",
        "*END STEP",
        "** Step 2 lets go of the displacement and applies a quarter of the load.",
        step, "*STATIC, DIRECT", "1., 1.",
        "*BOUNDARY, OP=NEW", "BLOCK_SUPPORT, 3, 3", *_symmetry(),
        "*CLOAD", f"PUSHED, 3, {0.25 * case.force_n:.12g}",
        *_output(),
        "*END STEP",
    ]
    return "\n".join(lines) + "\n"


def _output():
    return [
        "*NODE FILE", "U", "*EL FILE", "S",
        "*NODE PRINT, NSET=PUSHED", "U",
        *(line for name in BODIES for line in (f"*EL PRINT, ELSET={name.upper()}", "S")),
    ]


def _vtu_text(body, c_mm):
    """The mesh in VTK's format for unstructured grids; the order of nodes is the same."""
    nodes, cells = len(body.points), len(body.cells)

    def array(kind, name, values, components=""):
        text = "\n".join(" ".join(map(str, row)) for row in values)
        return f'<DataArray type="{kind}" Name="{name}"{components} format="ascii">\n{text}\n</DataArray>\n'

    points = array("Float64", "Points", (body.points * c_mm).tolist(), ' NumberOfComponents="3"')
    parts = (array("Int64", "connectivity", body.cells.tolist()),
             array("Int64", "offsets", [range(20, 20 * cells + 1, 20)]), array("UInt8", "types", [[25] * cells]))
    return (
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n'
        f'<UnstructuredGrid><Piece NumberOfPoints="{nodes}" NumberOfCells="{cells}">\n<Points>\n{points}</Points>\n'
        f"<Cells>\n{''.join(parts)}</Cells>\n</Piece></UnstructuredGrid>\n</VTKFile>\n"
    )


def write_deck(request, folder, stiffness=STIFFNESS):
    """Write the files of the deck into ``folder``, which holds the meshes, ``model.inp`` last.

    ``stiffness``: of the contact, in units of E* / C. Returns :func:`read_bricks`. Raises :class:`FemError` for scenes that
    the deck does not hold.
    """
    check_scene(request.case)
    folder = Path(folder)
    bodies, meshed = read_bricks(request, folder)
    c_mm = request.case.scales().c_m * 1e3
    texts = {
        **{f"{name}.vtu": _vtu_text(body, c_mm) for name, body in bodies.items()},
        "mesh.inp": _mesh_text(bodies, c_mm),
        "bodies.inp": _bodies_text(request.case),
        "model.inp": _model_text(request, bodies, stiffness),
    }
    for name, text in texts.items():
        write_atomically(folder / name, text)
    return bodies, meshed


def write_forces(request, folder, bodies, forces):
    """Write ``forces.inp`` beside the deck: a linear step with supports held and the contact's forces applied.

    ``forces``: for each body the z components (into that body, units of C and p0) on the nodes of its surface. A
    force is normal to the unloaded surface, as in the other engine.
    """
    scene, scales = Scene.of(request.case), request.case.scales()
    unit = scales.p0_pa * scales.c_m**2
    loads = []
    for name, body in bodies.items():
        surface, sign = body.surface, 1.0 if name == "block" else -1.0
        slopes = surface_slope(name, body.points[surface.rows, 0], scene.radius)
        for node, slope, force in zip(surface.rows + _first(bodies)[name][0], slopes, forces[name] * unit):
            loads.append(f"{node}, 3, {sign * force:.12e}")
            if slope != 0.0:
                loads.append(f"{node}, 1, {-slope * force:.12e}")
    lines = [
        "*HEADING", f"{request.case.name or 'case'}: both bodies on their supports under the contact's forces",
        "*INCLUDE, INPUT=mesh.inp", "*INCLUDE, INPUT=bodies.inp",
        "*BOUNDARY", "BLOCK_SUPPORT, 3, 3", "ROLLER_SUPPORT, 3, 3",
        "*STEP", "*STATIC", "*CLOAD", *loads, *_output(), "*END STEP",
    ]
    write_atomically(Path(folder) / "forces.inp", "\n".join(lines) + "\n")
