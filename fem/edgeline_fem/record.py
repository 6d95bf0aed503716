"""Recorded reference curves: several meshes of each case, with provenance and error estimates.

The layout of a record is described in results/reference/README.md.
"""

import contextlib
import csv
import dataclasses
import datetime
import fcntl
import hashlib
import io
import json
import math
import os
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np

from .meshing import write_atomically
from .request import (
    SCHEMA, Case, Curve, FemError, MeshOptions, Request, SolverOptions, check_case_name, material, only_keys, parse_case,
    positive, read_json, read_request, subtable,
)
from .standard_points import EDGE_RANGE, away_from_edge, pressure_lines, standard_curves

COMPONENTS = ("sigma_xx", "sigma_yy", "sigma_zz", "sigma_xy", "sigma_xz", "sigma_yz", "von_mises",
              "tau_max")


def read_cases(path):
    """Cases of a TOML file with one ``[name]`` table each, as ``{name: Case}``.

    A table has ``W``, ``S_l``, ``L_r``, ``friction`` where the bodies slide, and the tables ``roller`` (radius_m, young_pa, poisson) and
    ``block`` (young_pa, poisson). Raises :class:`FemError` that names the case and the key.
    """
    try:
        data = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise FemError(f"{path}: cannot be read: {error}") from error
    return {name: _listed_case(name, table, f"{path}: case {name}") for name, table in data.items()}


def _listed_case(name, table, where):
    """The :class:`Case` of one table of a file of cases."""
    check_case_name(name, where)
    if not isinstance(table, dict):
        raise FemError(f"{where}: must be a table, [{name}], not {table!r}")
    only_keys(table, {"W", "S_l", "L_r", "friction", "roller", "block"}, where)
    for key in ("roller", "block", "W", "S_l", "L_r"):
        if key not in table:
            raise FemError(f"{where} has no '{key}'")
    bodies = {}
    for body, keys in (("roller", {"radius_m"}), ("block", set())):
        bodies[body] = subtable(table, body, where)
        only_keys(bodies[body], keys | {"young_pa", "poisson"}, f"{where}.{body}")
    case = Case.from_dimensionless(
        name, *(positive(table, key, where) for key in ("W", "S_l", "L_r")),
        positive(bodies["roller"], "radius_m", f"{where}.roller"),
        *(material(bodies[body], f"{where}.{body}") for body in ("roller", "block")),
    )
    friction = table.get("friction", 0.0)
    # What follows from the numbers, too, has to be what a request can hold.
    return parse_case({**case.to_json(), "friction": friction}, where)


def standard_request(case, size, **overrides):
    """The request that records ``case`` on the mesh of ``size``: all standard curves and pressures."""
    c_m = case.scales().c_m
    length = case.contact_half_length()

    def metres(points):
        return [[v * c_m for v in point] for point in points]

    curves = [
        Curve(body, name, metres(points))
        for body, own in (("block", case.block_half_length()), ("roller", case.roller_half_length()))
        for name, points in standard_curves(length, own, case.friction > 0.0).items()
    ]
    lines = {name: metres(points) for name, points in pressure_lines(length).items()}
    return Request(case, MeshOptions(size=size, **overrides), SolverOptions(), curves, lines)


def _written(size):
    """``size`` as a record writes it: 1.4 * 1.4 = 1.9599999999999997 is the mesh 1.96."""
    return float(f"{size:g}")


