"""Cases."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from edgeline import _native as native


def _merged(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    """The tables `old` with what `new` changes in them."""
    merged = dict(old)
    for key, value in new.items():
        merged[key] = value
        before = old.get(key)
        if isinstance(value, Mapping) and isinstance(before, Mapping):
            kind = before.get("kind")
            # Another kind of profile has other keys.
            if value.get("kind", kind) == kind:
                merged[key] = _merged(before, value)
    return merged


def native_of(case: object) -> native.Case:
    """The native part of a case.

    Raises `TypeError` for what is no case.
    """
    if isinstance(case, Case):
        return case._native
    raise TypeError(
        f"{case!r} is no Case: give edgeline.Case(...), or edgeline.Case.from_toml(...) with a "
        "file's path or the name of a built-in case"
    )


class Case:
    """A contact problem in SI units, read and checked as the command line does.

    `Case(**tables)` takes what a case file holds: `name`, and a dict for each of
    its tables. What is None counts as absent. Lengths and load are given either
    with `load`, as here, or by the factors W, S_l and L_r with `dimensionless`.

        Case(
            name="roller",
            roller={"radius_m": 10e-3, "length_m": 10e-3, "young_pa": 210e9, "poisson": 0.3},
            block={"length_m": 20e-3, "young_pa": 210e9, "poisson": 0.3},
            load={"force_n": 10e3},
        )

    A case cannot be changed; `changed` makes another one. Cases can be compared,
    pickled and used as keys. Files that a case names, of a profile or of heights,
    are read when it is made, and read again by `changed` and where it is unpickled.

    Raises `edgeline.Error` for an unknown or missing key and for a value that is
    not legal, and `TypeError` for a value of a type that no case file holds.
    `cases/README.md` of the project lists all keys.
    """

    __slots__ = ("_native",)
    _native: native.Case

    def __init__(self, **tables: Mapping[str, Any] | str | None) -> None:
        self._native = native.Case.from_tables(tables)

    @classmethod
    def from_toml(cls, path_or_text: str | os.PathLike[str]) -> Case:
        """Reads a case file.

        `path_or_text` is the path of a case file, the name of a built-in case
        (`"flush-short"`) or of one of a built-in study (`"w1e-3_sl5_lr1"`), or the
        text of a case file: a string with a line break or an equals sign is a text.

        Raises `edgeline.Error` that names the file, the line and the key.
        """
        text = path_or_text if isinstance(path_or_text, str) else None
        if text is not None and ("\n" in text or "=" in text):
            return cls._of(native.Case.from_text(text))
        return cls._of(native.Case.from_path(path_or_text))

    @classmethod
    def _of(cls, checked: native.Case) -> Case:
        case = cls.__new__(cls)
        case._native = checked
        return case

    @property
    def name(self) -> str:
        """The case's name."""
        return self._native.name

    @property
    def tables(self) -> dict[str, Any]:
        """The case file as a dict, with lengths and load in SI units.

        `Case(**case.tables)` is the same case.
        """
        tables: dict[str, Any] = json.loads(self._native.to_json())
        return tables

    @property
    def hertz(self) -> dict[str, float]:
        """The scales of the Hertz line contact.

        `e_star_pa` is the contact modulus, `c_m` the half-width C and `p0_pa` the
        maximum pressure.

        They follow from a force: a case with `approach_m` has none, its solution
        has them in `Solution.summary`.

        Source: Johnson, Contact Mechanics, 1985, Eqs. 4.43 to 4.45.
        """
        scales: dict[str, float] = json.loads(self._native.hertz())
        return scales

    @property
    def factors(self) -> dict[str, float]:
        """The factors `W` = w / (E* R L), `S_l` = L / (2 C) and `L_r` = L1 / L2.

        L is the length of the shorter body, R the equivalent radius.
        """
        return dict(zip(("W", "S_l", "L_r"), self._native.factors(), strict=True))

    def to_toml(self) -> str:
        """The text of the case file, to the last digit."""
        return self._native.to_toml()

    def changed(self, **tables: Mapping[str, Any] | str | None) -> Case:
        """The case with these keys changed, the others kept.

            case.changed(name="heavier", load={"force_n": 20e3})

        A key that becomes None is removed; a profile of another `kind` takes the
        place of the old one. Lengths and load are those of `Case.tables`, in SI
        units.
        """
        return type(self)(**_merged(self.tables, tables))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self._native.same(other._native)

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __reduce__(self) -> tuple[Any, ...]:
        return Case.from_toml, (self.to_toml(),)

    def __repr__(self) -> str:
        approach_m = self.tables["load"].get("approach_m")
        if approach_m is not None:
            return f"<edgeline.Case {self.name}: approach {approach_m:.4g} m>"
        factors = ", ".join(f"{name} {value:.4g}" for name, value in self.factors.items())
        return f"<edgeline.Case {self.name}: {factors}>"
