"""Solving a case, and asking its solution."""

from __future__ import annotations

import json
import os
import warnings
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from edgeline import _native
from edgeline._case import Case, native_of
from edgeline._native import Error

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

#: The stress components in their order: the last axis of `Solution.stress`.
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


def solve(
    case: Case,
    method: str = "quarter-space",
    tolerance: float | None = None,
    engine: str | None = None,
) -> Solution:
    """Solves a case.

    `method` says how the free ends of the bodies are modelled: `"half-space"`,
    `"mirror"`, `"guilbault"` or `"quarter-space"`, the one to use.
    `tolerance` is the requested accuracy as a fraction of p0, in place of the
    case's own. `engine` is that of `edgeline solve --engine`: `"line"`, or
    `"cells"`, of which `tolerance` is the relative residual. The default is
    `"cells"` for a case with a rough surface, else `"line"`.

    Takes some 10 ms at a tolerance of 1e-2 and 25 to 45 ms at 1e-3. The
    interpreter's lock is released. A solve has all processors; beside another
    one, of another Python thread, it has one.

    Warns (`UserWarning`) where the program would: of a solution that is not
    `converged`, is `coarser` than its resolution or has a `profile_residual`, and
    of a tolerance below the finest.

    Raises `edgeline.Error` for a case that cannot be solved, and `TypeError` for
    what is no case.
    """
    solved = _native.solve(native_of(case), method, tolerance, engine)
    for warning in solved.warnings():
        warnings.warn(warning, stacklevel=2)
    return Solution(case, solved)


def von_mises(stress: ArrayLike) -> NDArray[np.float64]:
    """Von Mises equivalent stress, sqrt(3 J2).

    `stress` has shape (..., 6), as `Solution.stress` returns it; the result has
    shape (...) and the same unit.
    """
    xx, yy, zz, xy, xz, yz = np.moveaxis(np.asarray(stress, dtype=np.float64), -1, 0)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    found: NDArray[np.float64] = np.sqrt(0.5 * normal + 3.0 * (xy**2 + xz**2 + yz**2))
    return found


class Solution:
    """The solution of a case by one method, as `solve` returns it.

    It stands by itself: it holds no file and no reference to anything that could
    go. All numbers are in SI units.
    """

    def __init__(self, case: Case, native: _native.Solution) -> None:
        self._case = case
        self._native = native

    @property
    def case(self) -> Case:
        """The case."""
        return self._case

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The results in numbers: what `edgeline solve` writes into `summary.json`.

        Among them `p_centre_pa`, `p_max_pa` and its place `p_max_at_m` (x, y),
        `approach_m`, `load_n`, `hertz` (`c_m`, `p0_pa`, `e_star_pa`), the most
        stressed place `critical` (`body`, `measure`, `value_pa`, `at_m`), and
        `converged`.

        `p_max_pa` is the largest mean pressure of a cell: at a singular end
        (`edge` in `details`) it tells no more than how narrow the cells are.
        """
        summary: dict[str, Any] = json.loads(self._native.summary())
        return summary

    @cached_property
    def tables(self) -> dict[str, dict[str, NDArray[Any]]]:
        """All tables that `edgeline solve` writes as CSV files, by the files' names.

        Each is a dict of the columns by their names: arrays of one length, of
        float64 or of texts. `pandas.DataFrame(solution.tables["curves"])` is the
        file `curves.csv`.
        """
        tables = self._native.tables()
        return {
            name: {column: np.asarray(values) for column, values in table.items()}
            for name, table in tables.items()
        }

    @property
    def curves(self) -> dict[str, NDArray[Any]]:
        """Stresses on the standard curves of both bodies: the columns of `curves.csv`.

        `body` and `curve` (texts) name the curve of each point; `x_m`, `y_m` and
        `z_m` are its place, `sigma_xx_pa` to `sigma_yz_pa`, `von_mises_pa` and
        `tau_max_pa` its stress.
        """
        return self.tables["curves"]

    @property
    def cells(self) -> dict[str, NDArray[Any]]:
        """The contact pressure: the columns of `pressure.csv`.

        `x_m`, `y_m`, the sides `dx_m`, `dy_m`, and the mean pressure `p_pa`. The
        sum of p dx dy is the load. By the engine along a line, y is a node and
        dy its weight: there, neighbours along y do not join as cells do.
        """
        return self.tables["pressure"]

    @property
    def line_load(self) -> dict[str, NDArray[Any]] | None:
        """The load per length along the contact: the columns of `line_load.csv`.

        None where the program writes no such file.
        """
        return self.tables.get("line_load")

    def pressure(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
        """Contact pressure (Pa) at x, y (m), 0 outside the contact.

        `x` and `y` broadcast; the result has their common shape.

        Raises `edgeline.Error` that names the first point that is not finite.
        """
        x, y = np.broadcast_arrays(*(np.asarray(v, dtype=np.float64) for v in (x, y)))
        found = self._native.pressure(x.ravel(), y.ravel())
        return found.reshape(x.shape)

    def stress(self, body: str, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> NDArray[np.float64]:
        """Stresses (Pa) of `body`, `"block"` or `"roller"`, at x, y, z (m).

        z is the depth into that body, >= 0. `x`, `y` and `z` broadcast; the result
        has their common shape and a last axis of 6: xx, yy, zz, xy, xz, yz. The
        roller's stresses include what its round shape adds to first order.

        For all points of a grid `to_xarray` takes less time.

        Raises `edgeline.Error` that names the first point outside the body.
        """
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=np.float64) for v in (x, y, z)))
        found = self._native.stress(body, x.ravel(), y.ravel(), z.ravel())
        return found.reshape((*x.shape, 6))

    def write(self, folder: str | os.PathLike[str]) -> None:
        """Writes the files of `edgeline solve` into `folder`.

        The folder is made if it is not there. Raises `edgeline.Error` where it
        cannot be written, or another run writes it.
        """
        if not os.fspath(folder):
            raise Error("folder = '' is not valid: it is no folder; give '.' for the current one")
        self._native.write(folder)

    def to_xarray(
        self,
        x: ArrayLike,
        y: ArrayLike,
        z: ArrayLike | None = None,
        body: str = "block",
    ) -> xarray.Dataset:
        """The solution on a grid as an xarray.Dataset.

        It has every combination of `x`, `y` and `z` (m), each a scalar or 1-D.

        Without `z` it holds the contact pressure `p_pa` over (x, y); with `z` the
        stresses `sigma_xx_pa` to `sigma_yz_pa` of `body` over (x, y, z), and
        `von_mises_pa`. The coordinates are `x_m`, `y_m` and `z_m`. Needs xarray.
        """
        from edgeline import _fields

        return _fields.dataset(self, self._native, x, y, z, body)

    def plot(self, curve: str | None = None, body: str = "block", ax: Axes | None = None) -> Axes:
        """Draws the pressure along the contact line, or the stresses on a curve.

        `curve` is one of `solution.curves["curve"]`, for example `"depth-centre"`,
        of `body`. Draws into `ax`, a new figure by default, and returns it. Needs
        matplotlib.
        """
        from edgeline import _fields

        if curve is None:
            return _fields.plot_pressure(self, ax)
        return _fields.plot_curve(self, curve, body, ax)

    def __repr__(self) -> str:
        summary = self.summary
        return (
            f"<edgeline.Solution {summary['case']} by {summary['method']}: "
            f"p_centre {summary['p_centre_pa']:.4g} Pa>"
        )
