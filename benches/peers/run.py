"""Compare contacts on cells with other codes, on a half-space, which is what all of them know.

    python3 -m venv env && env/bin/pip install -r requirements.txt
    env/bin/python run.py PATH/TO/edgeline --record ../../results/peers.json
    env/bin/python show.py ../../results/peers.json --plot ../../docs/figures/peers.svg

runs every code on the same gaps, loads and grids, each in a process of its own with one thread and with two, and records
the seconds of the contact solve and the relative L1 difference of the pressures. A run of less than 5 s is repeated twice
and the best one counts. A code that exceeds the limit of time is not asked for the finer grids of that problem. Problems: a
cylinder of length 10 C (rectangular grids), and one of length 3 C with self-affine heights (Hurst exponent 0.8, square
grids; even in y, so that no code's bodies tilt). Every code has the tolerance 1e-6, by its own measure. slippy solves for
a given approach, which is taken from this program's pressures.
"""

import argparse
import datetime
import importlib.metadata
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time

import numpy as np

RADIUS, YOUNG, NU, W = 10e-3, 210e9, 0.3, 5e-4
C = 2 * RADIUS * np.sqrt(W / np.pi)
E_STAR = YOUNG / (1 - NU**2) / 2
WIDTH = 1.5 * C
TOLERANCE = 1e-6
CODES = ["edgeline", "tamaas", "ContactMechanics", "aspher", "slippy"]
GRIDS = [("smooth", 64, 128), ("smooth", 128, 256), ("smooth", 256, 512), ("smooth", 512, 1024),
         ("rough", 256, 256), ("rough", 512, 512), ("rough", 1024, 1024)]
SHORT, REPEATS = 5.0, 3


def heights(nx, ny, lx, ly, seed=3):
    """Self-affine heights (m) between wavelengths of 1.2 C and 0.05 C, even in y."""
    rng = np.random.default_rng(seed)
    n, low, high = 256, 2 * np.pi / (1.2 * C), 2 * np.pi / (0.05 * C)
    x = (np.arange(nx) + 0.5) * lx / nx
    y = (np.arange(ny) + 0.5) * ly / ny - 0.5 * ly
    total = np.zeros((nx, ny))
    for _ in range(n):
        # Logarithmically spaced waves: the amplitude of a band falls like q^-0.8.
        q, angle, phase = low * (high / low) ** rng.random(), np.pi * rng.random(), 2 * np.pi * rng.random()
        qx, qy = q * np.cos(angle), q * np.sin(angle)
        a = (q / low) ** -0.8
        total += a * np.cos(qx * x + phase)[:, None] * np.cos(qy * y)[None, :]
    return 1e-7 * total / total.std()


def problem(name, nx, ny):
    slenderness = 5.0 if name == "smooth" else 1.5
    lx, ly = 2 * WIDTH, 2 * slenderness * C
    x = (np.arange(nx) + 0.5) * lx / nx - WIDTH
    rough = heights(nx, ny, lx, ly) if name == "rough" else np.zeros((nx, ny))
    gap = x[:, None] ** 2 / (2 * RADIUS) - rough
    return dict(name=name, slenderness=slenderness, size=[lx, ly], shape=[nx, ny], rough=rough,
                gap=gap, force=W * E_STAR * RADIUS * ly)


def edgeline(p, program, folder):
    nx, ny = p["shape"]
    dx, dy = (size / n for size, n in zip(p["size"], p["shape"]))
    np.save(folder / "heights.npy", p["rough"])
    body = f"young_pa = {YOUNG!r}\npoisson = {NU}\n"
    text = (f'name = "peer"\n[roller]\nradius_m = {RADIUS!r}\n{body}[block]\n{body}[dimensionless]\n'
            f'W = {W!r}\nS_l = {p["slenderness"]}\nL_r = 1.0\n[cells]\nhalf_width_m = {float(WIDTH)!r}\n')
    if p["name"] == "rough":
        text += f'[surface]\nheights = "heights.npy"\ndx_m = {float(dx)!r}\ndy_m = {float(dy)!r}\n'
    (folder / "case.toml").write_text(text)
    out = subprocess.run(
        [program, "solve", folder / "case.toml", "--engine", "cells", "--method", "half-space", "--json",
         "--cells", f"{nx},{ny}", "--tolerance", str(TOLERANCE), "--curve", "depth-centre",
         "--body", "block", "--out", folder / "out"], check=True, capture_output=True)
    found = json.loads(out.stdout)
    return np.load(folder / "out/pressure.npy"), found["seconds"]["contact"] + found["seconds"]["setup"]


def tamaas(p):
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, p["size"], p["shape"])
    model.E, model.nu = E_STAR, 0.0
    start = time.perf_counter()
    tm.ModelFactory.registerNonPeriodic(model, "free")
    solver = tm.PolonskyKeerRey(model, -p["gap"], TOLERANCE)
    solver.setIntegralOperator("free")
    solver.max_iter = 20000
    solver.solve(p["force"] / np.prod(p["size"]))
    return np.array(model.traction), time.perf_counter() - start


