"""Graded hexahedral meshes of both bodies, made by the gmsh program from .geo files written here.

A body is a cross-section in the (x, z) plane, cut into four-sided transfinite patches, extruded along y.
Every side of a patch is a chain of curves that carry one element each, so an axis may have any grading,
and the curves of the roller's surface are true circular arcs, on which gmsh also puts the middle nodes of
the second-order elements.

Sizes follow a function h(s) of the distance s: nodes stand at equal steps of the integral of ds/h, so
that halving ``size`` refines everywhere alike and solutions on different meshes can be extrapolated.
"""

import dataclasses
import json
import math
import os
import resource
import time
from pathlib import Path

import numpy as np

from .programs import run_program
from .request import FemError, is_finite, read_json
from .scene import BODIES, Scene

# The roller's quarter disc is three patches that meet at one inner point, as an O-grid. Radii are
# relative to the roller's: where the axis x = 0 is cut, measured from the disc's centre, and the radius of
# the inner point on the diagonal.
_CORE_SIDE = 0.45
_CORE_DIAGONAL = 0.55


def graded_axis(start, stop, size_at, scale=1.0):
    """Nodes from ``start`` to ``stop`` > ``start``, spaced by about ``scale * size_at(s)``.

    ``size_at`` maps a coordinate to a wanted element size > 0. The number of elements is rounded up; the
    nodes are equidistributed with respect to ds / size_at. Returns an ascending array.
    """
    # A fine trial march resolves the size function wherever it is small.
    position, trial, density = start, [start], []
    while position < stop:
        position = min(position + 0.02 * size_at(position), stop)
        density.append(1.0 / size_at(0.5 * (position + trial[-1])))
        trial.append(position)
    trial = np.array(trial)
    count = np.concatenate(([0.0], np.cumsum(np.array(density) * np.diff(trial))))
    elements = max(1, math.ceil(count[-1] / scale - 1e-3))
    nodes = np.interp(np.linspace(0.0, count[-1], elements + 1), count, trial)
    nodes[0], nodes[-1] = start, stop
    return nodes


@dataclasses.dataclass(frozen=True)
class Axes:
    """Element boundaries of both meshes (units of C), all ascending.

    ``arc``: arc length along the roller's surface to 45 degrees; its first ``contact_elements`` elements
    lie within the strip where contact is looked for. ``roller_depth``: on x = 0 from the surface to the
    core. ``core``: number of elements across the core's frame. ``x``, ``z``: the block's. ``y``: for each body,
    its own; ``overlap``: those that both have.
    """

    arc: np.ndarray
    contact_elements: int
    roller_depth: np.ndarray
    core: int
    x: np.ndarray
    z: np.ndarray
    y: dict
    overlap: np.ndarray


def _along(scene, options, tips):
    """Nodes along y: ``({body: its own}, those of the overlap)``; ``tips`` as in :func:`make_axes`."""
    scale = options.size
    sizes = [options.end if end.longer is None else options.corner for end in scene.ends]
    smallest = [(end.y, size) for end, size in zip(scene.ends, sizes)] + [(tip, options.tip) for tip in tips]
    largest = options.along if scene.profiled else np.inf

    def within(v):
        return min(largest, *(size + options.growth * abs(place - v) for place, size in smallest))

    overlap = graded_axis(scene.middle, scene.stop, within, scale)
    if not scene.symmetric:
        # Halves of their own: where both ends are alike, the mesh is as well.
        other = 2.0 * scene.middle - graded_axis(
            scene.middle, scene.stop, lambda v: within(2.0 * scene.middle - v), scale
        )
        overlap = np.concatenate((other[:0:-1], overlap))
        overlap[0] = scene.start
    nodes = dict.fromkeys(BODIES, overlap)
    for size, end in zip(sizes, scene.ends):
        if end.longer is None:
            continue
        low, high = scene.spans[end.longer]
        side, length = (-1.0, end.y - low) if end.y == scene.start else (1.0, high - end.y)
        # Stresses change over the ledge's length where that is short.
        free_end = min(options.free_end, 0.25 * length)

        def outward(s):
            return min(size + options.beyond * s, free_end + options.beyond * (length - s))

        ledge = end.y + side * graded_axis(0.0, length, outward, scale)[1:]
        own = nodes[end.longer]
        nodes[end.longer] = np.concatenate((own, ledge) if side > 0.0 else (ledge[::-1], own))
    return nodes, overlap


