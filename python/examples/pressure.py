"""The contact pressure of a roller on a longer block, and how much the end of the roller adds."""

import numpy as np

import edgeline

case = edgeline.Case(
    name="roller",
    roller={"radius_m": 10e-3, "length_m": 10e-3, "young_pa": 210e9, "poisson": 0.3},
    block={"length_m": 20e-3, "young_pa": 210e9, "poisson": 0.3},
    load={"force_n": 10e3},
)
solution = edgeline.solve(case, tolerance=1e-2)
distance = case.hertz["c_m"] * np.array([0.1, 0.5, 1.0, 2.0])
for s, p in zip(distance, solution.pressure(0.0, 5e-3 - distance), strict=True):
    print(f"{1e3 * s:.3f} mm from the end: {1e-6 * p:.0f} MPa")
