#!/usr/bin/python3
"""Periodic motions of a forced oscillator that hits a rigid wall, in closed form.

x'' + 0.1 x' + x = A cos(w t), x <= 1, x' -> -0.8 x' at the wall; one impact in n forcing periods, P = 2 pi n / w, at
the phase t1 (modulo 2 pi / w), with the speed V > 0 before it.

Method. With the particular solution p(t) = A |H| cos(w t - phi) and M the matrix of the free motion over P, periodicity
is (M - 1) (1 - p(t1), -p'(t1)) = e V M (0, 1) + (0, V): p(t1) = 1 - alpha V, p'(t1) = -beta V, and therefore
(A |H|)^2 = (1 - alpha V)^2 + (beta V / w)^2. The monodromy matrix just before the impact is M S with
S = [[-e, 0], [(1 + e) (A cos(w t1) - 1) / V, -e]]: its determinant is e^2 exp(-0.1 P), its trace k0 + k1 / V, so that the
point of a multiplier -1 has a closed form as well as the fold, the minimum of A over V.

Checks, which fail loudly (50 digits): every orbit solves the periodicity equations and the differential equation;
folds and doublings come out again as roots of the raw equations (mpmath.findroot in A, t1, V); the multipliers are those of
the impact map (t1, V) -> (next t, V) differentiated numerically; the fold has a multiplier +1 to 1e-30. All digits
printed are good.
Admissible: no maximum of x within the period is above the wall (all maxima, from 2000 intervals of the velocity, refined).
"""
import mpmath as mp
import numpy as np
from mpmath import mpf

import tables

mp.mp.dps = 50
C, E = mpf(1) / 10, mpf(8) / 10
OM = mp.sqrt(1 - C * C / 4)


def free(s):
    """Matrix of the motion without forcing over the time s."""
    d, co, si = mp.exp(-C * s / 2), mp.cos(OM * s), mp.sin(OM * s) / OM
    return mp.matrix([[d * (co + C / 2 * si), d * si], [-d * si, d * (co - C / 2 * si)]])


class Family:
    """Orbits of one impact in n forcing periods at the frequency w."""

    def __init__(self, w, n):
        self.w, self.n, self.T = mpf(w), n, 2 * mp.pi / mpf(w)
        self.P = n * self.T
        self.M = free(self.P)
        sol = mp.lu_solve(self.M - mp.eye(2), mp.matrix([E * self.M[0, 1], E * self.M[1, 1] + 1]))
        self.al, self.be = sol[0], sol[1]
        w = self.w
        self.H = 1 / mp.mpc(1 - w * w, C * w)
        self.det = E * E * mp.exp(-C * self.P)
        m12 = self.M[0, 1]
        self.k1 = -(1 + E) * m12 * w * w
        self.k0 = -E * (self.M[0, 0] + self.M[1, 1]) - (1 + E) * m12 * ((1 - w * w) * self.al + C * self.be)

    def at(self, V):
        """(A, t1) of the orbit with the speed V."""
        p, dp = 1 - self.al * V, -self.be * V
        A = mp.hypot(p, dp / self.w) / abs(self.H)
        t1 = (mp.atan2(-dp / self.w, p) - mp.arg(self.H)) / self.w
        return A, t1 - self.T * mp.floor(t1 / self.T)

    def speeds(self, A):
        """Speeds of the orbits at the amplitude A."""
        a, b, c = self.al**2 + (self.be / self.w)**2, self.al, 1 - (A * abs(self.H))**2
        root = mp.sqrt(b * b - a * c)
        return [v for v in ((b - root) / a, (b + root) / a) if v > 0]

    def multipliers(self, V):
        tr = self.k0 + self.k1 / V
        root = mp.sqrt(mp.mpc(tr * tr / 4 - self.det))
        pair = [tr / 2 + root, tr / 2 - root]
        return sorted(pair, key=lambda m: -abs(m))

    def fold(self):
        return self.al / (self.al**2 + (self.be / self.w)**2)

    def doubling(self):
        return self.k1 / (-1 - self.det - self.k0)


def state(w, A, t1, V, s):
    """(x, x') at the time s after an impact with the speed V at the phase t1."""
    H = 1 / mp.mpc(1 - w * w, C * w)
    z = lambda t: A * H * mp.expj(w * t)
    p0, p1 = z(t1), z(t1 + s)
    y = free(s) * mp.matrix([1 - p0.real, -E * V - (1j * w * p0).real])
    return y[0] + p1.real, y[1] + (1j * w * p1).real


