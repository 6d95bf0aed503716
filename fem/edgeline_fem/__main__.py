"""Command line of the package; see docs/fem.md for the protocol."""

import argparse
import json
import logging
import os
import sys
from pathlib import Path

# One thread per process: ranks and jobs run in parallel, and BLAS reads this when it is
# loaded.
os.environ.setdefault("OMP_NUM_THREADS", "1")

from .lifetime import follow_driver  # noqa: E402
from .request import ENGINES, FemError, read_request  # noqa: E402


def _log(text):
    print(text, file=sys.stderr, flush=True)


def _mesh(arguments):
    from .meshing import make_meshes

    summary = make_meshes(read_request(arguments.request), arguments.folder)
    for body, data in summary["bodies"].items():
        _log(f"{body}: {data['elements']} elements, {data['unknowns']} unknowns, scaled Jacobian at least "
             f"{data['quality_min']:.2f}, {summary['seconds'][body]:.1f} s")


def _deck(arguments):
    from .deck import FILES, write_deck

    bodies, _ = write_deck(read_request(arguments.request), arguments.folder)
    _log(f"wrote {', '.join(FILES)}: {sum(len(body.cells) for body in bodies.values())} elements, "
         f"{3 * sum(len(body.points) for body in bodies.values())} unknowns")


def _points(arguments):
    from .points import write_points

    path, count = write_points(read_request(arguments.request), arguments.folder, arguments.job)
    _log(f"wrote {path}: {count} points")


def _solve(arguments):
    request = read_request(arguments.request)
    if request.large_displacements:
        raise FemError(f"{arguments.request}: large displacements are for the deck alone: run its model.inp, then `points`")
    summary = _by_calculix(request, arguments) if request.engine == "calculix" else _by_fenicsx(request, arguments)
    if summary is not None:
        _log(f"done: {summary['unknowns']} unknowns, {summary['seconds']['total']:.1f} s, "
             f"{summary['peak_memory_mib'] / 1024:.2f} GiB")


def _by_calculix(request, arguments):
    from .calculix import solve_case

    return solve_case(request, arguments.folder, _log)


def _by_fenicsx(request, arguments):
    """The summary on rank 0, nothing on the others."""
    from mpi4py import MPI

    from .model import solve_case

    comm = MPI.COMM_WORLD
    summary = solve_case(request, arguments.folder, comm, _log if comm.rank == 0 else lambda text: None)
    return summary if comm.rank == 0 else None


def _probe(arguments):
    from .meshing import gmsh_version
    from .model import versions

    try:
        gmsh = gmsh_version(arguments.gmsh)
    except FemError:
        gmsh = None
    print(json.dumps({**versions(), "gmsh": gmsh}))


def _keep(arguments):
    from .record import keep

    keep(arguments.runs, arguments.folder, _log, arguments.study)


def _cases(arguments):
    from .record import read_cases

    print("\n".join(read_cases(arguments.folder / "cases.toml")))


def _record(arguments):
    from .record import Run, read_cases, record

    listed = arguments.list or arguments.folder / "cases.toml"
    cases = read_cases(listed)
    names = arguments.cases or list(cases)
    unknown = [name for name in names if name not in cases]
    if unknown:
        raise FemError(f"there is no case '{unknown[0]}' in {listed}; known are {', '.join(cases)}")
    run = Run(arguments.linear, arguments.ranks, arguments.engine, arguments.launcher)
    # Coarse meshes of all cases come first, so that an early stop leaves a result for
    # every case.
    for size in sorted(arguments.sizes, reverse=True):
        for name in names:
            _log(f"{name}, size {size:g}")
            if not record(cases[name], size, arguments.folder, _log, run):
                _log("recorded already")


def main():
    """Run one subcommand; exit code 2 with one message if it cannot be done."""
    follow_driver()
    parser = argparse.ArgumentParser(prog="edgeline_fem", description=sys.modules[__package__].__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, run, what in (
        ("mesh", _mesh, "write .geo files and run gmsh on them"),
        ("deck", _deck, "write the input deck for CalculiX and Abaqus from the meshes"),
        ("solve", _solve, "solve the contact and write curves.csv, pressure.csv and fem.json"),
    ):
        command = commands.add_parser(name, help=what)
        command.add_argument("request", help="JSON file that describes the calculation")
        command.add_argument("folder", help="folder of the meshes and results")
        command.set_defaults(run=run)
    command = commands.add_parser("points", help="write a CalculiX run's stresses at integration points as curves")
    command.add_argument("request", help="request.json of the deck")
    command.add_argument("folder", help="folder of the deck, where CalculiX has run")
    command.add_argument("--job", default="model", help="the run, without .inp (default: model)")
    command.set_defaults(run=_points)
    command = commands.add_parser("record", help="add meshes of cases to the recorded reference curves")
    command.add_argument("folder", type=Path, help="folder with cases.toml, one subfolder a case")
    command.add_argument("--cases", nargs="+", help="names of cases; all of cases.toml if left out")
    command.add_argument("--list", type=Path, help="file of the cases (default: cases.toml of the folder)")
    command.add_argument("--engine", choices=ENGINES, default=ENGINES[0], help="code (default: %(default)s)")
    command.add_argument("--sizes", nargs="+", type=float, default=[2.0, 1.4, 1.0],
                         help="mesh sizes, 1 is the production mesh (default: 2 1.4 1)")
    command.add_argument("--linear", choices=("direct", "iterative"), default="direct",
                         help="linear solver (default: direct)")
    command.add_argument("--ranks", type=int, default=1, help="MPI ranks of the solve stage (default: 1)")
    command.add_argument("--launcher", default="mpirun -n {ranks}",
                         help="what starts the ranks (default: 'mpirun -n {ranks}')")
    command.set_defaults(run=_record)
    command = commands.add_parser("keep", help="add finished runs of `edgeline fem` to the recorded curves")
    command.add_argument("folder", type=Path, help="folder of the records, one subfolder a case")
    command.add_argument("runs", nargs="+", type=Path, help="output folders of finished runs")
    command.add_argument("--study", help="built-in study of the cases, for the command in the record")
    command.set_defaults(run=_keep)
    command = commands.add_parser("cases", help="list the names of the cases that can be recorded")
    command.add_argument("folder", type=Path, help="folder with cases.toml")
    command.set_defaults(run=_cases)
    command = commands.add_parser("probe", help="print the versions of what is installed, as JSON")
    command.add_argument("--gmsh", default="gmsh", help="name or path of the gmsh program")
    command.set_defaults(run=_probe)
    arguments = parser.parse_args()
    # The form compiler's progress would hide ours.
    logging.getLogger().setLevel(logging.WARNING)
    try:
        arguments.run(arguments)
    except (FemError, OSError) as error:
        _log(f"error: {error}")
        # Under MPI the other ranks may be waiting for this one.
        mpi = sys.modules.get("mpi4py.MPI")
        if mpi is not None and mpi.COMM_WORLD.size > 1:
            mpi.COMM_WORLD.Abort(2)
        sys.exit(2)


if __name__ == "__main__":
    main()
