#!/usr/bin/python3
"""Periodic motions of rings with a Hertz floor, even about t = 0 (deepest in the floor) and t = T / 2.

q_i'' + q_i - gamma (q_{i+1} - 2 q_i + q_{i-1}) = F_i, i = 0 .. n - 1 a ring, F_i = k max(0, -1 - q_i)^(3/2); T = 3 pi / 2;
one particle reaches the floor, once in a period.

Method. Contact: with u = r^2 = -1 - q_p and dt = 2 r ds the motion is polynomial, r' = -v_p, t' = 2 r, q' = 2 r v,
v' = 2 r (linear forces) + 2 k r^4 e_p, and smooth through the end of the contact, r = 0; Taylor series in s. Free motion
from there to T / 2: modes of the ring in closed form. Unknowns q(0) and the s of the end; v(T / 2) = 0 and r = 0. Newton in
34 digits (residual below 1e-30), continued from gamma = 0 where the other particles rest.

Checks, which fail loudly: scipy's DOP853 with the Hertz force as it is and an event at the end of the contact has
v(T / 2) = 0 to 1e-9 at all particles, and its energy stays to 1e-11; in 34 digits the energy at T / 2 is that of t = 0 to
1e-26; no other particle gets below -1 and the one in contact not again (64 times of the free motion). All digits are good.
"""
import mpmath as mp
import numpy as np
from mpmath import mpf
from scipy.integrate import solve_ivp

import lattice
import tables

mp.mp.dps = 34
FUNCTIONS = {True: (np.vectorize(mp.cos, otypes=[object]), np.vectorize(mp.sin, otypes=[object]),
                    np.vectorize(mp.sqrt, otypes=[object])), False: (np.cos, np.sin, np.sqrt)}


def pull(q, gamma):
    """Linear forces of the ring."""
    return -q + gamma * (np.roll(q, 1, axis=-2) - 2 * q + np.roll(q, -1, axis=-2))


def contact(q, v, k, p, gamma, span):
    """(r, t, q, v) when s has grown by 1 in units of the span."""
    order, tol = lattice.orders(q)
    sqrt = FUNCTIONS[q.dtype == object][2]
    r, t = sqrt(-1 - q[p:p + 1]), 0 * q[p:p + 1]
    done, n = 0 * abs(span.ravel()[0]), len(q)
    while done < 1:
        Y = np.empty((order + 1, 2 * n + 2, q.shape[1]), dtype=q.dtype)
        G = np.empty((order + 1, n, q.shape[1]), dtype=q.dtype)
        R2 = np.empty((order + 1, 1, q.shape[1]), dtype=q.dtype)
        Y[0] = np.vstack([r, t, q, v])
        for j in range(order):
            R, V = Y[:j + 1, :1], Y[:j + 1, 2 + n:]
            G[j] = pull(Y[j, 2:2 + n], gamma)
            R2[j] = (R * R[::-1]).sum(axis=0)
            new = np.empty_like(Y[0])
            new[0] = -Y[j, 2 + n + p]
            new[1] = 2 * Y[j, 0]
            new[2:2 + n] = 2 * (R * V[::-1]).sum(axis=0)
            new[2 + n:] = 2 * (R * G[j::-1]).sum(axis=0)
            new[2 + n + p] += 2 * k * (R2[:j + 1] * R2[j::-1]).sum(axis=0)[0]
            Y[j + 1] = new * span / (j + 1)
        h = lattice.length(Y[-2:], Y[0], order, tol, 1 - done)
        end = lattice.horner(Y, h)
        r, t, q, v = end[:1], end[1:2], end[2:2 + n], end[2 + n:]
        done = done + h if 1 - done - h > 1e-30 else 1
    return r, t, q, v