def samples(w, A, t1, V, P, count=2000):
    """Times, displacements and velocities in doubles."""
    w, A, t1, V, P = map(float, (w, A, t1, V, P))
    s, c, om, H = np.linspace(0, P, count + 1), 0.1, float(OM), 1 / complex(1 - w * w, 0.1 * w)
    z = lambda t: A * H * np.exp(1j * w * t)
    y, dy = 1 - z(t1).real, -0.8 * V - (1j * w * z(t1)).real
    d, co, si = np.exp(-c * s / 2), np.cos(om * s), np.sin(om * s) / om
    x = d * (y * (co + c / 2 * si) + dy * si) + z(t1 + s).real
    v = d * (-y * si + dy * (co - c / 2 * si)) + (1j * w * z(t1 + s)).real
    return s, x, v


def highest(w, A, t1, V, P):
    """(x, s) of the highest maximum between the impacts."""
    s, _, v = samples(w, A, t1, V, P)
    best = (mpf(-9), mpf(0))
    for k in np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0)):
        t = mp.findroot(lambda u: state(w, A, t1, V, u)[1], (mpf(s[k]), mpf(s[k + 1])), solver="anderson", tol=1e-60)
        best = max(best, (state(w, A, t1, V, t)[0], t))
    return best


def admissible(f, V):
    A, t1 = f.at(V)
    return int(highest(f.w, A, t1, V, f.P)[0] <= 1)


def contacts(f, end):
    """Points (V, s), in the order of V, where a maximum between the impacts touches the wall."""
    grid = [end * k / 2000 for k in range(1, 2001)]
    high = []
    for V in grid:
        A, t1 = f.at(V)
        s, x, v = samples(f.w, A, t1, V, f.P)
        k = [i for i in np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0))]
        k = max(k, key=lambda i: x[i:i + 2].max(), default=None)
        high.append((x[k:k + 2].max() - 1, s[k]) if k is not None else (-9, 0))
    found = []
    for i in range(1, 2000):
        if (high[i - 1][0] > 0) != (high[i][0] > 0):
            def touch(V, s):
                A, t1 = f.at(V)
                x, v = state(f.w, A, t1, V, s)
                return [x - 1, v]
            V, s = mp.findroot(touch, (grid[i], mpf(high[i][1])), tol=1e-80)
            if V > 0 and 0 < s < f.P:
                found.append((V, s))
    return found


def next_impact(f, A, t, V, guess):
    """The impact map: time and speed of the next impact near the given time after this one."""
    s = mp.findroot(lambda u: state(f.w, A, t, V, u)[0] - 1, guess)
    return t + s, state(f.w, A, t, V, s)[1]


def check_multipliers(f, V):
    """The multipliers against the impact map differentiated numerically."""
    A, t1 = f.at(V)
    h = mpf(10)**-16
    columns = []
    for dt, dV in ((h, 0), (0, h)):
        a, b = next_impact(f, A, t1 + dt, V + dV, f.P), next_impact(f, A, t1 - dt, V - dV, f.P)
        columns.append([(a[0] - b[0]) / (2 * h), (a[1] - b[1]) / (2 * h)])
    tr, det = columns[0][0] + columns[1][1], columns[0][0] * columns[1][1] - columns[1][0] * columns[0][1]
    assert abs(tr - f.k0 - f.k1 / V) < 1e-20 * max(1, abs(tr)) and abs(det - f.det) < 1e-20 * max(1, abs(tr)), (tr, det)


def raw(f, A, t1, V):
    x, v = state(f.w, A, t1, V, f.P)
    return [x - 1, v - V]


def check(f, V, kind):
    """The orbit again from the raw equations; folds and doublings as roots of three equations in A, t1, V."""
    A, t1 = f.at(V)
    assert max(map(abs, raw(f, A, t1, V))) < 1e-35
    x, v, a = (mp.diff(lambda s: state(f.w, A, t1, V, s)[0], f.P / 3, k) for k in range(3))
    assert abs(a + C * v + x - A * mp.cos(f.w * (t1 + f.P / 3))) < 1e-20    # the closed form solves the equation
    check_multipliers(f, V)
    if kind in ("fold", "doubling"):
        sign = 1 if kind == "fold" else -1

        def system(A, t1, V):
            acos = (A * mp.cos(f.w * t1) - 1) * (1 + E) / V
            m = f.M * mp.matrix([[-E, 0], [acos, -E]])
            return raw(f, A, t1, V) + [1 + m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0] - sign * (m[0, 0] + m[1, 1])]
        far = mpf("1e-5")
        root = mp.findroot(system, (A + far * A, t1 + far, V - far * V), tol=1e-60)
        assert max(abs(root[0] - A), abs(root[1] - t1), abs(root[2] - V)) < 1e-25, (kind, root, A, t1, V)
        assert min(abs(m - sign) for m in f.multipliers(V)) < 1e-30


