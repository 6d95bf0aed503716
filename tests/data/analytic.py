"""Write the high-precision values that tests/numerics/analytic.rs compares with.

    python3 tests/data/analytic.py        (needs mpmath; about ten seconds)

writes next to itself

- love.csv: stresses under, and surface influence f of, a unit pressure on a rectangle, by the
  textbook formulas in 220-digit arithmetic, where their cancellation does no harm. Points on the
  surface, on edges and on the planes of edges are taken as limits: z = 1e-60 and a shift of 1e-90.
  Some of the values are checked here against quadrature of the point load, which uses none of
  these formulas.
- love_extremes.csv: the same at distances from the centre, edges and corners of 1e-9 to 1e9 sides, for
  sides as 1 to 1e-6 to 1e6, in every octant and on every plane, edge and corner.
- point_load.csv: Boussinesq's stresses from the components in cylindrical coordinates.
- hertz_line.csv: stresses of the line contact by quadrature of Flamant's line load.
- hertz_point.csv: f of the circular contact, by quadrature of the influence of a ring.
"""

import csv
import math
import pathlib
import random

import mpmath as mp

HERE = pathlib.Path(__file__).parent
STRESSES = ["xx", "yy", "zz", "xy", "xz", "yz"]
# Below this a value is a trace of the limits above and means zero.
ZERO = mp.mpf(10) ** -45


def love(x, y, z, a, b, nu):
    """The six stresses: Love 1929, as sums over the four corners."""
    x, y = x + mp.mpf(10) ** -90, y + mp.mpf(10) ** -90 * mp.sqrt(2)
    z = z if z > 0 else mp.mpf(10) ** -60

    def corner(x, y):
        rho = mp.sqrt(x * x + y * y + z * z)
        yx, xy = mp.atan(y / x), mp.atan(x / y)
        yzx, xzy = mp.atan(y * z / (x * rho)), mp.atan(x * z / (y * rho))
        bx, by = x * y * z / (rho * (x * x + z * z)), x * y * z / (rho * (y * y + z * z))
        return mp.matrix(
            [
                2 * nu * (xzy - xy) - yx + yzx + bx,
                2 * nu * (yzx - yx) - xy + xzy + by,
                -yx - xy + yzx + xzy - bx - by,
                (2 * nu - 1) * mp.log(rho + z) - z / rho,
                y * z * z / (rho * (x * x + z * z)),
                x * z * z / (rho * (y * y + z * z)),
            ]
        )

    total = (
        corner(x + a, y + b) + corner(x - a, y - b) - corner(x - a, y + b) - corner(x + a, y - b)
    )
    return [t / (2 * mp.pi) for t in total]


def influence(x, y, a, b):
    """f of the rectangle: Johnson 1985, Eq. 3.25."""
    x, y = x + mp.mpf(10) ** -90, y + mp.mpf(10) ** -90 * mp.sqrt(2)
    r = lambda u, v: mp.sqrt(u * u + v * v)
    up, um, vp, vm = x + a, x - a, y + b, y - b
    return (
        up * mp.log((vp + r(up, vp)) / (vm + r(up, vm)))
        + um * mp.log((vm + r(um, vm)) / (vp + r(um, vp)))
        + vp * mp.log((up + r(up, vp)) / (um + r(um, vp)))
        + vm * mp.log((um + r(um, vm)) / (up + r(up, vm)))
    )


def point_load(x, y, z, nu):
    """Boussinesq's stresses from Johnson 1985, Eq. 3.20, turned to x and y."""
    r, rho = mp.sqrt(x * x + y * y), mp.sqrt(x * x + y * y + z * z)
    k = 1 - 2 * nu
    radial = k * (1 / r**2 - z / (rho * r**2)) - 3 * z * r**2 / rho**5
    hoop = -k * (1 / r**2 - z / (rho * r**2) - z / rho**3)
    shear = -3 * r * z**2 / rho**5
    c, s = x / r, y / r
    values = [
        radial * c * c + hoop * s * s,
        radial * s * s + hoop * c * c,
        -3 * z**3 / rho**5,
        (radial - hoop) * c * s,
        shear * c,
        shear * s,
    ]
    return [v / (2 * mp.pi) for v in values]