def _rows(path):
    """Header and rows of a CSV file; ``(None, [])`` if there is none."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except FileNotFoundError:
        return None, []
    return (rows[0], rows[1:]) if rows else (None, [])


def _merge(path, size, new, merged):
    """Put the rows of ``new`` into those of the CSV file at ``path`` as the mesh of ``size``: ``merged``."""
    _, old = _rows(path)
    header, rows = _rows(new)
    kept = [row for row in old if float(row[0]) != _written(size)]
    stresses = next(i for i, name in enumerate(header) if name.endswith("_pa"))
    kept += [
        [f"{size:g}", *row[:stresses], *(f"{float(value):.6g}" for value in row[stresses:])] for row in rows
    ]
    kept.sort(key=lambda row: -float(row[0]))  # stable: rows of one mesh stay in order
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["mesh", *header])
    writer.writerows(kept)
    merged.write_text(text.getvalue(), encoding="utf-8")


def order_and_factor(differences, sizes):
    """Observed order q of convergence, and the finest mesh's error relative to the last difference.

    ``differences``: norms of coarse - middle and middle - fine; ``sizes``: the three sizes, descending.
    The error is taken to be a multiple of size^q (Richardson). Returns ``(None, None)`` where the
    differences do not decrease as any order in (0, 8] would have it.
    """
    coarse, middle, fine = sizes
    first, last = differences

    def ratio(order):
        return (coarse**order - middle**order) / (middle**order - fine**order)

    low, high = 1e-3, 8.0
    if last <= 0.0 or not ratio(low) < first / last < ratio(high):
        return None, None
    for _ in range(60):
        order = 0.5 * (low + high)
        low, high = (order, high) if ratio(order) < first / last else (low, order)
    return order, fine**order / (middle**order - fine**order)


def _series(folder, half_length_m, c_m, p0_pa):
    """Curves by name and mesh: ``{(body, curve, component): {size: values}}`` in p0, corner left out."""
    series = {}

    def add(key, mesh, y, z, value):
        if away_from_edge(float(y) / c_m, float(z) / c_m, half_length_m / c_m):
            meshes = series.setdefault(key, {})
            meshes.setdefault(float(mesh), []).append(float(value) / p0_pa)

    _, rows = _rows(Path(folder) / "curves.csv")
    for mesh, body, curve, _, y, z, *values in rows:
        for component, value in zip(COMPONENTS, values):
            add((body, curve, component), mesh, y, z, value)
    _, rows = _rows(Path(folder) / "pressure.csv")
    for mesh, line, _, y, value, *_ in rows:
        add(("contact", line, "pressure"), mesh, y, 0.0, value)
    return {key: {size: np.array(v) for size, v in meshes.items()} for key, meshes in series.items()}


def estimate_errors(folder, half_length_m, c_m, p0_pa):
    """Errors of the finest mesh in ``folder``, one entry a curve and component (units of p0).

    ``difference_max`` and ``difference_rms`` compare the two finest meshes; ``order`` is the observed one
    of the root mean square over the three finest, and ``error_max`` and ``error_rms`` are what Richardson
    makes of it; ``factor`` turns any point's difference into its estimated error. The last four are null
    where the meshes are fewer than three or no order is observed, the last three also where it is below 1.
    """
    found = []
    for (body, curve, component), meshes in sorted(
        _series(folder, half_length_m, c_m, p0_pa).items()
    ):
        sizes = sorted(meshes, reverse=True)[-3:]
        if len(sizes) < 2:
            continue
        last = np.abs(meshes[sizes[-2]] - meshes[sizes[-1]])
        rms = float(np.sqrt(np.mean(last**2)))
        order = factor = None
        # Components that vanish by symmetry have negligible errors.
        if len(sizes) == 3 and rms > 1e-7:
            first = float(np.sqrt(np.mean((meshes[sizes[0]] - meshes[sizes[1]]) ** 2)))
            order, factor = order_and_factor((first, rms), sizes)
            # Quadratic elements have no such order: differences this even are too small to extrapolate.
            if order is not None and order < 1.0:
                factor = None
        entry = {
            "body": body, "curve": curve, "component": component, "sizes": sizes,
            "difference_max": float(last.max()), "difference_rms": rms, "order": order, "factor": factor,
            "error_max": None if factor is None else factor * float(last.max()),
            "error_rms": None if factor is None else factor * rms,
        }
        found.append({k: round(v, 6) if isinstance(v, float) else v for k, v in entry.items()})
    return found


def observed_orders(folder, half_length_m, c_m, p0_pa):
    """Orders of convergence that say in three numbers whether the meshes of ``folder`` converge.

    Each is that of a root mean square over the three finest meshes, null where they show none.
    ``pressure_half_way``: of the pressure at x = 0 around half way between the contact's middle and its end,
    from a quarter to three quarters (at one point two meshes may agree by chance);
    ``depth_centre_block`` and ``depth_centre_roller``: of all six stress components on that curve.
    """
    series = _series(folder, half_length_m, c_m, p0_pa)
    line = series["contact", "along-y", "pressure"]
    sizes = sorted(line, reverse=True)[-3:]
    # The series leaves out the corner, at the line's end; its points are as in pressure_lines.
    y = np.array([point[1] for point in pressure_lines(half_length_m / c_m)["along-y"]])
    around = np.flatnonzero(np.abs(y / y[-1] - 0.5) <= 0.25 + 1e-9)
    values = {"pressure_half_way": [line[size][around] for size in sizes]}
    for body in ("block", "roller"):
        parts = [series[body, "depth-centre", component] for component in COMPONENTS[:6]]
        values[f"depth_centre_{body}"] = [np.concatenate([part[size] for part in parts]) for size in sizes]
    orders = dict.fromkeys(values)
    if len(sizes) == 3:
        for name, (coarse, middle, fine) in values.items():
            differences = np.linalg.norm(coarse - middle), np.linalg.norm(middle - fine)
            order, _ = order_and_factor(differences, sizes)
            orders[name] = None if order is None else round(order, 3)
    return orders


@dataclasses.dataclass(frozen=True)
class Run:
    """How stages are run: the code, its linear solver, and for the solve stage the ranks and what starts them.

    ``launcher`` is the command before the interpreter's when there is more than one rank, with
    ``{ranks}`` for their number.
    """

    linear: str = "direct"
    ranks: int = 1
    engine: str = "fenicsx"
    launcher: str = "mpirun -n {ranks}"

    def command(self, stage):
        """What stands before the stage's arguments."""
        python = [sys.executable, "-m", "edgeline_fem", stage]
        if stage == "mesh" or self.ranks == 1:
            return python
        return [*shlex.split(self.launcher.format(ranks=self.ranks)), *python]