def make_axes(case, options, tips=()):
    """The :class:`Axes` of a case under :class:`~edgeline_fem.request.MeshOptions`.

    ``tips``: places along y (C) where the contact is expected to end before the bodies do.
    """
    scene = Scene.of(case)
    radius, scale = scene.radius, options.size

    def grown(size, distance, growth=options.growth):
        far = max(0.0, distance - options.far_from)
        return size + growth * (distance - far) + options.far_growth * far

    reach = options.contact_reach
    quarter_arc = 0.25 * math.pi * radius
    if reach > 0.5 * quarter_arc:
        raise FemError(
            f"the contact is too wide for the model: C = {1 / radius:.3g} R; reduce the force"
        )

    def across(x):
        near_edge = options.edge + options.growth * abs(x - 1.0)
        return grown(min(options.across, near_edge), max(0.0, x - reach))

    near = graded_axis(0.0, reach, across, scale)
    arc = np.concatenate((near, graded_axis(reach, quarter_arc, across, scale)[1:]))
    # The block's nodes are directly below the roller's, which are even in arc length,
    # not in x.
    under = radius * np.sin(near / radius)
    x = np.concatenate((under, graded_axis(under[-1], options.block_width, across, scale)[1:]))

    def deep(z):
        return grown(options.depth, z, options.depth_growth)

    core_depth = (1.0 - _CORE_SIDE) * radius
    core = max(2, round(4.0 / scale))

    y, overlap = _along(scene, options, tips)
    return Axes(
        arc=arc,
        contact_elements=len(near) - 1,
        roller_depth=graded_axis(0.0, core_depth, deep, scale),
        core=core,
        x=x,
        z=graded_axis(0.0, options.block_depth, deep, scale),
        y=y,
        overlap=overlap,
    )


class Section:
    """A cross-section under construction in the plane of ``y``, as text of a .geo file."""

    def __init__(self, y=0.0):
        self.lines = []
        self._y = y
        self._points = {}
        self._curves = 0
        self._chains = {}
        self._patches = []

    def point(self, x, z):
        """The number of the point at (x, z); points that coincide share one."""
        key = (round(x, 9), round(z, 9))
        if key not in self._points:
            self._points[key] = len(self._points) + 1
            self.lines.append(f"Point({self._points[key]}) = {{{x:.16g}, {self._y:.16g}, {z:.16g}}};")
        return self._points[key]

    def chain(self, name, points, centre=None):
        """A side of a patch through ``points`` [(x, z), ...], one element between neighbours.

        The curves are straight, or arcs about the point ``centre``.
        """
        numbers = [self.point(*p) for p in points]
        middle = None if centre is None else self.point(*centre)
        curves = []
        for a, b in zip(numbers, numbers[1:]):
            self._curves += 1
            through = f"{a}, {b}" if middle is None else f"{a}, {middle}, {b}"
            kind = "Line" if middle is None else "Circle"
            self.lines.append(f"{kind}({self._curves}) = {{{through}}};")
            curves.append(self._curves)
        self._chains[name] = (curves, numbers)

    def patch(self, *sides):
        """A transfinite patch within four chains, named in order around it; ``-name`` runs backwards."""
        loop, corners, layout = [], [], []
        for side in sides:
            curves, numbers = self._chains[side.lstrip("-")]
            backwards = side.startswith("-")
            loop += [-c for c in reversed(curves)] if backwards else curves
            corners.append(numbers[-1] if backwards else numbers[0])
            layout.append((side.lstrip("-"), len(curves), backwards))
        self._patches.append(layout)
        number = len(self._patches)
        self.lines += [
            f"Curve Loop({number}) = {{{', '.join(map(str, loop))}}};",
            f"Plane Surface({number}) = {{{number}}};",
            f"Transfinite Surface {{{number}}} = {{{', '.join(map(str, corners))}}};",
            f"Recombine Surface {{{number}}};",
        ]

    def geo(self, body, y, groups):
        """The whole .geo text: the section extruded through the nodes ``y``, from its own plane on.

        ``groups`` maps names of physical surfaces to ``(chain, first, last)``, the curves of a chain
        whose extrusions make up the group. The section's plane and the body's end are groups as well.
        """
        length = y[-1] - y[0]
        heights = ", ".join(f"{v:.16g}" for v in (y[1:] - y[0]) / length)
        first, model = ("symmetry-y", "quarter") if y[0] == 0.0 else ("other-end", "half")
        ones = ", ".join("1" for _ in y[1:])
        text = [
            f"// {body}: {model} model, lengths in units of the Hertz half-width C",
            "General.Terminal = 1;",
            *self.lines,
            "Transfinite Curve {:} = 2;",
        ]
        ends = []
        members = {name: [] for name in groups}
        for number, layout in enumerate(self._patches, 1):
            out = f"e{number}"
            text.append(
                f"{out}[] = Extrude {{0, {length:.16g}, 0}} {{ Surface{{{number}}}; "
                f"Layers{{ {{{ones}}}, {{{heights}}} }}; Recombine; }};"
            )
            ends.append(f"{out}[0]")
            position = 2  # entries 0 and 1 are the far end and the volume
            for chain, count, backwards in layout:
                for name, (wanted, begin, end) in groups.items():
                    if wanted == chain:
                        picked = range(begin, count if end is None else end)
                        members[name] += [
                            f"{out}[{position + (count - 1 - i if backwards else i)}]" for i in picked
                        ]
                position += count
        volumes = ", ".join(f"e{n}[1]" for n in range(1, len(self._patches) + 1))
        sections = ", ".join(str(n) for n in range(1, len(self._patches) + 1))
        text.append(f'Physical Volume("{body}") = {{{volumes}}};')
        text.append(f'Physical Surface("{first}") = {{{sections}}};')
        text.append(f'Physical Surface("end") = {{{", ".join(ends)}}};')
        for name, surfaces in members.items():
            text.append(f'Physical Surface("{name}") = {{{", ".join(surfaces)}}};')
        text += [
            "Mesh.ElementOrder = 2;",
            "Mesh.SecondOrderIncomplete = 0;",
            "Mesh.MshFileVersion = 2.2;",
            "Mesh.Binary = 1;",
        ]
        return "\n".join(text) + "\n"


