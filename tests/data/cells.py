"""Write the contacts on cells that tests/numerics/cells.rs compares with.

    python3 tests/data/cells.py        (needs numpy; about a minute)

writes cells.csv next to itself: along the line (x at the middle) and across it (y at the middle), the pressures of
half-space and guilbault on 96 x 160 cells, S_l = 5, nu = 0.3, X = 1.5 C, the block as long as the roller or twice as long,
the latter also with waves on its surface that are skew to the contact; and of each contact the sum of p and of p^2 over the cells and the approach.

Nothing is shared with the program: the deflection is Love's textbook formula, the transforms are whole and complex, each
image is a cell of its own at its own place (the grid is extended along y until it holds all of them), and the iteration is
Polonsky and Keer's (1999, Wear 231, 206), run until it does not move any more.
"""

import csv
import pathlib

import numpy as np

HERE = pathlib.Path(__file__).parent
NX, NY, X, S = 96, 160, 1.5, 5.0
DX, DY = 2 * X / NX, 2 * S / NY


def deflection(x, y):
    """Eq. 3 in the textbook's form, per unit pressure; u = f / pi in the units of the program."""
    a, b = DX / 2, DY / 2

    def part(u, v, w, t):
        # u ln((v + |u, v|) / (w + |u, w|))
        return t * np.log((v + np.hypot(t, v)) / (w + np.hypot(t, w)))

    xp, xm, yp, ym = x + a, x - a, y + b, y - b
    return (
        part(0, yp, ym, xp) - part(0, yp, ym, xm) + part(0, xp, xm, yp) - part(0, xp, xm, ym)
    ) / np.pi


def waves(x, y):
    """Heights in units of C^2 / (2 R)."""
    return 0.15 * (np.sin(7 * x + 1) + 0.7 * np.cos(5.3 * x - 2.1 * y + 0.3))


def operator(images):
    """u(p) with every cell's images, (y of the image of y, weight), at places of their own."""
    far = max([2 * abs(h) for h, _ in images], default=0) + 2 * S
    cells = int(np.ceil(far / DY)) + NY
    nx, ny = 4 * NX, 1 << int(np.ceil(np.log2(4 * cells)))
    i = np.fft.fftfreq(nx, 1 / nx)[:, None] * DX
    j = np.fft.fftfreq(ny, 1 / ny)[None, :] * DY
    # By symmetry arguments stay positive, where the formula does not cancel.
    kernel = np.fft.fft2(deflection(np.abs(i), np.abs(j)))
    middle = ny // 2 - NY // 2

    def apply(p):
        field = np.zeros((nx, ny))
        field[:NX, middle : middle + NY] += p
        for h, weight in images:
            # Cell j at y_j has its image at 2 h - y_j, a whole number of cells away.
            shift = 2 * h / DY
            assert abs(shift - round(shift)) < 1e-9
            start = middle + round(shift)
            field[:NX, start : start + NY] += weight * p[:, ::-1]
        return np.fft.ifft2(kernel * np.fft.fft2(field)).real[:NX, middle : middle + NY]

    return apply


def solve(apply, gap, total):
    """Polonsky and Keer's iteration; pressures and approach."""
    p = np.full(gap.shape, total / gap.size)
    step, last, delta = np.zeros_like(p), 1.0, 0.0
    for n in range(20000):
        g = apply(p) + gap
        inside = p > 0
        approach = g[inside].mean()
        g -= approach
        norm = (g[inside] ** 2).sum()
        step = np.where(inside, g + delta * norm / last * step, 0.0)
        last = norm
        moved = apply(step)
        moved -= moved[inside].mean()
        length = (g[inside] * step[inside]).sum() / (moved[inside] * step[inside]).sum()
        before = p
        p = np.where(inside, np.maximum(p - length * step, 0), p)
        penetrating = (p == 0) & (g < 0)
        delta = 0.0 if penetrating.any() else 1.0
        p = np.where(penetrating, p - length * g, p)
        p *= total / p.sum()
        if np.abs(p - before).max() < 1e-12 and np.sqrt(norm / inside.sum()) < 1e-11:
            break
    return p, approach


def main():
    x = (np.arange(NX) + 0.5) * DX - X
    y = (np.arange(NY) + 0.5) * DY - S
    gap = np.repeat(x[:, None] ** 2, NY, axis=1)
    total = np.pi / 2 * 2 * S / (DX * DY)
    psi = 1.29 - (0.08 - 0.5 * 0.3) / (1 - 0.3)
    cases = {
        "half-space": [],
        "guilbault-flush": [(h, 0.5 * psi) for h in (S, -S, S, -S)],
        "guilbault-half": [(h, 0.5 * psi) for h in (S, -S, 2 * S, -2 * S)],
    }
    cases["rough-half"] = cases["guilbault-half"]
    with open(HERE / "cells.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["case line", "index", "p"])
        for name, images in cases.items():
            rough = waves(x[:, None], y[None, :]) if name.startswith("rough") else 0
            p, approach = solve(operator(images), gap - rough, total)
            out.writerow([f"{name} sum", 0, repr(float(p.sum()))])
            out.writerow([f"{name} squares", 0, repr(float((p**2).sum()))])
            out.writerow([f"{name} approach", 0, repr(float(approach))])
            for j in range(NY // 2, NY):
                out.writerow([f"{name} along", j, f"{p[NX // 2, j]:.12g}"])
            for i in range(NX // 2, NX):
                out.writerow([f"{name} across", i, f"{p[i, NY // 2]:.12g}"])
            for i in range(NX // 2, NX):
                out.writerow([f"{name} end", i, f"{p[i, NY - 1]:.12g}"])


if __name__ == "__main__":
    main()
