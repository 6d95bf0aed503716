"""Solutions as datasets and plots; takes packages that are optional."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from edgeline import _native
from edgeline._native import Error

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

    from edgeline._solution import Solution


def dataset(
    solution: Solution,
    native: _native.Solution,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike | None,
    body: str,
) -> xarray.Dataset:
    """What `Solution.to_xarray` returns."""
    import xarray

    from edgeline._solution import COMPONENTS, von_mises

    places = {"x": x, "y": y} if z is None else {"x": x, "y": y, "z": z}
    # The native grid takes contiguous values only; a scalar becomes an axis of one.
    axes = {name: np.ascontiguousarray(v, dtype=np.float64) for name, v in places.items()}
    for name, values in axes.items():
        if values.ndim > 1:
            raise Error(
                f"{name} of shape {values.shape} is not valid: a grid takes a scalar or 1-D values "
                "along each axis; `Solution.stress` takes points of any shape"
            )
    coordinates = {f"{name}_m": (name, v, {"units": "m"}) for name, v in axes.items()}
    about = {"case": solution.summary["case"], "method": solution.summary["method"]}
    pascals = {"units": "Pa"}
    if z is None:
        pressure = solution.pressure(axes["x"][:, None], axes["y"])
        return xarray.Dataset({"p_pa": (("x", "y"), pressure, pascals)}, coordinates, about)
    found = native.grid(body, axes["x"], axes["y"], axes["z"])
    stress = np.moveaxis(found, 0, -1).transpose(2, 1, 0, 3)
    fields = {
        f"sigma_{name}_pa": (("x", "y", "z"), stress[..., i], pascals)
        for i, name in enumerate(COMPONENTS)
    }
    fields["von_mises_pa"] = (("x", "y", "z"), von_mises(stress), pascals)
    return xarray.Dataset(fields, coordinates, about | {"body": body})


def plot_pressure(solution: Solution, ax: Axes | None) -> Axes:
    """Draws the pressure at x = 0."""
    ax = ax or _axes()
    y = np.unique(solution.cells["y_m"])
    ax.plot(1e3 * y, 1e-6 * solution.pressure(0.0, y), label=solution.summary["method"])
    ax.set(xlabel="y (mm)", ylabel="contact pressure at x = 0 (MPa)")
    ax.set_title(solution.summary["case"])
    return ax


def plot_curve(solution: Solution, curve: str, body: str, ax: Axes | None) -> Axes:
    """Draws the stress components on a standard curve over the coordinate that varies on it."""
    from edgeline._solution import COMPONENTS

    curves = solution.curves
    on_it = (curves["curve"] == curve) & (curves["body"] == body)
    if not on_it.any():
        known = ", ".join(dict.fromkeys(str(name) for name in curves["curve"]))
        raise Error(
            f"curve = {curve!r} of {body!r} is not valid: there is no such standard curve; "
            f"give one of {known}, of the block or the roller"
        )
    ax = ax or _axes()
    axis = max("xyz", key=lambda name: float(np.ptp(curves[f"{name}_m"][on_it])))
    place = 1e3 * curves[f"{axis}_m"][on_it]
    # Curves that lie upon each other have marks at different places.
    every = max(1, len(place) // 8)
    for i, (name, mark) in enumerate(zip(COMPONENTS, "osv^Dx", strict=True)):
        ax.plot(
            place,
            1e-6 * curves[f"sigma_{name}_pa"][on_it],
            label=f"$\\sigma_{{{name}}}$",
            marker=mark,
            markevery=(i * every // len(COMPONENTS), every),
            markersize=5,
        )
    ax.plot(place, 1e-6 * curves["von_mises_pa"][on_it], "k--", label="von Mises")
    ax.set(xlabel=f"{axis} (mm)", ylabel="stress (MPa)", title=f"{body}, {curve}")
    ax.legend()
    return ax


def _axes() -> Axes:
    from matplotlib import pyplot

    _, ax = pyplot.subplots()
    return ax