def box_geo(body, x, y, z, contact_elements):
    """The .geo text of a box with nodes ``x``, ``y``, ``z``, each ascending, x and z from 0.

    The first ``contact_elements`` elements of x form the physical surface ``contact`` at z = 0.
    """
    section = Section(y[0])
    section.chain("top", [(v, 0.0) for v in x])
    section.chain("side", [(x[-1], v) for v in z])
    section.chain("bottom", [(v, z[-1]) for v in x])
    section.chain("middle", [(0.0, v) for v in z])
    section.patch("top", "side", "-bottom", "-middle")
    groups = {
        "contact": ("top", 0, contact_elements),
        "free": ("top", contact_elements, None),
        "far-side": ("side", 0, None),
        "support": ("bottom", 0, None),
        "symmetry-x": ("middle", 0, None),
    }
    return section.geo(body, y, groups)


def roller_geo(radius, axes):
    """The .geo text of a quarter of a roller's disc, extruded: 0 <= z <= R, 0 <= x <= sqrt(R^2 - (R-z)^2)."""

    def at(relative, degrees):
        angle = math.radians(degrees)
        return np.array([radius * relative * math.sin(angle), radius * (1 - relative * math.cos(angle))])

    centre = (0.0, radius)
    inner = at(_CORE_DIAGONAL, 45.0)
    along = axes.arc / axes.arc[-1]
    down = axes.roller_depth / axes.roller_depth[-1]
    even = np.linspace(0.0, 1.0, axes.core + 1)

    def straight(a, b, fractions):
        a, b = np.asarray(a), np.asarray(b)
        return [tuple(a + t * (b - a)) for t in fractions]

    section = Section(axes.y["roller"][0])
    section.chain("contact-arc", [tuple(at(1.0, 45.0 * t)) for t in along], centre)
    section.chain("side-arc", [tuple(at(1.0, 45.0 * (1.0 + t))) for t in even], centre)
    section.chain("axis", straight((0.0, 0.0), at(_CORE_SIDE, 0.0), down))
    section.chain("spoke", straight(at(1.0, 45.0), inner, down))
    section.chain("equator", straight(at(1.0, 90.0), at(_CORE_SIDE, 90.0), down))
    section.chain("core-top", straight(at(_CORE_SIDE, 0.0), inner, along))
    section.chain("core-side", straight(inner, at(_CORE_SIDE, 90.0), even))
    section.chain("core-axis", straight(at(_CORE_SIDE, 0.0), centre, even))
    section.chain("core-equator", straight(centre, at(_CORE_SIDE, 90.0), along))
    section.patch("contact-arc", "spoke", "-core-top", "-axis")
    section.patch("side-arc", "equator", "-core-side", "-spoke")
    section.patch("core-top", "core-side", "-core-equator", "-core-axis")
    groups = {
        "contact": ("contact-arc", 0, axes.contact_elements),
        "free": ("contact-arc", axes.contact_elements, None),
        "free-side": ("side-arc", 0, None),
        "symmetry-x": ("axis", 0, None),
        "symmetry-x-core": ("core-axis", 0, None),
        "support": ("equator", 0, None),
        "support-core": ("core-equator", 0, None),
    }
    return section.geo("roller", axes.y["roller"], groups)


