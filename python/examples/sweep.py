"""The rise of the pressure towards the end against the length of the block."""

import edgeline

base = edgeline.Case.from_toml("half-short")
length_m = base.tables["roller"]["length_m"]
cases = [
    base.changed(name=f"longer-by-{more}", block={"length_m": length_m * (1.0 + more)})
    for more in (0.0, 0.05, 0.1, 0.2, 0.5, 1.0)
]
table = edgeline.sweep(cases, tolerance=1e-2)
for name, ratio in zip(table["case"], table["end_to_centre"], strict=True):
    print(f"{name}: {ratio:.3f}")
