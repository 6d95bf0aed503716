"""Contact pressure and stresses at the ends of finite line contacts.

A cylindrical roller is pressed on a rectangular block. Both bodies end in free
faces, where a half-space calculation is wrong by a factor of several. This
package solves for the contact pressure and the stresses of both bodies
semi-analytically, by the code of the program `edgeline`.

    import edgeline

    case = edgeline.Case(
        name="roller",
        roller={"radius_m": 10e-3, "length_m": 10e-3, "young_pa": 210e9, "poisson": 0.3},
        block={"length_m": 20e-3, "young_pa": 210e9, "poisson": 0.3},
        load={"force_n": 10e3},
    )
    solution = edgeline.solve(case)
    print(solution.summary["p_centre_pa"])
    print(solution.pressure(0.0, [0.0, 2e-3, 4.9e-3]))
    print(solution.stress("block", 0.0, 0.0, [0.0, 0.2e-3, 0.4e-3]).shape)  # (3, 6)

Conventions
-----------
- All numbers are in SI units: metres, newtons, pascals.
- x runs across the contact, y along the contact line, z into the body at hand
  from its own surface. The origin is on the surface, in the middle of the
  roller's length.
- Stress is positive in tension, pressure in compression. The six components
  stand in the order xx, yy, zz, xy, xz, yz.
- Coordinates are scalars or arrays and broadcast as numpy's functions do.
- What cannot be done raises `edgeline.Error` with the message of the command
  line: what went wrong, where, and what to do.
- The interpreter's lock is released while something is computed, so Python
  threads solve side by side.

The case file is explained in `cases/README.md` of the project, the method in
`docs/theory.md`, this package in `docs/python.md`.
"""

from importlib.metadata import version

from edgeline._case import Case
from edgeline._native import Error
from edgeline._solution import COMPONENTS, Solution, solve, von_mises
from edgeline._sweep import sweep

__version__ = version("edgeline")

__all__ = ["COMPONENTS", "Case", "Error", "Solution", "solve", "sweep", "von_mises"]
