"""Cases: the same reader, the same checks and the same words as the command line's."""

from __future__ import annotations

import pickle
from collections import UserDict
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

import edgeline

TEXT = """
name = "roller"
[roller]
radius_m = 10e-3
length_m = 10e-3
young_pa = 210e9
poisson = 0.3
[block]
length_m = 20e-3
young_pa = 210e9
poisson = 0.3
[load]
force_n = 10e3
"""


def tables() -> dict[str, Any]:
    steel = {"young_pa": 210e9, "poisson": 0.3}
    return {
        "name": "roller",
        "roller": {"radius_m": 10e-3, "length_m": 10e-3, **steel},
        "block": {"length_m": 20e-3, **steel},
        "load": {"force_n": 10e3},
    }


def test_text_file_and_tables_are_the_same_case(tmp_path: Path) -> None:
    path = tmp_path / "roller.toml"
    path.write_text(TEXT)
    cases = [
        edgeline.Case.from_toml(TEXT),
        edgeline.Case.from_toml(path),
        edgeline.Case.from_toml(str(path)),
        edgeline.Case(**tables()),
        edgeline.Case.from_toml(edgeline.Case.from_toml(TEXT).to_toml()),
        edgeline.Case(**edgeline.Case.from_toml(TEXT).tables),
        pickle.loads(pickle.dumps(edgeline.Case.from_toml(TEXT))),
    ]
    assert len(set(cases)) == 1
    assert cases[0].name == "roller" and "roller" in repr(cases[0])
    assert cases[0].factors["L_r"] == 0.5


def test_numbers_of_every_kind_are_taken() -> None:
    given = tables()
    given["load"] = {"force_n": np.float32(10e3)}
    given["roller"]["young_pa"] = np.int64(210_000_000_000)
    given["block"]["young_pa"] = 210_000_000_000
    given["accuracy"] = None
    assert edgeline.Case(**given) == edgeline.Case(**tables())
    given["load"] = {"force_n": 10**25}
    with pytest.raises(edgeline.Error, match="force_n = .* is not valid"):
        edgeline.Case(**given)


def test_a_changed_case_keeps_the_rest() -> None:
    case = edgeline.Case(**tables())
    heavier = case.changed(name="heavier", load={"force_n": 20e3})
    assert heavier.tables["load"]["force_n"] == 20e3
    assert heavier.tables["roller"] == case.tables["roller"]
    assert heavier.hertz["c_m"] == pytest.approx(np.sqrt(2.0) * case.hertz["c_m"], rel=1e-12)
    assert heavier != case
    crowned = case.changed(roller={"profile": {"kind": "crown", "radius_m": 2.0}})
    assert crowned.changed(roller={"profile": {"radius_m": 3.0}}).tables["roller"]["profile"] == {
        "kind": "crown",
        "radius_m": 3.0,
    }
    other = {"kind": "logarithmic", "amplitude_m": 1e-6, "k": 0.95}
    assert crowned.changed(roller={"profile": other}).tables["roller"]["profile"]["kind"] == (
        "logarithmic"
    )


@pytest.mark.parametrize(
    ("wrong", "wanted"),
    [
        ({"roler": {}}, "unknown key roler; did you mean roller?"),
        ({"roller": {"radius": 1.0}}, "unknown key roller.radius; did you mean radius_m?"),
        ({"load": {"force_n": "10"}}, 'load.force_n = "10" is not valid: a number belongs here'),
        ({"load": {"force_n": float("nan")}}, "load.force_n = nan is not valid"),
        ({"load": None}, "there is no load"),
        ({"block": 3}, "block = 3 is not valid: a table belongs here"),
        ({"name": "a b"}, "name"),
    ],
)
def test_wrong_tables_are_refused(wrong: dict[str, Any], wanted: str) -> None:
    with pytest.raises(edgeline.Error) as refused:
        edgeline.Case(**{**tables(), **wrong})
    assert str(refused.value).startswith("the case: ") and wanted in str(refused.value)


def test_flags_of_numpy_are_flags() -> None:
    flag: Any = np.bool_(True)
    case = edgeline.Case(**tables(), accuracy={"first_order": flag})
    assert case == edgeline.Case(**tables(), accuracy={"first_order": True})
    for wrong in (flag, True):
        with pytest.raises(edgeline.Error, match="radius_m = true"):
            edgeline.Case(**{**tables(), "roller": {**tables()["roller"], "radius_m": wrong}})


def test_cases_of_studies_have_names() -> None:
    assert edgeline.Case.from_toml("w1e-3_sl5_lr1").factors["W"] == pytest.approx(1e-3)


def test_what_no_file_holds_is_a_type_error() -> None:
    with pytest.raises(TypeError, match="roller.radius_m is larger than any number"):
        edgeline.Case(**{**tables(), "roller": {"radius_m": 10**400}})
    with pytest.raises(TypeError, match="name is no Unicode text"):
        edgeline.Case(**{**tables(), "name": "\ud800"})
    with pytest.raises(TypeError, match="load.force_n is a <class 'object'>"):
        edgeline.Case(**{**tables(), "load": {"force_n": object()}})
    within: dict[str, Any] = {}
    within["load"] = within
    with pytest.raises(TypeError, match="levels deep"):
        edgeline.Case(**within)


@pytest.mark.parametrize(
    "change",
    [
        ("poisson = 0.3", "poisson = 0.6"),
        ("radius_m", "radius"),
        ("[block]\n", ""),
        ("10e3", "10e13"),
        ("name =", "name"),
        ('"roller"', '"no such name"'),
    ],
)
def test_messages_are_those_of_the_command_line(
    change: tuple[str, str], tmp_path: Path, program: Any
) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text(TEXT.replace(*change))
    said = program("solve", path, "--out", tmp_path / "out")
    with pytest.raises(edgeline.Error) as refused:
        edgeline.Case.from_toml(path)
    assert said.returncode == 2
    assert said.stderr == f"error: {refused.value}\n"


def test_a_missing_file_is_told_as_by_the_command_line(tmp_path: Path, program: Any) -> None:
    said = program("solve", tmp_path / "none.toml", "--out", tmp_path / "out")
    with pytest.raises(edgeline.Error) as refused:
        edgeline.Case.from_toml(tmp_path / "none.toml")
    assert said.stderr == f"error: {refused.value}\n"


def test_any_mapping_is_a_table() -> None:
    case = edgeline.Case(**tables())
    views = {
        key: MappingProxyType(value) if isinstance(value, dict) else value
        for key, value in tables().items()
    }
    assert edgeline.Case(**views) == case
    profile = MappingProxyType({"kind": "crown", "radius_m": 5.0})
    crowned = case.changed(roller=UserDict(profile=profile))
    assert crowned.tables["roller"]["profile"] == dict(profile)


def test_cases_with_other_data_in_their_files_are_others(tmp_path: Path) -> None:
    file = tmp_path / "drop.csv"

    def measured(drop_m: float) -> edgeline.Case:
        file.write_text(f"y_m,drop_m\n-5e-3,{drop_m}\n0,0\n5e-3,{drop_m}\n")
        profile = {"kind": "table", "file": str(file)}
        return edgeline.Case(**tables()).changed(roller={"profile": profile})

    case = measured(1e-6)
    assert case == pickle.loads(pickle.dumps(case))
    assert case != measured(8e-6)
    assert case != pickle.loads(pickle.dumps(case)), "the file is read again"