def hertz_line(x, z):
    """sigma_xx, sigma_zz, sigma_xz under sqrt(1 - s^2): Johnson 1985, Eq. 2.23, s = sin t."""

    def integral(m, n):
        f = (
            lambda t: mp.cos(t) ** 2
            * (x - mp.sin(t)) ** m
            * z**n
            / ((x - mp.sin(t)) ** 2 + z * z) ** 2
        )
        near = mp.asin(max(-1, min(1, x)))
        marks = {-mp.pi / 2, mp.pi / 2, near}
        for k in range(14):
            for sign in (-1, 1):
                t = near + sign * z * 4**k
                if abs(t) < mp.pi / 2:
                    marks.add(t)
        return -2 / mp.pi * mp.quad(f, sorted(marks))

    return [integral(2, 1), integral(0, 3), integral(1, 2) if x else mp.mpf(0)]


def hertz_point(r):
    """f(r): integral over rings of p(s) 4 s K(k) / (r + s), K from its complementary modulus."""

    def ring(s):
        complement = abs(r - s) / (r + s)
        return (
            mp.sqrt(1 - s * s) * 2 * mp.pi * s / ((r + s) * mp.agm(1, complement))
            if complement
            else mp.mpf(0)
        )

    return mp.quad(ring, sorted({0, 1, min(r, 1)}))


def rectangle_points():
    """(kind, x, y, z, a, b, nu): one kind per way to lose digits."""
    rng = random.Random(20240607)
    side = lambda: round(math.exp(rng.uniform(-1.5, 1.0)), 6)
    sign = lambda: rng.choice((-1, 1))
    nu = lambda: rng.choice((0.0, 0.25, 0.3, 0.3, 0.49, 0.5))
    points = [("check", 0.3, 0.9, 0.5, 0.7, 0.4, 0.3)]
    for _ in range(40):
        points.append(
            (
                "general",
                rng.uniform(-3, 3),
                rng.uniform(-3, 3),
                rng.uniform(0.02, 3),
                side(),
                side(),
                nu(),
            )
        )
    for _ in range(12):
        a, b = side(), side()
        points.append(
            ("surface inside", a * rng.uniform(-1, 1), b * rng.uniform(-1, 1), 0.0, a, b, nu())
        )
    for _ in range(12):
        points.append(
            (
                "surface outside",
                sign() * rng.uniform(3, 30),
                rng.uniform(-30, 30),
                0.0,
                side(),
                side(),
                nu(),
            )
        )
    for _ in range(4):
        a, b = side(), side()
        points.append(("surface edge", sign() * a, b * rng.uniform(-0.9, 0.9), 0.0, a, b, nu()))
        points.append(("surface edge", a * rng.uniform(-0.9, 0.9), sign() * b, 0.0, a, b, nu()))
        points.append(
            ("surface edge line", sign() * a, sign() * b * rng.uniform(1.1, 50), 0.0, a, b, nu())
        )
    for _ in range(5):
        a, b = side(), side()
        points.append(("axis plane", 0.0, rng.uniform(-3, 3), rng.uniform(0.02, 3), a, b, nu()))
        points.append(("axis plane", rng.uniform(-3, 3), 0.0, rng.uniform(0.02, 3), a, b, nu()))
        points.append(("axis plane", 0.0, 0.0, 10 ** rng.uniform(-3, 3), a, b, nu()))
        points.append(
            ("edge plane", sign() * a, rng.uniform(-3, 3), 10 ** rng.uniform(-6, 1), a, b, nu())
        )
        points.append(
            ("edge plane", rng.uniform(-3, 3), sign() * b, 10 ** rng.uniform(-6, 1), a, b, nu())
        )
        points.append(
            ("below corner", sign() * a, sign() * b, 10 ** rng.uniform(-6, 2), a, b, nu())
        )
    for power in range(1, 7):
        for _ in range(5):
            d = 10.0**power
            t, p = rng.uniform(0.05, 1.5), rng.uniform(0, 2 * math.pi)
            point = (d * math.sin(t) * math.cos(p), d * math.sin(t) * math.sin(p), d * math.cos(t))
            points.append(("far", *point, side(), side(), nu()))
        points.append(
            ("far surface", 0.6 * 10.0**power, -0.8 * 10.0**power, 0.0, side(), side(), nu())
        )
        points.append(
            ("far shallow", 0.8 * 10.0**power, 0.6 * 10.0**power, 0.01, side(), side(), nu())
        )
    for k in range(30):
        a, b = (1e-3, 1.0) if k % 2 else (1.0, 1e-3)
        d = 10 ** rng.uniform(-4, 2)
        points.append(
            (
                "thin",
                rng.uniform(-1, 1) * d,
                rng.uniform(-1, 1) * d,
                rng.uniform(0.01, 1) * d,
                a,
                b,
                nu(),
            )
        )
    for k in range(30):
        a, b, z = side(), side(), 10 ** rng.uniform(-8, -2)
        outside = [
            (a + rng.uniform(0, 2), rng.uniform(-1, 1) * b),
            (rng.uniform(-1, 1) * a, b + rng.uniform(0, 2)),
            (a + z * rng.uniform(-2, 2), b + rng.uniform(0, 2)),
        ]
        points.append(("shallow outside", *outside[k % 3], z, a, b, nu()))
    for k in range(20):
        a, b, d = side(), side(), 10 ** rng.uniform(-9, -1)
        x = sign() * (a + rng.uniform(-1, 1) * d)
        y = sign() * (b + rng.uniform(-1, 1) * d) if k % 2 else rng.uniform(-1, 1) * b
        points.append(("next to edge", x, y, rng.uniform(0, 1) * d, a, b, nu()))
    # Everything over many decades: distances, sides, and distances from edges.
    log = lambda low, high: 10 ** rng.uniform(low, high)
    for _ in range(60):
        a, b = log(-3, 0), log(-3, 0)
        x = rng.choice((log(-5, 4), a + rng.uniform(-1, 1) * log(-6, 0)))
        y = rng.choice((log(-5, 4), b + rng.uniform(-1, 1) * log(-6, 0)))
        points.append(("any scale", x, y, log(-6, 4), a, b, nu()))
    return points


