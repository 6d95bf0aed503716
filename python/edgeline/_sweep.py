"""Many cases."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, overload

import numpy as np
from numpy.typing import NDArray

from edgeline import _native
from edgeline._case import Case, native_of
from edgeline._native import Error

if TYPE_CHECKING:
    import pandas
    import pyarrow

Progress = bool | Callable[[int, int], object]

MOST = 2**16
"""Most cases that are solved at a time, and most parts of a sweep."""


@overload
def sweep(
    cases: Iterable[Case],
    method: str = ...,
    tolerance: float | None = ...,
    *,
    jobs: int | None = ...,
    shard: tuple[int, int] | None = ...,
    progress: Progress = ...,
    into: Literal["numpy"] = ...,
) -> dict[str, NDArray[Any]]: ...
@overload
def sweep(
    cases: Iterable[Case],
    method: str = ...,
    tolerance: float | None = ...,
    *,
    jobs: int | None = ...,
    shard: tuple[int, int] | None = ...,
    progress: Progress = ...,
    into: Literal["pandas"],
) -> pandas.DataFrame: ...
@overload
def sweep(
    cases: Iterable[Case],
    method: str = ...,
    tolerance: float | None = ...,
    *,
    jobs: int | None = ...,
    shard: tuple[int, int] | None = ...,
    progress: Progress = ...,
    into: Literal["arrow"],
) -> pyarrow.Table: ...
def sweep(
    cases: Iterable[Case],
    method: str = "quarter-space",
    tolerance: float | None = None,
    *,
    jobs: int | None = None,
    shard: tuple[int, int] | None = None,
    progress: Progress = False,
    into: str = "numpy",
) -> Any:
    """Solves many cases on all processors into one table.

    The table has one row for each case, in their order, and the columns of
    `edgeline sweep`: `row` (from 0), `case`, `method`, `tolerance_p0`, pressures
    at the centre and towards the end, approach, the critical stress and its
    place. The unit ends a column's name; `_p0` is a fraction of the Hertz
    pressure. A case that cannot be solved is a row of NaN whose `err` says why.

    `method` and `tolerance` are those of `solve`, for all cases. Cases that
    differ in scale only are solved once. `jobs` is the number of cases solved at
    a time, as many as there are processors by default. `shard`, a pair (i, n)
    with i from 1 to n, solves the i-th of n parts, for several machines; all
    parts together have each case once.

    `progress` is called with the numbers of rows that are done and of all rows,
    in the calling thread; True shows a bar of tqdm. What it raises ends the sweep.

    `into` is `"numpy"` for a dict of arrays, `"pandas"` for a DataFrame or
    `"arrow"` for a pyarrow.Table.
    """
    if into not in ("numpy", "pandas", "arrow"):
        raise Error(
            f"into = {into!r} is not valid: there is no such table; give numpy, pandas or arrow"
        )
    if jobs is not None and not 1 <= operator.index(jobs) <= MOST:
        raise Error(f"jobs = {jobs} is not valid: give from 1 to {MOST} cases at a time")
    # A package that is missing is told before anything is solved.
    texts, made = _makers(into)
    if shard is not None:
        shard = _shard(shard)
    natives = [native_of(case) for case in cases]
    if progress is True:
        with _Bar(len(natives)) as bar:
            rows, table = _native.sweep(natives, method, tolerance, jobs, shard, bar.update)
    else:
        rows, table = _native.sweep(natives, method, tolerance, jobs, shard, progress or None)
    columns = {
        name: values if isinstance(values, np.ndarray) else texts(values)
        for name, values in table.items()
    }
    return made({"row": rows, **columns})


def _makers(into: str) -> tuple[Callable[[list[str]], Any], Callable[[dict[str, Any]], Any]]:
    """What makes a column of texts, which has their type even where it is empty, and a table."""
    if into == "pandas":
        import pandas

        text = pandas.Series([""]).dtype
        return lambda values: pandas.Series(values, dtype=text), pandas.DataFrame
    if into == "arrow":
        import pyarrow

        return lambda values: pyarrow.array(values, pyarrow.string()), pyarrow.table
    return lambda values: np.asarray(values, dtype=np.str_), dict


def _shard(shard: object) -> tuple[int, int]:
    """A part of a sweep, as a pair of whole numbers."""
    match shard:
        # Flags have an index, too, but are no numbers.
        case (SupportsIndex() as part, SupportsIndex() as parts) if not any(
            isinstance(v, bool | np.bool_) for v in (part, parts)
        ):
            # An array has an index by its type, and may have none.
            try:
                pair = operator.index(part), operator.index(parts)
            except TypeError:
                pair = (0, 0)
            if 1 <= pair[0] <= pair[1] <= MOST:
                return pair
    raise Error(
        f"shard = {shard!r} is not valid: give a pair of whole numbers, (1, 3) for the first of "
        "three parts"
    )


class _Bar:
    """A bar of tqdm."""

    def __init__(self, total: int) -> None:
        from tqdm.auto import tqdm

        self._bar = tqdm(total=total, unit="case")

    def update(self, done: int, total: int) -> None:
        self._bar.total = total
        self._bar.update(done - self._bar.n)

    def __enter__(self) -> _Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()