COLUMNS = ["kind", "w", "n", "A", "t1", "V", "re1", "im1", "re2", "im2", "admissible", "s", "top"]


def row(kind, f, V, s=mp.nan):
    A, t1 = f.at(V)
    if V == 0:
        assert abs(A - mp.sqrt((1 - f.w**2)**2 + C * C * f.w**2)) < 1e-40
        return [kind, f.w, f.n, A, t1, V] + [mp.nan] * 4 + [1 if f.n == 1 else 0, s, mpf(1)]
    m = f.multipliers(V)
    top = highest(f.w, A, t1, V, f.P)[0]
    ok = 1 if kind == "contact" else int(top <= 1)
    check(f, V, kind)
    return [kind, f.w, f.n, A, t1, V, m[0].real, m[0].imag, m[1].real, m[1].imag, ok, s, top]


def family(w, n, end, amplitudes=()):
    f = Family(w, n)
    rows = [row("grazing", f, mpf(0))]
    points = [("regular", V, mp.nan) for V in (mpf(end) * k / 11 for k in range(1, 12))]
    if amplitudes:
        points = [("regular", f.speeds(mpf(a))[-1], mp.nan) for a in amplitudes]
        end = max(V for _, V, _ in points)
    points += [(k, V, mp.nan) for k, V in (("fold", f.fold()), ("doubling", f.doubling())) if V > 0]
    points += [("contact", V, s) for V, s in contacts(f, mpf(end))]
    rows += [row(k, f, V, s) for k, V, s in sorted(points, key=lambda p: p[1])]
    return rows


def curves():
    """Special points against the frequency."""
    rows = []

    def add(kind, n, first, last, count=20):
        for k in range(count):
            f = Family(mpf(first) + (mpf(last) - mpf(first)) * k / (count - 1), n)
            V = f.fold() if kind == "fold" else f.doubling()
            check(f, V, kind)
            A, t1 = f.at(V)
            rows.append([kind, n, f.w, A, t1, V, admissible(f, V), mp.nan])
    add("fold", 1, "1.05", "1.95")
    add("doubling", 1, "0.7", "0.985")
    add("doubling", 1, "2.05", "2.62")
    add("fold", 2, "2.25", "3.2")
    add("doubling", 2, "2.25", "3.2")
    add("fold", 3, "3.4", "4.35")
    add("doubling", 3, "3.4", "4.35")
    for n, first, last, end in ((1, "0.7", "0.795", 6), (2, "2.25", "2.725", 5), (3, "3.4", "4.35", 6)):
        for k in range(20):
            f = Family(mpf(first) + (mpf(last) - mpf(first)) * k / 19, n)
            for V, s in contacts(f, mpf(end))[:1]:
                A, t1 = f.at(V)
                rows.append(["contact", n, f.w, A, t1, V, 1, s])
    return rows