def extreme_points():
    """(kind, x, y, z, a, b, nu) over all scales: from a place of the rectangle, in a direction."""
    rng = random.Random(20261121)
    log = lambda low, high: float(f"{10 ** rng.uniform(low, high):.12g}")
    points = []
    for k in range(900):
        b = log(-6, 6)
        a = 1.0
        if k % 2:
            a, b = b, a
        kind, u, v = (
            ("from the centre", 0.0, 0.0),
            ("from an edge", a, b * rng.choice((0.0, 0.5))),
            ("from an edge", a * rng.choice((0.0, 0.5)), b),
            ("from a corner", a, b),
            ("from an edge's line", a, b * (1 + log(-9, 3))),
        )[k % 5]
        size = rng.choice((a, b))
        # A direction in the body, on the surface, straight down, or in a plane of an edge.
        d = [rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0, 1)]
        for i in rng.choice(((), (), (), (2,), (0, 1), (0,), (1,), (0, 2), (1, 2))):
            d[i] = 0.0
        # Or next to such a plane.
        if k % 3 == 0:
            d[rng.randrange(3)] *= log(-9, 0)
        r = log(-9, 9) * size
        x, y, z = u + r * d[0], v + r * d[1], r * d[2]
        sx, sy = rng.choice((-1, 1)), rng.choice((-1, 1))
        # What a coordinate of a surface point has within four units in the last place of an edge is on it.
        x, y = (e if abs(p - e) <= 2e-15 * e else p for p, e in ((x, a), (y, b)))
        # In the corner itself the shear has no limit.
        if (x, y, z) == (a, b, 0.0):
            z = 1e-3 * size
        points.append((kind, sx * x, sy * y, z, a, b, rng.choice((0.0, 0.25, 0.3, 0.49, 0.5))))
    return points