def read_msh(path):
    """Nodes and 27-node hexahedra of a binary gmsh 2.2 file.

    Returns ``(points, cells, groups)``: points (n, 3), cells (m, 27) of row numbers of points in gmsh's
    order, and ``{name: number of elements}`` of the physical groups. Raises :class:`FemError`.
    """
    hexahedron, quadrilateral = 12, 10
    nodes_of = {hexahedron: 27, quadrilateral: 9}
    try:
        data = Path(path).read_bytes()
        names = {}
        start = data.index(b"$PhysicalNames") + len(b"$PhysicalNames\n")
        for line in data[start : data.index(b"$EndPhysicalNames")].decode().splitlines()[1:]:
            dimension, tag, name = line.split(maxsplit=2)
            names[int(dimension), int(tag)] = name.strip().strip('"')

        start = data.index(b"$Nodes\n") + len(b"$Nodes\n")
        stop = data.index(b"\n", start)
        count = int(data[start:stop])
        if count <= 0:
            raise ValueError(f"{count} nodes")
        record = np.dtype([("tag", "<i4"), ("x", "<f8", (3,))])
        nodes = np.frombuffer(data, record, count, stop + 1)
        if not 0 < nodes["tag"].min() <= nodes["tag"].max() <= 10 * count:
            raise ValueError("numbers of nodes that gmsh would not give")
        row = np.full(nodes["tag"].max() + 1, -1, dtype=np.int64)
        row[nodes["tag"]] = np.arange(count)

        start = data.index(b"$Elements\n", stop) + len(b"$Elements\n")
        stop = data.index(b"\n", start)
        left, offset = int(data[start:stop]), stop + 1
        cells, groups = [], dict.fromkeys(names.values(), 0)
        while left:
            kind, number, tags = np.frombuffer(data, "<i4", 3, offset)
            width = 1 + tags + nodes_of[int(kind)]
            block = np.frombuffer(data, "<i4", number * width, offset + 12).reshape(number, width)
            dimension = 3 if kind == hexahedron else 2
            for tag, members in zip(*np.unique(block[:, 1], return_counts=True)):
                groups[names[dimension, int(tag)]] += int(members)
            if kind == hexahedron:
                cells.append(row[block[:, 1 + tags :]])
            offset += 4 * (3 + number * width)
            left -= int(number)
        if not cells or min(part.min() for part in cells) < 0:
            raise ValueError("no hexahedra, or nodes of theirs that are not there")
    except (OSError, ValueError, KeyError, IndexError) as error:
        raise FemError(f"{path}: is not a mesh that this program wrote: {error!r}") from error
    return nodes["x"].copy(), np.concatenate(cells), groups


def quality(points, cells):
    """Smallest and mean scaled Jacobian at the vertices of the hexahedra (1 is a right-angled box)."""
    # Vertices of a gmsh hexahedron and, for each, its neighbours along the three edges, right-handed.
    neighbours = ((1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3))
    smallest = np.full(len(cells), np.inf)
    for vertex, ends in enumerate(neighbours):
        edges = points[cells[:, ends]] - points[cells[:, vertex]][:, None, :]
        edges /= np.linalg.norm(edges, axis=2)[:, :, None]
        smallest = np.minimum(smallest, np.linalg.det(edges))
    # gmsh may number a whole mesh left-handed, which does not matter for the volume
    # forms.
    if smallest.mean() < 0.0:
        return quality(points, cells[:, [3, 2, 1, 0, 7, 6, 5, 4]])
    return float(smallest.min()), float(smallest.mean())


def write_atomically(path, text):
    """Write a text file so that it appears whole or not at all."""
    temporary = Path(f"{path}.part")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


def run_gmsh(program, geo, msh, vtk):
    """Mesh ``geo`` into ``msh`` (and ``msh`` with suffix .vtk) by the gmsh program, one thread."""
    part = Path(f"{msh}.part")
    outputs = [(part, "msh2", msh)]
    if vtk:
        outputs.append((Path(f"{msh}.vtk.part"), "vtk", Path(msh).with_suffix(".vtk")))
    for output, kind, final in outputs:
        # Files of an earlier gmsh run must not be taken for those of this one.
        output.unlink(missing_ok=True)
        command = [program, "-3", "-nt", "1", "-v", "2", "-format", kind, "-o", str(output), str(geo)]
        code, said = run_program(command, "gmsh")
        complaints = "\n".join(said.strip().splitlines()[-10:])
        if code != 0 or not output.exists() or "Error" in said:
            raise FemError(f"gmsh failed on {geo} (exit code {code}): {complaints}")
        os.replace(output, final)