def doubled():
    """Orbits of two impacts in 2 n forcing periods that leave a period doubling, by the shift of the second impact."""
    rows = []
    for w, n, shifts in (("0.8", 1, (1, 2, 5, 10, 20, 30, 40)), ("2.2", 1, (1, 2, 5, 10, 20, 30, 40)),
                         ("2.5", 2, (1, 2, 5, 10, 15, 20)), ("3.5", 3, (1, 2, 5, 10))):
        f = Family(w, n)
        V = f.doubling()
        A, t1 = f.at(V)
        rows.append([f.w, n, A, t1, V, t1 + f.P, V, mpf(1), mpf(0), f.det**2, mpf(0), 1])
        guess = None
        for shift in shifts:
            d = mpf(shift) / 100

            def system(A, t1, V1, V2):
                a, b = state(f.w, A, t1, V1, f.P + d), state(f.w, A, t1 + d, V2, f.P - d)
                return [a[0] - 1, a[1] - V2, b[0] - 1, b[1] - V1]
            if guess is None:    # V along the eigenvector of -1: from the derivative of the impact map
                h = mpf(10)**-16
                a, b = next_impact(f, A, t1 + h, V, f.P), next_impact(f, A, t1 - h, V, f.P)
                c, e = next_impact(f, A, t1, V + h, f.P), next_impact(f, A, t1, V - h, f.P)
                slope = -(1 + (a[0] - b[0]) / (2 * h)) / ((c[0] - e[0]) / (2 * h))
                guess = (A, t1 - d / 2, V - slope * d / 2, V + slope * d / 2)
            try:
                root = mp.findroot(system, guess, tol=1e-70, maxsteps=40)
            except (ValueError, ZeroDivisionError) as error:
                print("doubled", w, n, shift, error)
                break
            A2, t, V1, V2 = root
            if abs(A2 - guess[0]) > 0.5 * abs(guess[0]) or V1 <= 0 or V2 <= 0:
                print("doubled", w, n, shift, "left the branch")
                break
            guess = tuple(root)

            def salt(V, t):
                return mp.matrix([[-E, 0], [(1 + E) * (A2 * mp.cos(f.w * t) - 1) / V, -E]])
            m = free(f.P - d) * salt(V2, t + f.P + d) * free(f.P + d) * salt(V1, t)
            tr, det = m[0, 0] + m[1, 1], m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0]
            r = mp.sqrt(mp.mpc(tr * tr / 4 - det))
            pair = sorted((tr / 2 + r, tr / 2 - r), key=lambda z: -abs(z))
            ok = int(max(highest(f.w, A2, t, V1, f.P + d)[0], highest(f.w, A2, t + d, V2, f.P - d)[0]) <= 1)
            shiftT = mp.floor(t / f.T) * f.T
            rows.append([f.w, n, A2, t - shiftT, V1, t + f.P + d - shiftT, V2, pair[0].real, pair[0].imag, pair[1].real,
                         pair[1].imag, ok])
    return rows


EQUATION = """
x'' + 0.1 x' + x = A cos(w t), x <= 1, x' -> -0.8 x' at the wall. Impacts at the phase t1 with the speed V before them.
Closed form, 50 digits; made and checked by impact_oscillator.py. All digits are good.
"""

FAMILIES = (("0.6", 1, "1.54"), ("0.8", 1, "5.5"), ("1", 1, None), ("1.5", 1, "3.3"), ("2", 1, "3.3"), ("2.2", 1, "2.2"),
            ("2.5", 1, "6.6"), ("2.8", 1, "5.5"), ("3.2", 1, "5.5"), ("2.5", 2, "2.2"), ("2.8", 2, "5.5"),
            ("3.2", 2, "11"), ("3.5", 3, "1.1"), ("4", 3, "2.2"))

if __name__ == "__main__":
    points = []
    for w, n, end in FAMILIES:
        points += family(w, n, end) if end else family(w, n, 0, [mpf(2 * k) / 10 for k in range(1, 11)] + [mpf(1) / 10])
    tables.write(__file__, "impact_oscillator", EQUATION + """
Families of one impact in n forcing periods, in the order of V from the grazing point (V = 0) on. re1 .. im2: Floquet
multipliers over P = 2 pi n / w. kind: grazing, regular, fold (multiplier +1), doubling (multiplier -1), contact (a second
contact within the period begins, at the time s after the impact). admissible: x <= 1 all along (0 for the grazing of n > 1,
which touches the wall n times). top: highest maximum of x within the period (-9: there is none).
""", COLUMNS, points)
    tables.write(__file__, "impact_oscillator_curves", EQUATION + """
Folds, doublings and second contacts (s: time after the impact) of the families of one impact in n forcing periods.
""", ["kind", "n", "w", "A", "t1", "V", "admissible", "s"], curves())
    tables.write(__file__, "impact_oscillator_doubled", EQUATION + """
Orbits of two impacts in 2 n forcing periods that leave the doublings of the families of one impact in n: the first row of
a family is the doubling itself. Times t1, t2 and speeds V1, V2 of the two impacts; multipliers over 4 pi n / w. Roots of
the four closed-form equations.
""", ["w", "n", "A", "t1", "V1", "t2", "V2", "re1", "im1", "re2", "im2", "admissible"], doubled())