def write(name, header, rows):
    with open(HERE / name, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows(rows)


def text(value):
    return "0" if abs(value) == 0 else mp.nstr(value, 18, min_fixed=1, max_fixed=0)


def main():
    mp.mp.dps = 220
    general = 0
    for name, points in (("love.csv", rectangle_points()), ("love_extremes.csv", extreme_points())):
        rows = []
        for kind, *numbers in points:
            x, y, z, a, b, nu = (mp.mpf(n) for n in numbers)
            stress = love(x, y, z, a, b, nu)
            if z == 0:
                stress[2] = stress[2] if abs(stress[2]) > ZERO else mp.mpf(0)
                stress[4] = stress[5] = mp.mpf(0)
            symmetric = [(3, x == 0 or y == 0), (4, x == 0), (5, y == 0)]
            for i, vanishes in symmetric:
                if vanishes:
                    stress[i] = mp.mpf(0)
            # On the surface outside the rectangle nothing but 1 - 2 nu is left.
            if z == 0:
                stress = [s if abs(s) > ZERO else mp.mpf(0) for s in stress]
            if kind == "check" or kind == "general" and z > 0.5 and general < 5:
                general += kind == "general"
                check_by_quadrature(x, y, z, a, b, nu, stress)
            rows.append([kind, *map(repr, numbers), *map(text, stress), text(influence(x, y, a, b))])
        write(name, ["kind", "x", "y", "z", "a", "b", "nu", *STRESSES, "f"], rows)

    mp.mp.dps = 60
    rng = random.Random(7)
    rows = []
    for _ in range(40):
        d = 10 ** rng.uniform(-3, 3)
        numbers = [
            rng.uniform(-1, 1) * d,
            rng.uniform(-1, 1) * d,
            rng.choice((0, 1e-6, 1, 1, 30)) * rng.uniform(0, 1) * d,
            rng.choice((0.0, 0.3, 0.5)),
        ]
        stress = point_load(*(mp.mpf(n) for n in numbers))
        rows.append([*map(repr, numbers), *map(text, stress)])
    write("point_load.csv", ["x", "y", "z", "nu", *STRESSES], rows)

    mp.mp.dps = 30
    rows = []
    for k in range(40):
        x = (rng.uniform(-2, 2), rng.uniform(-1, 1), 0.0, 10 ** rng.uniform(0, 5), 1.0)[k % 5]
        z = (rng.uniform(0.01, 2), 10 ** rng.uniform(-5, -1), 10 ** rng.uniform(-3, 5))[k % 3]
        rows.append([repr(x), repr(z), *map(text, hertz_line(mp.mpf(x), mp.mpf(z)))])
    write("hertz_line.csv", ["x", "z", "xx", "zz", "xz"], rows)
    rows = [
        [repr(r), text(hertz_point(mp.mpf(r)))]
        for r in (0.3, 0.9, 1.0, 1.001, 1.7, 3.9, 4.1, 20.0, 1e3, 1e6)
    ]
    write("hertz_point.csv", ["r", "f"], rows)


def check_by_quadrature(x, y, z, a, b, nu, stress):
    """Gauss's rule with 24 x 24 points on panels no wider than the depth."""
    with mp.workdps(25):
        rule = gauss_legendre(24)

        def nodes(half):
            panels = math.ceil(half / z)
            h = half / panels
            return [(h * (2 * k + 1 + t) - half, h * w) for k in range(panels) for t, w in rule]

        total = [mp.mpf(0)] * 6
        for s, ws in nodes(a):
            for t, wt in nodes(b):
                total = [p + ws * wt * q for p, q in zip(total, point_load(x - s, y - t, z, nu))]
        for got, want in zip(total, stress):
            assert abs(got - want) < mp.mpf(10) ** -14 * abs(want), (x, y, z, got, want)


def gauss_legendre(n):
    roots = [mp.cos(mp.pi * (k + mp.mpf(3) / 4) / (n + mp.mpf(1) / 2)) for k in range(n)]
    roots = [mp.findroot(lambda t: mp.legendre(n, t), (r, r + mp.mpf("1e-8"))) for r in roots]
    return [(r, 2 * (1 - r * r) / (n * mp.legendre(n - 1, r)) ** 2) for r in roots]


if __name__ == "__main__":
    main()