def ContactMechanics(p):
    import ContactMechanics as CM
    from ContactMechanics.Optimization import constrained_conjugate_gradients
    from SurfaceTopography import Topography

    topography = Topography(-p["gap"], tuple(p["size"]))
    start = time.perf_counter()
    half = CM.FreeFFTElasticHalfSpace(tuple(p["shape"]), E_STAR, tuple(p["size"]))
    scale = np.sqrt((p["gap"] ** 2).mean())
    found = constrained_conjugate_gradients(
        half, topography, external_force=p["force"], pentol=TOLERANCE * scale, maxiter=20000)
    seconds = time.perf_counter() - start
    nx, ny = p["shape"]
    return np.abs(np.array(found.jac))[:nx, :ny] / np.prod([s / n for s, n in zip(p["size"], p["shape"])]), seconds


def aspher(p):
    import aspher

    (nx, ny), (lx, ly) = p["shape"], p["size"]
    if nx != ny or abs(lx - ly) > 1e-9 * lx:
        raise SystemExit("square grids only")
    start = time.perf_counter()
    solver = aspher.ContactSolver(nx, domain_size=lx, E_star=E_STAR, backend="fft")
    found = solver.solve(p["gap"], p["force"] / (lx * ly), tol=TOLERANCE, precond="fourier")
    seconds = time.perf_counter() - start
    return np.array(found.pressure).reshape(nx, ny), seconds


def slippy(p, wanted):
    import slippy.contact as contact

    steps = [size / n for size, n in zip(p["size"], p["shape"])]
    # One body with the compliance of both: 2 G / (1 - nu) = E*.
    start = time.perf_counter()
    span = [2 * n for n in p["shape"]]
    matrix = contact.elastic_influence_matrix("zz", span, steps[::-1], 0.5 * E_STAR, 0.0)
    product = contact.plan_convolve(np.zeros(p["shape"]), matrix, domain=np.ones(p["shape"], bool))
    pressed = wanted > 0
    approach = (np.asarray(product(wanted.ravel())).reshape(p["shape"]) + p["gap"])[pressed].mean()
    target = (approach - p["gap"]).ravel()
    found, failed = contact.bccg(product, target, TOLERANCE * np.abs(target).max(), 20000,
                                 np.full(target.size, wanted.mean()))
    seconds = time.perf_counter() - start
    if failed:
        raise SystemExit("did not converge")
    return np.asarray(found).reshape(p["shape"]), seconds


def child(code, name, nx, ny, program, folder):
    p, folder = problem(name, nx, ny), pathlib.Path(folder)
    if code == "edgeline":
        pressure, seconds = edgeline(p, program, folder)
        np.save(folder / "wanted.npy", pressure)
    else:
        wanted = np.load(folder / "wanted.npy")
        run = globals()[code]
        pressure, seconds = run(p, wanted) if code == "slippy" else run(p)
    off = np.abs(pressure - np.load(folder / "wanted.npy")).sum() / np.abs(pressure).sum()
    print(json.dumps([seconds, float(off)]))


def once(code, grid, threads, limit, program, folder):
    """Seconds and difference of one run, or why there are none."""
    names = "RAYON_NUM_THREADS OMP_NUM_THREADS OPENBLAS_NUM_THREADS MKL_NUM_THREADS NUMBA_NUM_THREADS".split()
    environment = {**os.environ, **{name: str(threads) for name in names}}
    arguments = [sys.executable, __file__, "child", code, *map(str, grid), program, folder]
    try:
        done = subprocess.run(arguments, env=environment, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return {"failed": f"> {limit:.0f} s", "late": True}
    if done.returncode != 0:
        return {"failed": (done.stderr.strip().splitlines() or ["failed"])[-1][:60]}
    seconds, off = json.loads(done.stdout.splitlines()[-1])
    return {"seconds": seconds, "difference": off}


def best(*arguments):
    """The fastest of some runs, of one if it takes long."""
    runs = []
    while len(runs) < REPEATS:
        runs.append(once(*arguments))
        if runs[-1].get("seconds", SHORT) >= SHORT:
            break
    return min(runs, key=lambda run: run.get("seconds", float("inf")))


def processor():
    """The processor's name, where the system tells it."""
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.processor())


def main():
    parser = argparse.ArgumentParser(description="Compare contacts on cells with other codes.")
    parser.add_argument("program", help="path of edgeline")
    parser.add_argument("--threads", default="1,2", help="numbers of threads, each a run (1,2)")
    parser.add_argument("--seconds", type=float, default=60.0, help="limit of one process (60)")
    parser.add_argument("--record", type=pathlib.Path, required=True, help="JSON file to write")
    asked = parser.parse_args()
    record = {
        "date": datetime.date.today().isoformat(), "processor": processor(), "cores": os.cpu_count(),
        "tolerance": TOLERANCE, "limit_s": asked.seconds,
        "versions": {code: importlib.metadata.version(code) for code in CODES[1:]}, "runs": [],
    }
    late = set()
    for grid in GRIDS:
        for threads in map(int, asked.threads.split(",")):
            with tempfile.TemporaryDirectory() as folder:
                for code in CODES:
                    key = (code, grid[0], threads)
                    if key in late:
                        found = {"failed": "not run"}
                    else:
                        found = best(code, grid, threads, asked.seconds, asked.program, folder)
                    if found.pop("late", False):
                        # Finer grids take longer.
                        late.add(key)
                    run = {"problem": grid[0], "nx": grid[1], "ny": grid[2], "threads": threads, "code": code,
                           "load_average": os.getloadavg()[0], **found}
                    record["runs"].append(run)
                    print(run, file=sys.stderr, flush=True)
                    asked.record.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["child"]:
        child(sys.argv[2], sys.argv[3], int(sys.argv[4]), int(sys.argv[5]), sys.argv[6], sys.argv[7])
    else:
        main()