def _stage(stage, run, request, folder, log):
    """Run one stage as a separate process, so that its memory is separate; raise if it fails."""
    command = [*run.command(stage), str(request), str(folder)]
    # The child imports this package from where it was imported here.
    here = str(Path(__file__).resolve().parent.parent)
    paths = [here, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    # What gmsh and CalculiX print is in it, and may be arbitrary bytes.
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, errors="replace", check=False, env=environment)
    if done.returncode != 0:
        tail = "\n".join(done.stderr.strip().splitlines()[-10:])
        raise FemError(f"{request}: stage {stage} failed with exit code {done.returncode}:\n{tail}")
    log(done.stderr.strip().splitlines()[-1])


FILES = ("record.json", "curves.csv", "pressure.csv")
SUMS = "SHA256SUMS"
# Where a new version of a record is put together.
NEW = ".new"


def checksums(folder):
    """SHA-256 of the files of the record in ``folder``, as ``sha256sum`` writes them."""
    sums = ((hashlib.sha256((folder / name).read_bytes()).hexdigest(), name) for name in FILES)
    return "".join(f"{digest}  {name}\n" for digest, name in sums)


def check_record(folder):
    """Raise :class:`FemError` unless the files of the record in ``folder`` are those that were recorded."""
    sums = folder / SUMS
    if not sums.exists() or sums.read_text(encoding="utf-8") != checksums(folder):
        raise FemError(f"{sums}: a file of this record was changed or is damaged; restore the folder from "
                       "version control, or remove it to record anew")


def _commit(target):
    """Move a complete new version of the record in ``target`` into place, if one was left there.

    A new version is put together in a folder of its own; its checksums, written last, say that it is
    complete. So a record is the old or the new version, whenever this process is killed: the next one that
    records moves what is left.
    """
    new = target / NEW
    if (new / SUMS).exists():
        # The checksums last: until then the checksums of the old version refuse the
        # mixture.
        for name in (*FILES, SUMS):
            if (new / name).exists():
                os.replace(new / name, target / name)
    shutil.rmtree(new, ignore_errors=True)


