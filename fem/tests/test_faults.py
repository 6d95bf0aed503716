"""A gmsh that fails in every way there is, and records that are damaged or half-written."""

import json
import os
import re
import shutil
import subprocess
import sys
import time

import pytest

from conftest import FEM, run_stage, steel_case
from edgeline_fem.meshing import read_msh
from edgeline_fem.record import (
    FILES, NEW, SUMS, _commit, check_record, checksums, read_cases, record, standard_request,
)
from edgeline_fem.request import FemError


def _mesh(folder, script):
    """The mesh stage with a shell script for gmsh that knows its version; ``$out`` is the file to write."""
    gmsh = folder / "gmsh"
    gmsh.write_text(f'#!/bin/sh\n[ "$1" = --version ] && {{ echo 4.8.4; exit 0; }}\n'
                    f'for word in "$@"; do [ "$last" = -o ] && out=$word; last=$word; done\n{script}\n')
    gmsh.chmod(0o755)
    asked = {**standard_request(steel_case(5e-4, 5.0, 1.0), 4.0).to_json(), "gmsh": str(gmsh)}
    request = folder / "request.json"
    request.write_text(json.dumps(asked))
    return run_stage("mesh", request, folder / "out")


@pytest.mark.parametrize(("script", "wanted"), [
    ("echo no mesh today >&2; exit 3", "(exit code 3): no mesh today"),
    ("kill -9 $$", "(exit code -9)"),
    ("exit 0", "gmsh failed on"),
    ("head -c 5000 /dev/urandom > $out", "is not a mesh that this program wrote"),
    ("printf '$PhysicalNames\\n0\\n$EndPhysicalNames\\n$Nodes\\n-5\\n' > $out", "is not a mesh"),
    (": > $out", "is not a mesh"),
    ("printf '\\377\\376 Error: nonsense'; : > $out", "Error: nonsense"),
    ("exec yes", "printed more than 1 MiB and was stopped"),
])
def test_a_gmsh_that_fails_is_told(tmp_path, script, wanted):
    done = _mesh(tmp_path, script)
    assert done.returncode == 2, done.stderr
    assert wanted in done.stderr and "Traceback" not in done.stderr
    assert not (tmp_path / "out" / "mesh.json").exists()


@pytest.mark.parametrize("script", ["exit 1", "kill -9 $$", "exit 0", "exec yes"])
def test_a_gmsh_without_a_version_is_told(tmp_path, script):
    gmsh = tmp_path / "gmsh"
    gmsh.write_text(f"#!/bin/sh\n{script}\n")
    gmsh.chmod(0o755)
    asked = {**standard_request(steel_case(5e-4, 5.0, 1.0), 4.0).to_json(), "gmsh": str(gmsh)}
    (tmp_path / "request.json").write_text(json.dumps(asked))
    done = run_stage("mesh", tmp_path / "request.json", tmp_path / "out")
    assert done.returncode == 2 and "Traceback" not in done.stderr, done.stderr
    assert str(gmsh) in done.stderr


def test_what_a_hanging_gmsh_prints_is_in_the_log(tmp_path):
    """The stage is killed at its time limit: what the log has not got by then is lost."""
    log = tmp_path / "log"
    code = ("from edgeline_fem.programs import run_program\n"
            "run_program(['sh', '-c', 'echo node 7; echo edge 3 >&2; exec sleep 600'], 'gmsh')\n")
    environment = {**os.environ, "PYTHONPATH": str(FEM)}
    with log.open("wb") as file:
        stage = subprocess.Popen([sys.executable, "-c", code], stderr=file, env=environment)
    until = time.monotonic() + 30
    while log.read_bytes() != b"node 7\nedge 3\n" and time.monotonic() < until:
        time.sleep(0.02)
    stage.kill()
    stage.wait()
    assert log.read_bytes() == b"node 7\nedge 3\n"


def test_meshes_that_were_cut_or_changed_are_refused(live):
    """A real mesh, cut at many places and with single bytes changed: refused or read, never a crash."""
    path = live[2] / "block.msh"
    data = path.read_bytes()
    damaged = live[2] / "damaged.msh"
    for part in range(1, 40):
        damaged.write_bytes(data[: len(data) * part // 40])
        with pytest.raises(FemError, match="is not a mesh that this program wrote"):
            read_msh(damaged)
    for part in range(200):
        at = (part * 7919) % 4000 if part % 2 else len(data) * part // 200
        damaged.write_bytes(data[:at] + bytes([data[at] ^ 0x81]) + data[at + 1 :])
        try:
            read_msh(damaged)
        except FemError:
            pass


def _copy(folder):
    """A copy of a record, with checksums that fit."""
    target = folder / "test"
    shutil.copytree(FEM.parent / "results/reference/centre", target)
    return target


# The names of the cases of cases/profiled.toml; its centre is recorded beside that of the default study.
PROFILED = r"w1e-[34]_sl(5|10)_lr(0\.5|1)_drop(0\.5|3)_ecc0(\.05)?|profiled-centre"


def test_every_record_is_what_was_recorded():
    folders = [path.parent for path in (FEM.parent / "results/reference").glob("*/record.json")]
    # Those of cases.toml, those kept from runs of case files, and those of the study `profiled`.
    listed = set(read_cases(FEM.parent / "results/reference/cases.toml"))
    files = {path.stem for path in (FEM.parent / "cases").glob("*.toml")}
    names = {folder.name for folder in folders}
    studied = {name for name in names if re.fullmatch(PROFILED, name)}
    assert len(studied) == 17
    assert listed <= names <= listed | files | studied
    for folder in folders:
        check_record(folder)


@pytest.mark.parametrize("name", [*FILES, SUMS])
def test_a_damaged_record_is_not_added_to(tmp_path, name):
    target = _copy(tmp_path)
    path = target / name
    path.write_bytes(path.read_bytes()[:-2] + b"1\n")
    with pytest.raises(FemError, match="was changed or is damaged; restore the folder"):
        record(steel_case(5e-4, 5.0, 1.0), 3.0, tmp_path, print)
    os.remove(path)
    with pytest.raises((FemError, OSError)):
        check_record(target)


@pytest.mark.parametrize("moved", range(5))
def test_a_record_is_the_old_or_the_new_one(tmp_path, moved):
    """A recorder killed while it moves a new version into place: the next one moves the rest."""
    target = _copy(tmp_path)
    new = target / NEW
    new.mkdir()
    for name in FILES:
        (new / name).write_bytes((target / name).read_bytes() + b"\n")
    wanted = checksums(new)
    old = checksums(target)
    # Without its checksums the new version is not complete, and is dropped.
    _commit(target)
    assert not new.exists() and checksums(target) == old
    new.mkdir()
    for name in FILES:
        (new / name).write_bytes((target / name).read_bytes() + b"\n")
    (new / SUMS).write_text(wanted)
    for name in [*FILES, SUMS][:moved]:
        os.replace(new / name, target / name)
    if 0 < moved < 4:
        with pytest.raises(FemError):
            check_record(target)
    _commit(target)
    check_record(target)
    assert not new.exists() and checksums(target) == wanted
