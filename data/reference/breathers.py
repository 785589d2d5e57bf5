#!/usr/bin/python3
"""Breathers of rings without obstacles, even about t = 0 and T / 2, one particle excited in the anticontinuum limit.

q_i'' + q_i + s q_i^3 = f(q_{i+1} - q_i) - f(q_i - q_{i-1}), f(d) = gamma d + b d^3, i = 0 .. 20 a ring, particle 10 excited,
positive at t = 0. Hard: s = 1, T = 4.5; soft: s = -1/6, T = 7.5.

Method. v(0) = 0; Newton on q(0) for v(T / 2) = 0 by Taylor series, 34 digits, residual below 1e-30; continued from the
single oscillator first in b, then in gamma. Monodromy matrix over T from the half period's by time reversal,
M = R N^-1 R N with R = diag(1, -1), N by complex steps in doubles.

Checks, which fail loudly: scipy's DOP853 over half a period has v(T / 2) = 0 to 1e-10; the energy at T / 2 is that of
t = 0 to 1e-27; det N = 1 to 1e-9; the multiplier of largest modulus again from DOP853's M with differences, to 1e-4
(the double multiplier 1 of the phase splits like the root of the rounding).
q and energy: all digits are good. largest: the moduli are of doubles, good to about 1e-7 where they are 1.
unstable: 1 where the largest modulus is above 1 by more than 1e-4.
"""
import mpmath as mp
import numpy as np
from mpmath import mpf
from scipy.integrate import solve_ivp

import lattice
import tables

mp.mp.dps = 34
N, SITE = 21, 10
RING = 2 * np.eye(N) - np.roll(np.eye(N), 1, axis=0) - np.roll(np.eye(N), -1, axis=0)
LINKS = np.eye(N) - np.roll(np.eye(N), 1, axis=1)


def system(s, gamma, b, exact):
    """K, B, coefficients for lattice.flow."""
    if exact:
        one = mpf(1)
        K = lattice.precise(np.eye(N)) + gamma * lattice.precise(RING)
        B = lattice.precise(np.vstack([np.eye(N), LINKS]) if b else np.eye(N))
    else:
        one, s, gamma, b = 1.0, float(s), float(gamma), float(b)
        K, B = np.eye(N) + gamma * RING, np.vstack([np.eye(N), LINKS]) if b else np.eye(N)
    return K, B, [s * one] * N + ([b * one] * N if b else [])


def energy(q, v, s, gamma, b):
    d = [q[i] - q[i - 1] for i in range(N)]
    return sum(a * a for a in v) / 2 + sum(a * a / 2 + s * a**4 / 4 for a in q) + sum(
        gamma * a * a / 2 + b * a**4 / 4 for a in d)


def residual_of(s, gamma, b, T):
    def residual(z):
        exact = z.dtype == object
        return lattice.flow(*system(s, gamma, b, exact), z, 0 * z, T / 2 if exact else float(T / 2))[1]
    return residual


def refine(f, z):
    for _ in range(20):
        J = f(z[:, None] + 1e-40j * np.eye(N)).imag / 1e-40
        step = np.linalg.solve(J, f(z[:, None])[:, 0])
        z = z - step
        if abs(step).max() < 1e-11:
            return z
    raise ValueError("Newton's method does not converge")


def single(s, T):
    """Amplitude of the single oscillator with the period T."""
    def period(a):
        return mp.quad(lambda u: 4 / mp.sqrt(1 + s * a * a * (1 + mp.sin(u)**2) / 2), [0, mp.pi / 2])
    return float(mp.findroot(lambda a: period(a) - T, 1.2 if s > 0 else 1.5))


def field(s, gamma, b):
    s, gamma, b = float(s), float(gamma), float(b)

    def rhs(_, y):
        q = y[:N]
        d = q - np.roll(q, 1)
        f = gamma * d + b * d**3
        return np.append(y[N:], -q - s * q**3 + np.roll(f, -1) - f)
    return rhs


def floquet(s, gamma, b, T, q):
    """Moduli of the multipliers."""
    z = np.append(q.astype(float), np.zeros(N))[:, None] + 1e-40j * np.eye(2 * N)
    h = np.vstack(lattice.flow(*system(s, gamma, b, False), z[:N], z[N:], float(T / 2))).imag / 1e-40
    assert abs(np.linalg.det(h) - 1) < 1e-9
    R = np.diag([1.0] * N + [-1.0] * N)
    modulus = abs(np.linalg.eigvals(R @ np.linalg.inv(h) @ R @ h)).max()
    rhs, base = field(s, gamma, b), np.append(q.astype(float), np.zeros(N))
    M = np.empty((2 * N, 2 * N))
    for i in range(2 * N):
        e = np.zeros(2 * N)
        e[i] = 1e-5
        ends = [solve_ivp(rhs, (0, float(T)), base + g * e, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
                for g in (1, -1)]
        M[:, i] = (ends[0] - ends[1]) / 2e-5
    other = abs(np.linalg.eigvals(M)).max()
    assert abs(other - modulus) < 1e-4, (other, modulus)
    return modulus


rows, shapes = [], []
for name, s, T in (("hard", mpf(1), mpf(9) / 2), ("soft", mpf(-1) / 6, mpf(15) / 2)):
    for b in (mpf(0), mpf(1) / 10):
        z = np.zeros(N)
        z[SITE] = single(s, T)
        for k in range(11 if b else 1):
            z = refine(residual_of(s, 0, float(b) * k / 10, T), z)
        for hundredths in range(11):
            gamma = mpf(hundredths) / 100
            z = refine(residual_of(s, gamma, b, T), z)
            if hundredths % 5:
                continue
            q = lattice.newton(residual_of(s, gamma, b, T), z)
            q = np.array([a if abs(a) > 1e-31 else mpf(0) for a in q], dtype=object)
            h, v = lattice.flow(*system(s, gamma, b, True), q.reshape(-1, 1), 0 * q.reshape(-1, 1), T / 2)
            E = energy(q, 0 * q, s, gamma, b)
            assert abs(energy(h[:, 0], v[:, 0], s, gamma, b) - E) < 1e-27
            y = solve_ivp(field(s, gamma, b), (0, float(T / 2)), np.append(q.astype(float), np.zeros(N)), method="DOP853",
                          rtol=1e-13, atol=1e-15).y[:, -1]
            assert abs(y[N:]).max() < 1e-10, abs(y[N:]).max()
            assert abs(q[SITE - 1] - q[SITE + 1]) < 1e-28
            largest = floquet(s, gamma, b, T, q)
            print(name, b, gamma, mp.nstr(q[SITE], 12), mp.nstr(q[SITE + 1], 12), largest, float(abs(y[N:]).max()), flush=True)
            rows.append([s, T, b, gamma, E, float(largest), int(largest > 1 + 1e-4), *q])
tables.write(__file__, "breathers", """
Ring of 21 unit masses, q_i'' + q_i + s q_i^3 = f(q_{i+1} - q_i) - f(q_i - q_{i-1}), f(d) = gamma d + b d^3, period T, v = 0 at
t = 0 and T / 2; particle 10 (counted from 0) is excited. q: displacements at t = 0; largest: modulus of the largest Floquet
multiplier. Taylor series with 34 digits, made and checked by breathers.py. All digits of q and of the energy are good,
largest comes from doubles (about 1e-7 where it is 1).
""", ["s", "T", "b", "gamma", "energy", "largest", "unstable"] + [f"q{i}" for i in range(N)], rows)
