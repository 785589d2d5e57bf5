#!/usr/bin/python3
"""Even periodic motions of two masses in series, one elastic impact at mass 2 in a period, with a cubic spring.

x1'' = -3 x1 + d + eps d^3, x2'' = -d - eps d^3, d = x2 - x1, wall x2 <= 2; at t = 0+ q2 = 2, v1 = 0, v2 = -V, and
v(T / 2) = 0, where 2 pi / (T omega_1) = ratio with omega_1^2 = (5 - sqrt(13)) / 2, the lower eigenvalue of the linear part.

Method: Newton on (q1(0), V) with v(T / 2) = 0 by Taylor series, continued in eps from the linear solution at
ratio = 1.05 and then in the ratio; 34 digits, residuals below 1e-30. Checks, which fail loudly: scipy's DOP853 over half a period has v(T / 2) = 0 to 1e-11;
at eps = 0 the energy is the one of the linear closed form (cos and sin of the eigenmodes) to 1e-25; energy is kept over
half a period to 1e-28. Admissible: x2 <= 2 at 16 times of each of the steps of the series.
"""
import mpmath as mp
import numpy as np
from mpmath import mpf
from scipy.integrate import solve_ivp

import lattice
import tables

mp.mp.dps = 34
K = np.array([[4, -1], [-1, 1]])
B = np.array([[-1, 1]])


def energy(q, v, eps):
    d = q[1] - q[0]
    return (v[0]**2 + v[1]**2 + 3 * q[0]**2 + d**2) / 2 + eps * d**4 / 4


def start(z):
    """(q, v) at t = 0+ from columns of (q1, V)."""
    two, zero = z[:1] * 0 + 2, z[:1] * 0
    return np.vstack([z[:1], two]), np.vstack([zero, -z[1:]])


def solve(T, eps, guess):
    def residual(z):
        exact = z.dtype == object
        return lattice.flow(K, B, [eps if exact else float(eps)], *start(z), T / 2 if exact else float(T / 2))[1]
    return lattice.newton(residual, guess)


def linear(T):
    """(q1, V) of the linear motion: each mode is c cos(omega (t - T / 2))."""
    A = mp.matrix(2, 2)
    speed = []
    for i, lam in enumerate(((5 - mp.sqrt(13)) / 2, (5 + mp.sqrt(13)) / 2)):
        om = mp.sqrt(lam)
        shape = (1, 4 - lam)    # from the first row of K
        A[0, i] = om * mp.sin(om * T / 2) * shape[0]      # v1(0) = 0
        A[1, i] = mp.cos(om * T / 2) * shape[1]           # q2(0) = 2
        speed.append((om * mp.sin(om * T / 2) * shape[1], mp.cos(om * T / 2)))
    c = mp.lu_solve(A, mp.matrix([0, 2]))
    return sum(c[i] * speed[i][1] for i in range(2)), -sum(c[i] * speed[i][0] for i in range(2))


def period(ratio):
    return 2 * mp.pi / (mpf(ratio) * mp.sqrt((5 - mp.sqrt(13)) / 2))


def row(ratio, eps, guess):
    T = period(ratio)
    z = solve(T, eps, [float(a) for a in guess])
    if eps == 0:
        assert max(abs(a - b) for a, b in zip(z, linear(T))) < 1e-25
    q, v = (a[:, 0] for a in start(z.reshape(-1, 1)))
    low = []
    q2, v2 = lattice.flow(K, B, [eps], *(a.reshape(-1, 1) for a in (q, v)), T / 2, low)
    E = energy(q, v, eps)
    assert abs(energy(q2[:, 0], v2[:, 0], eps) - E) < 1e-28
    e = float(eps)
    s = solve_ivp(lambda t, y: [y[2], y[3], -3 * y[0] + y[1] - y[0] + e * (y[1] - y[0])**3,
                                y[0] - y[1] - e * (y[1] - y[0])**3],
                  (0, float(T / 2)), [float(a) for a in (*q, *v)], method="DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    assert abs(s[2:]).max() < 1e-11, s
    top = max(x[1, 0] for x in low[1:])
    return [mpf(ratio), eps, T, z[0], z[1], E, q2[0, 0], q2[1, 0], int(top < 2 and z[1] > 0)]


def newton(ratio, eps, z):
    """In doubles, from a near point."""
    def residual(z):
        return lattice.flow(K, B, [eps], *start(z), float(period(ratio) / 2))[1]
    for _ in range(12):
        J = residual(z[:, None] + 1e-40j * np.eye(2)).imag / 1e-40
        step = np.linalg.solve(J, residual(z[:, None])[:, 0])
        z = z - step
        if abs(step).max() < 1e-11:
            return z
    raise ValueError((ratio, eps))


RATIOS = ("1.05", "1.1", "1.2", "1.3")
rows = [row(r, mpf(0), linear(period(r))) for r in RATIOS]
for eps in ("0.1", "0.2"):
    z = np.array([float(a) for a in linear(period("1.05"))])
    for k in range(1, 41):
        z = newton(1.05, float(eps) * k / 40, z)
    for k in range(0, 251, 2):
        ratio = 1.05 + k / 1000
        z = newton(ratio, float(eps), z)
        for r in RATIOS:
            if abs(ratio - float(r)) < 1e-9:
                rows.append(row(r, mpf(eps), z))
energies = {(float(r[0]), float(r[1])): r[5] for r in rows}
assert abs(energies[1.1, 0] - 1.7113950296) < 1e-10 and abs(energies[1.3, 0] - 3.3478782064) < 1e-10
tables.write(__file__, "two_mass_cubic", """
x1'' = -3 x1 + d + eps d^3, x2'' = -d - eps d^3, d = x2 - x1, wall x2 <= 2, elastic. Period T, one impact at t = 0:
q(0) = (q1, 2), v(0+) = (0, -V), v(T / 2) = 0; ratio = 2 pi / (T omega_1); h1, h2: q(T / 2). For eps > 0 the motions are
one branch along the ratio, from the linear motion at 1.05 (between 1.2 and 1.3 the linear branch has a pole).
admissible: V > 0 and x2 < 2 between the impacts. Taylor series with 34 digits, made and checked by two_mass_cubic.py. All
digits are good.
""", ["ratio", "eps", "T", "q1", "V", "energy", "h1", "h2", "admissible"], rows)