def modes(n, exact):
    """Orthonormal modes of the ring and the squares of the sines in their frequencies."""
    U, s2 = [], []
    for j in range(n // 2 + 1):
        for f in (mp.cos, mp.sin):
            if f is mp.sin and (j == 0 or 2 * j == n):
                continue
            scale = mp.sqrt(mpf(1 if j == 0 or 2 * j == n else 2) / n)
            U.append([scale * f(2 * mp.pi * j * i / n) for i in range(n)])
            s2.append(mp.sin(mp.pi * j / n)**2)
    U, s2 = np.array(U, dtype=object).T, np.array(s2, dtype=object)
    return (U, s2) if exact else (U.astype(float), s2.astype(float))


MODES = {}


def free(q, v, gamma, time):
    """Free motion of the ring over a time for every column."""
    exact = q.dtype == object
    if (len(q), exact) not in MODES:
        MODES[len(q), exact] = modes(len(q), exact)
    U, s2 = MODES[len(q), exact]
    cos, sin, sqrt = FUNCTIONS[exact]
    om = sqrt(1 + 4 * gamma * s2)[:, None]
    a, b = U.T @ q, U.T @ v
    c, s = cos(om * time), sin(om * time)
    return U @ (a * c + b * s / om), U @ (b * c - a * om * s)


def energy(q, v, k, gamma):
    press = [max(mpf(0), -1 - a) for a in q]
    links = sum((q[i] - q[i - 1])**2 for i in range(len(q)))
    return sum(a * a + b * b for a, b in zip(q, v)) / 2 + gamma * links / 2 + 2 * k * sum(
        u * u * mp.sqrt(u) for u in press) / 5


def residual_of(n, p, k, gamma):
    def residual(z):
        exact = z.dtype == object
        g, kk, T = (gamma, k, 3 * mp.pi / 2) if exact else (float(gamma), float(k), float(3 * mp.pi / 2))
        r, t, q, v = contact(z[:n], 0 * z[:n], kk, p, g, z[n:])
        return np.vstack([free(q, v, g, T / 2 - t)[1], r])
    return residual


def first(n, p, k):
    """The single oscillator: the depth for which v(T / 2) = 0, found on a grid of depths."""
    def end(depth):
        def out(t, y):
            return y[0] + 1
        out.terminal, out.direction = True, 1
        s = solve_ivp(lambda t, y: [y[1], -y[0] + k * max(0, -1 - y[0])**1.5], (0, 9), [-1 - depth, 0], events=out,
                      method="DOP853", rtol=1e-12, atol=1e-14)
        t, (q, v) = s.t[-1], s.y[:, -1]
        rest = 0.75 * np.pi - t
        return v * np.cos(rest) - q * np.sin(rest), t, v
    grid = np.geomspace(1e-3, 0.5, 200)
    values = [end(d)[0] for d in grid]
    i = next(i for i in range(199, 0, -1) if values[i - 1] * values[i] < 0)
    a, b = grid[i - 1], grid[i]
    for _ in range(60):
        c = (a + b) / 2
        a, b = (c, b) if end(a)[0] * end(c)[0] > 0 else (a, c)
    _, t, v = end(a)
    # s at the end: the integral of dt / (2 r)
    def regular(s, y):
        return [-y[2], 2 * y[0] * y[2], 2 * y[0] * -y[1] + 2 * k * y[0]**4]
    done = lambda s, y: y[0]
    done.terminal, done.direction = True, -1
    s = solve_ivp(regular, (0, 99), [np.sqrt(a), -1 - a, 0], events=done, method="DOP853", rtol=1e-12, atol=1e-14)
    z = np.zeros(n + 1)
    z[p], z[n] = -1 - a, s.t[-1]
    return z


def verify(n, p, k, gamma, z):
    """The checks of one motion; (time of contact, energy)."""
    q, v = z[:n], 0 * z[:n]
    r, t, qc, vc = contact(q.reshape(-1, 1), v.reshape(-1, 1), k, p, gamma, z[n:].reshape(1, 1))
    half = 3 * mp.pi / 4
    qh, vh = free(qc, vc, gamma, half - t)
    E = energy(q, v, k, gamma)
    assert abs(energy(qh[:, 0], vh[:, 0], k, gamma) - E) < 1e-26
    for j in range(65):
        low = free(qc, vc, gamma, (half - t) * j / 64)[0][:, 0]
        assert all(a > -1 for i, a in enumerate(low) if i != p or j > 0), (j, low)
    assert all(a > -1 for i, a in enumerate(q) if i != p)
    kf, gf = float(k), float(gamma)

    def rhs(_, y, pressed=True):
        a = pull(y[:n, None], gf)[:, 0]
        if pressed:
            a[p] += kf * max(0, -1 - y[p])**1.5
        return np.append(y[n:], a)
    out = lambda t, y: y[p] + 1
    out.terminal, out.direction = True, 1
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}
    s = solve_ivp(rhs, (0, 3), np.append(q.astype(float), v.astype(float)), events=out, max_step=1e-3, **options)
    assert abs(s.t[-1] - t[0, 0]) < 1e-9, (s.t[-1], t)
    s = solve_ivp(lambda t, y: rhs(t, y, False), (s.t[-1], float(half)), s.y[:, -1], **options).y[:, -1]
    worst = abs(s[n:]).max()
    assert worst < 1e-9, worst
    assert abs(energy(s[:n], s[n:], kf, gf) - E) < 1e-11 * (1 + kf / 1e3)
    print(n, k, gamma, "DOP853:", float(worst))
    return t[0, 0], E


def family(n, p, k, gammas):
    z, gamma, rows = first(n, p, float(k)), 0.0, []
    for target in gammas:
        steps = max(1, round((float(target) - gamma) / 0.01))
        old = None
        for j in range(1, steps + 1):
            g = gamma + (float(target) - gamma) * j / steps
            f = residual_of(n, p, float(k), g)
            guess = z if old is None else 2 * z - old
            old = z
            z = refine(f, guess)
        gamma = float(target)
        exact = lattice.newton(residual_of(n, p, mpf(k), mpf(target)), z)
        t, E = verify(n, p, mpf(k), mpf(target), exact)
        rows.append((target, t, E, [a if abs(a) > 1e-32 else mpf(0) for a in exact[:n]]))
    return rows


def refine(f, z):
    for _ in range(20):
        J = f(z[:, None] + 1e-40j * np.eye(len(z))).imag / 1e-40
        step = np.linalg.solve(J, f(z[:, None])[:, 0])
        z = z - step
        if abs(step).max() < 1e-11:
            return z
    raise ValueError("Newton's method does not converge")


EQUATION = """
Ring of n unit masses, stiffness 1 each, coupling gamma, force k max(0, -1 - q)^(3/2) of a floor; T = 3 pi / 2. Motions even
about t = 0 and T / 2, v = 0 at both; particle p (counted from 0) is in contact from t = -tc to tc, the others never. Energy
with that of the contact. q: displacements at t = 0. 34 digits, made and checked by hertz_orbits.py. All digits are good.
"""

if __name__ == "__main__":
    for name, n, p, ks, gammas in (("hertz_orbits_4", 4, 1, ("100", "10000"), ("0", "0.1")),
                                   ("hertz_orbits_30", 30, 15, ("100",), ("0", "0.1", "0.187"))):
        rows = [[n, p, mpf(k), mpf(g), t, E, *q] for k in ks for g, t, E, q in family(n, p, k, gammas)]
        tables.write(__file__, name, EQUATION, ["n", "p", "k", "gamma", "tc", "energy"] + [f"q{i}" for i in range(n)], rows)