def processor_seconds():
    """Processor seconds (float) that this process and its finished children have used."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in used)


def gmsh_version(program):
    """The version that the gmsh program prints; :class:`FemError` if it cannot be run."""
    code, said = run_program([program, "--version"], "gmsh")
    if code != 0 or not said.strip():
        raise FemError(f"gmsh program '{program}' does not tell its version (exit code {code}): {said}")
    return said.strip().splitlines()[-1]


def make_meshes(request, folder):
    """Write ``block.msh``, ``roller.msh`` (with their .geo) and then ``mesh.json`` into ``folder``.

    Returns the content of ``mesh.json``: axes, counts, qualities, seconds and processor seconds.
    """
    folder = Path(folder)
    before = processor_seconds()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mesh.json").unlink(missing_ok=True)
    version = gmsh_version(request.gmsh)
    tips = request.tips()
    axes = make_axes(request.case, request.mesh, tips)
    texts = {
        "block": box_geo("block", axes.x, axes.y["block"], axes.z, axes.contact_elements),
        "roller": roller_geo(request.case.scales().radius, axes),
    }
    sizes = {
        "x": axes.x[1], "y": min(np.diff(y).min() for y in axes.y.values()), "z": axes.z[1],
        "roller_end_y": np.diff(axes.y["roller"])[-1],
    }
    summary = {
        "gmsh": version,
        "options": dataclasses.asdict(request.mesh),
        "contact_ends_c": tips,
        "smallest_c": {name: float(value) for name, value in sizes.items()},
        "axes_c": {
            "x_contact": axes.x[: axes.contact_elements + 1].tolist(),
            "y_contact": axes.overlap.tolist(),
            "z_block": axes.z.tolist(),
        },
        "bodies": {},
        "seconds": {},
    }
    for body, text in texts.items():
        began = time.perf_counter()
        geo = folder / f"{body}.geo"
        write_atomically(geo, text)
        run_gmsh(request.gmsh, geo, folder / f"{body}.msh", request.mesh.vtk)
        points, cells, groups = read_msh(folder / f"{body}.msh")
        worst, mean = quality(points, cells)
        if worst <= 0.0:
            raise FemError(f"{geo}: gmsh made an inverted element (scaled Jacobian {worst:.3g})")
        summary["bodies"][body] = {
            "nodes": len(points),
            "elements": len(cells),
            "unknowns": 3 * len(points),
            "quality_min": worst,
            "quality_mean": mean,
            "groups": groups,
        }
        summary["seconds"][body] = time.perf_counter() - began
    summary["cpu_seconds"] = processor_seconds() - before
    write_atomically(folder / "mesh.json", json.dumps(summary, indent=1) + "\n")
    return summary


def read_summary(folder):
    """The content of ``mesh.json`` in ``folder``; :class:`FemError` unless it is that of a mesh stage."""
    path = Path(folder) / "mesh.json"
    try:
        meshed = read_json(path)
    except FemError as error:
        raise FemError(f"{path}: run the mesh stage first ({error})") from error
    known = {"gmsh": str, "options": dict, "contact_ends_c": list, "smallest_c": dict, "axes_c": dict, "bodies": dict,
             "seconds": dict, "cpu_seconds": float}
    whole = isinstance(meshed, dict) and all(isinstance(meshed.get(k), kind) for k, kind in known.items())
    if not whole or not _is_whole(meshed):
        raise FemError(f"{path}: is not what the mesh stage writes; run the mesh stage again")
    return meshed


def _is_whole(meshed):
    """Whether what is read of ``mesh.json`` later holds numbers: the axes ascending ones."""
    axes = [meshed["axes_c"].get(name) for name in ("x_contact", "y_contact", "z_block")]
    ascending = all(
        isinstance(axis, list) and len(axis) > 1 and all(map(is_finite, axis)) and sorted(set(axis)) == axis
        for axis in axes
    )
    counts = [body.get("unknowns") if isinstance(body, dict) else None for body in meshed["bodies"].values()]
    return ascending and all(map(is_finite, [*meshed["seconds"].values(), *counts]))
