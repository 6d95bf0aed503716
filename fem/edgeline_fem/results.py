"""What the engines' results have in common: tables, and the machine that they come from."""

import csv
import io
import os
import platform
import resource
from pathlib import Path

import numpy as np

from .recovery import invariants

CURVE_HEADER = ("body", "curve", "x_m", "y_m", "z_m",
                *(f"sigma_{c}_pa" for c in ("xx", "yy", "zz", "xy", "xz", "yz")), "von_mises_pa", "tau_max_pa")


def processor():
    """The processor's name as the system states it."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def blas():
    """File name of the BLAS library that this process has loaded."""
    try:
        maps = Path("/proc/self/maps").read_text(encoding="utf-8")
    except OSError:
        return "unknown"
    names = {os.path.realpath(line.split()[-1]) for line in maps.splitlines() if "blas" in line}
    kept = sorted({"/".join(Path(name).parts[-2:]) for name in names if "libblas" in name})
    return kept[0] if kept else "unknown"


def machine_versions():
    """The interpreter's version and the processor."""
    return {"python": platform.python_version(), "processor": processor()}


def peak_memory_kib():
    """Largest resident memory so far of this process or one of its finished children (KiB)."""
    return max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def table(header, rows):
    """CSV text of ``rows``: (names, numbers)."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([*names, *(f"{v:.9g}" for v in numbers)] for names, numbers in rows)
    return text.getvalue()


def curve_table(request, sampler):
    """The rows of curves.csv for :func:`table`."""
    scales, rows = request.case.scales(), []
    for curve in request.curves:
        stress = sampler.stress(curve.body, np.array(curve.points_m) / scales.c_m)
        values = np.hstack([stress, np.stack(invariants(stress), axis=1)]) * scales.p0_pa
        rows += [((curve.body, curve.name), point + list(row)) for point, row in zip(curve.points_m, values)]
    return rows
