"""What `edgeline extras` writes: schemas that tell cases as the program does, completions, manuals."""

from __future__ import annotations

import json
import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

import edgeline

CASES = Path(__file__).parents[2] / "cases"


@pytest.fixture(scope="module")
def extras(program: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("extras")
    done = program("extras", "--out", folder)
    assert done.returncode == 0, done.stderr
    return folder


def validator(path: Path) -> Any:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(path.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def test_the_schema_takes_every_case_and_both_forms(extras: Path) -> None:
    schema = validator(extras / "case.schema.json")
    files = {path: tomllib.loads(path.read_text()) for path in CASES.glob("*.toml")}
    # A study names what it is made of; a case does not.
    cases = {path: tables for path, tables in files.items() if not {"factors", "cases"} & tables.keys()}
    assert len(cases) >= 6
    for path, tables in cases.items():
        schema.validate(tables)
        schema.validate(edgeline.Case.from_toml(path).tables)


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [
        ("roller", "radius", 1.0),
        ("roller", "radius_m", -1.0),
        ("roller", "young_pa", "210e9"),
        ("block", "poisson", 0.5),
        ("block", "length_m", None),
        ("block", "radius_m", 0.0),
        ("roller", "profile", {"kind": "logarithmic", "amplitude_m": 2e-6}),
        ("roller", "profile", {"kind": "crown", "radius_m": 5.0, "k": 0.9}),
        ("roller", "profile", {"kind": "table"}),
        ("load", "force_n", None),
        ("dimensionless", "W", 1e-4),
        ("accuracy", "tolerance", 2.0),
    ],
)
def test_the_schema_and_the_program_refuse_the_same(
    extras: Path, table: str, key: str, value: Any
) -> None:
    schema = validator(extras / "case.schema.json")
    tables = edgeline.Case.from_toml("half-short").tables
    values = {**tables.get(table, {}), key: value}
    tables[table] = {key: value for key, value in values.items() if value is not None}
    assert list(schema.iter_errors(tables)), "the schema takes it"
    with pytest.raises(edgeline.Error):
        edgeline.Case(**tables)


def test_the_schema_of_the_summary_fits(extras: Path, solution: edgeline.Solution) -> None:
    schema = validator(extras / "summary.schema.json")
    schema.validate(solution.summary)
    summary = {**solution.summary, "p_max_pa": "much"}
    assert list(schema.iter_errors(summary))


def test_completions_and_manuals_know_the_commands(extras: Path) -> None:
    for shell, name in (("bash", "edgeline.bash"), ("fish", "edgeline.fish"), ("zsh", "_edgeline")):
        path = extras / name
        text = path.read_text()
        assert "--tolerance" in text or "tolerance" in text
        assert "sweep" in text and "extras" in text
        if shutil.which(shell):
            checked = subprocess.run([shell, "-n", path], capture_output=True, check=False)
            assert checked.returncode == 0, checked.stderr
    manual = (extras / "edgeline-solve.1").read_text()
    assert manual.startswith((".ie", ".TH")) and "edgeline\\-solve" in manual
    assert "\\-\\-tolerance" in manual