@contextlib.contextmanager
def _locked(folder):
    """Hold the only lock on a folder; raise if another process has it. Freed if this process dies."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise FemError(f"{folder}: another process is recording this case") from error
        yield
    finally:
        os.close(handle)


def record(case, size, folder, log, run=Run(), **overrides):
    """Solve ``case`` on the mesh of ``size`` and add it to the record in ``folder``/<case name>.

    ``run`` is the :class:`Run`, ``overrides`` are further mesh options. Returns False if the record holds
    that mesh already. Other meshes of the record are kept; after a kill at any moment the next call takes up
    where this one was. Raises :class:`FemError` if the record there is damaged, or of another code.
    """
    target = Path(folder) / case.name
    target.mkdir(parents=True, exist_ok=True)
    with _locked(target):
        return _record(case, size, target, log, run, overrides)


def _known(target, form, engine, added):
    """What the record in ``target`` holds, ``None`` if there is none.

    Raises :class:`FemError` if it is damaged, or not of the case ``form`` by the code ``engine``.
    ``added``: what is to be added, for the message.
    """
    _commit(target)
    path = target / "record.json"
    if not path.exists():
        return None
    check_record(target)
    data = json.loads(path.read_text(encoding="utf-8"))
    if data["case"] != form:
        raise FemError(f"{path}: holds another case of that name; remove the folder to record anew")
    # Errors are estimated between meshes of one code. Where none is named it is as in requests.
    others = {mesh.get("engine", Request.engine) for mesh in data["meshes"].values()} - {engine}
    if others:
        raise FemError(f"{path}: holds meshes by {', '.join(sorted(others))}, but {added} is by {engine}; "
                       "give another folder, because each code has its own records")
    return data


def _record(case, size, target, log, run, overrides):
    # The mesh is of the size that the record says.
    size = _written(size)
    data = _known(target, case.to_json(), run.engine, f"size {size:g}")
    request = standard_request(case, size, **overrides)
    request = dataclasses.replace(request, solver=SolverOptions(linear=run.linear), engine=run.engine)
    if data is not None:
        known = data["meshes"].get(f"{size:g}")
        if known is not None:
            # Options that are newer than the record had their defaults then.
            options = MeshOptions(**known["mesh"]["options"])
            # The size of a run that was kept is as it was asked for.
            if dataclasses.replace(options, size=_written(options.size)) == request.mesh:
                return False
    work = target / f".work-{size:g}"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir()
    asked = work / "request.json"
    asked.write_text(json.dumps(request.to_json()), encoding="utf-8")
    began = datetime.datetime.now(datetime.timezone.utc)
    for stage in ("mesh", "solve"):
        _stage(stage, run, asked, work, log)
    command = f"python3 -m edgeline_fem record --cases {case.name} --sizes {size:g}"
    if run.engine != Run.engine:
        command += f" --engine {run.engine} --list results/reference/cases.toml"
    if (run.linear, run.ranks) != (Run.linear, Run.ranks):
        command += f" --linear {run.linear} --ranks {run.ranks}"
    _add(case, case.to_json(), size, data, work, target, (began, f"{command} results/{target.parent.name}"))
    shutil.rmtree(work)
    return True


def _check_summary(path):
    """Raise :class:`FemError` unless ``path`` is the fem.json of a run."""
    summary = read_json(path)
    known = {"schema": int, "case": str, "hertz": dict, "mesh": dict}
    for key, kind in known.items():
        if not isinstance(summary, dict) or not isinstance(summary.get(key), kind):
            raise FemError(f"{path}: '{key}' is missing or of another kind; run it again")
    if summary["schema"] != SCHEMA:
        raise FemError(f"{path}: 'schema' is {summary['schema']}, this program reads {SCHEMA}")
    try:
        json.dumps(summary, allow_nan=False)
    except ValueError as error:
        raise FemError(f"{path}: holds a number that is not finite; run it again") from error


def _check_points(path, asked, names, least):
    """Raise :class:`FemError` unless ``path`` has the points ``asked``, in order, with finite values.

    ``asked``: the texts that name a curve, and the point. ``names``: how many such texts there are;
    ``least``: how many values a point has at least.
    """
    header, rows = _rows(path)
    if header is None or len(rows) != len(asked):
        raise FemError(f"{path}: has {len(rows)} points, the request {len(asked)}; run it again")
    for line, (row, (name, point)) in enumerate(zip(rows, asked), 2):
        try:
            values = [float(value) for value in row[names:]]
        except ValueError:
            values = [math.nan]
        if len(row) != len(header) or len(values) < len(point) + least or not np.isfinite(values).all():
            raise FemError(f"{path}: line {line} has a value that is no finite number, or another number of "
                           "values; run it again")
        # Files have fewer digits than requests.
        near = np.allclose(values[: len(point)], point, rtol=1e-5, atol=1e-5 * np.abs(point).max())
        if tuple(row[:names]) != name or not near:
            raise FemError(f"{path}: line {line} is not the point that the request has there; run it again")


def _finished(work):
    """The run in ``work``: folder, request, and case as a record has it; raise if it cannot be kept."""
    path = work / "request.json"
    request = read_request(path)
    check_case_name(request.case.name, path)
    if not (work / "fem.json").exists():
        raise FemError(f"{work}: has no fem.json: the run is not finished; run it again")
    _check_summary(work / "fem.json")
    curves = [((curve.body, curve.name), point) for curve in request.curves for point in curve.points_m]
    _check_points(work / "curves.csv", curves, 2, len(COMPONENTS))
    lines = [((name,), point) for name, points in request.pressure_points_m.items() for point in points]
    _check_points(work / "pressure.csv", lines, 1, 1)
    case = read_json(path)["case"]
    for body in ("roller", "block"):
        # A record names a profile as the case does; its points follow from that, but not from a table's file.
        points = case[body].pop("profile_m", None)
        kind = (case[body].get("profile") or {}).get("kind")
        if kind == "table" or (kind is None and points is not None):
            raise FemError(f"{path}: the {body}'s profile is a table, whose points no record holds; give the "
                           "profile as a formula (cases/README.md), run the case again and keep that run")
    return work, request, case


def _check_alike(finished):
    """Raise :class:`FemError` where runs of one name are not one case by one code on different meshes."""
    first, sizes = {}, {}
    for work, request, asked in finished:
        name = request.case.name
        known, engine, form = first.setdefault(name, (work, request.engine, asked))
        if form != asked:
            raise FemError(f"{work}: holds another case than {known}, and both are called {name}; give one of them")
        if engine != request.engine:
            raise FemError(f"{work}: is by {request.engine}, but {known} is by {engine}; keep them in two folders, "
                           "because each code has its own records")
        same = sizes.setdefault((name, _written(request.mesh.size)), work)
        if same != work:
            raise FemError(f"{work}: is of the same size as {same}; give one of them")


def keep(runs, folder, log, study=None):
    """Add finished runs of ``edgeline fem``, the folders ``runs``, to the records in ``folder``, one a case.

    ``study``: the built-in study that the cases belong to, for the command in the record. Each run holds
    its request, and so its case: any that the model takes, of several sizes, but for profiles that are
    tables. What a record holds of that size is replaced. Raises :class:`FemError`, before anything is
    written, where a run is not finished, given twice, damaged or has such a profile, and where it is of
    another case or code than its record or than another run of its case.
    """
    folders = [Path(work).resolve() for work in runs]
    twice = [work for work, place in zip(runs, folders) if folders.count(place) > 1]
    if twice:
        raise FemError(f"{twice[0]}: is given twice; give each run once")
    # All are read and checked before the first is added, so that a run that cannot be kept leaves all records alone.
    finished = [_finished(Path(work)) for work in runs]
    _check_alike(finished)
    for work, request, asked in finished:
        target = Path(folder) / request.case.name
        if target.exists():
            with _locked(target):
                _known(target, asked, request.engine, f"the run {work}")
    for work, request, asked in finished:
        target = Path(folder) / request.case.name
        target.mkdir(parents=True, exist_ok=True)
        with _locked(target):
            data = _known(target, asked, request.engine, f"the run {work}")
            began = datetime.datetime.fromtimestamp((work / "request.json").stat().st_mtime, datetime.timezone.utc)
            size = _written(request.mesh.size)
            command = f"edgeline fem cases/{request.case.name}.toml --size {size:g}"
            if study is not None:
                command = f"edgeline study {study} --fem live --size {size:g}"
            _add(request.case, asked, size, data, work, target, (began, command))
        log(f"{request.case.name}, size {size:g}")


def _add(case, form, size, data, work, target, made):
    """Add the run in ``work`` to the record ``data`` in ``target``, new if it is ``None``; ``form`` is the case there.

    ``made``: when, and by which command.
    """
    summary = json.loads((work / "fem.json").read_text(encoding="utf-8"))
    scales = case.scales()
    if data is None:
        data = {
            "schema": 1,
            "case": form,
            "hertz": summary["hertz"],
            "dimensionless": {
                "W": math.pi / (4.0 * scales.radius**2),
                "S_l": case.contact_half_length(),
                "L_r": case.roller_length_m / case.block_length_m,
            },
            "edge_range_c": EDGE_RANGE,
            "meshes": {},
        }
    for key in ("schema", "case", "hertz"):
        summary.pop(key)
    began, command = made
    data["meshes"][f"{size:g}"] = {"date": began.isoformat(timespec="seconds"), "command": command, **summary}
    data["meshes"] = dict(sorted(data["meshes"].items(), key=lambda item: -float(item[0])))
    new = target / NEW
    new.mkdir()
    for name in ("curves.csv", "pressure.csv"):
        _merge(target / name, size, work / name, new / name)
    measures = (new, case.contact_half_length() * scales.c_m, scales.c_m, scales.p0_pa)
    data["orders"] = observed_orders(*measures)
    data["errors"] = estimate_errors(*measures)
    (new / "record.json").write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    write_atomically(new / SUMS, checksums(new))
    _commit(target)
