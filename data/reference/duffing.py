#!/usr/bin/python3
"""Periodic motions of the hardening Duffing oscillator x'' + 0.1 x' + x + x^3 = A cos(w t).

Method. Shooting over P = m 2 pi / w, m = 1 or 2, from t = 0. The flow and its tangent are Taylor series of order 24 in
doubles (to follow a branch by pseudo-arclength) and of order 44 with 34 digits (to polish the points that are stored:
Newton with residuals in 34 digits). Folds and branch points are roots of the periodicity and of det(M - 1), doublings of
the periodicity and of det(M + 1), in x(0), v(0) and w. At a branch point the roots are those of the symmetric motions,
x(P / 2) = -x(0), v(P / 2) = -v(0).

Checks, which fail loudly: det M = exp(-0.1 P) to 1e-25; harmonic balance on 192 or 512 points of a period in doubles gives the
same x(0), v(0) to 4e-11 / min(1, |det(M - 1)|), and at a fold, with x(0) prescribed, the same w to 1e-11 with
dw / dx(0) = 0 to 1e-8; scipy's DOP853 gives the multipliers +-1 at the special points to 1e-8 (its tolerance is 1e-13).
All digits printed come from the 34-digit polish and are good.
"""
import math

import mpmath as mp
import numpy as np
from mpmath import mpf
from scipy.integrate import solve_ivp

import tables

mp.mp.dps = 34
C, B = mpf(1) / 10, mpf(1)


def series(x, v, tangents, t, A, w, order, m, c):
    """Taylor coefficients of the motion and its tangents about t; m is math or mpmath."""
    X, S, D = [x, v], [x * x], [list(d) for d in tangents]
    wave = (A * m.cos(w * t), -A * m.sin(w * t))
    scale = 1
    for k in range(order - 1):
        if k:
            S.append(sum(X[i] * X[k - i] for i in range(k + 1)))
            scale = scale * w / k
        cube = sum(X[i] * S[k - i] for i in range(k + 1))
        force = (1, 1, -1, -1)[k % 4] * wave[k % 2] * scale
        X.append((force - c * (k + 1) * X[k + 1] - X[k] - cube) / ((k + 1) * (k + 2)))
        for T in D:
            lin = sum(S[i] * T[k - i] for i in range(k + 1))
            T.append((-c * (k + 1) * T[k + 1] - T[k] - 3 * lin) / ((k + 1) * (k + 2)))
    return X, D


def value(coef, h):
    """(value, derivative) of a polynomial."""
    p, d = coef[-1], 0 * h
    for a in reversed(coef[:-1]):
        d = d * h + p
        p = p * h + a
    return p, d


def flow(x, v, A, w, P, precise=False, pieces=None):
    """State and tangent matrix after the time P."""
    m, order, tol, c = (mp, 44, mpf(10)**-36, C) if precise else (math, 24, 1e-17, 0.1)
    one = x * 0 + 1
    D, t = [[one, 0 * one], [0 * one, one]], 0 * one
    while t < P:
        X, T = series(x, v, D, t, A, w, order, m, c)
        big = max(max(abs(Y[-1]), abs(Y[-2])) / (1 + abs(Y[0]) + abs(Y[1])) for Y in [X] + T)
        h = min((tol / big)**(one / (order - 1)) if big > 0 else P, P - t)
        if P - t - h < 1e-9 * P:
            h = P - t
        if pieces is not None:
            pieces.append((t, h, X))
        x, v = value(X, h)
        D = [value(Y, h) for Y in T]
        t = t + h if t + h < P else P
    return x, v, [[D[0][0], D[1][0]], [D[0][1], D[1][1]]]


def residual(z, A, m, kind, precise):
    """Periodicity, and the determinant of the special point, of z = (x, v, w)."""
    x, v, w = z
    pi = mp.pi if precise else math.pi
    P = 2 * pi * m / w
    if kind in ("branch", "symmetric"):    # half a period and the reflection
        a, b, M = flow(x, v, A, w, P / 2, precise)
        M = [[-M[0][0], -M[0][1]], [-M[1][0], -M[1][1]]]
        r = [a + x, b + v]
        sign = -1
    else:
        a, b, M = flow(x, v, A, w, P, precise)
        r = [a - x, b - v]
        sign = -1 if kind == "doubling" else 1
    if kind not in ("regular", "symmetric"):
        r.append((M[0][0] - sign) * (M[1][1] - sign) - M[0][1] * M[1][0])
    return r


def jacobian(z, A, m, kind):
    cols = []
    for i in range(2 if kind in ("regular", "symmetric") else 3):
        h = 1e-6 * max(1, abs(z[i]))
        a, b = list(z), list(z)
        a[i] += h
        b[i] -= h
        cols.append((np.array(residual(a, A, m, kind, False)) - np.array(residual(b, A, m, kind, False))) / (2 * h))
    return np.array(cols).T


def polish(z, A, m=1, kind="regular"):
    """z = (x, v, w) to 30 digits; the frequency of a regular point stays."""
    A = mpf(A)
    z = [mpf(a) for a in z]
    for precise in (False, True):
        for _ in range(20):
            f = [float(a) for a in z]
            r = residual(z, A, m, kind, True) if precise else residual(f, float(A), m, kind, False)
            J = jacobian(f, float(A), m, kind)
            step = mp.lu_solve(mp.matrix(J.tolist()), mp.matrix([mpf(a) for a in r]))
            for i in range(len(r)):
                z[i] -= step[i]
            if max(abs(s) for s in step) < (1e-27 if precise else 1e-9):
                break
        else:
            raise ValueError(f"no convergence at {z}")
    return z


def multipliers(z, A, m=1):
    P = 2 * mp.pi * m / z[2]
    _, _, M = flow(*z[:2], mpf(A), z[2], P, True)
    tr, det = M[0][0] + M[1][1], M[0][0] * M[1][1] - M[0][1] * M[1][0]
    assert abs(det - mp.exp(-C * P)) < 1e-25, det
    root = mp.sqrt(mp.mpc(tr * tr / 4 - det))
    return sorted((tr / 2 + root, tr / 2 - root), key=lambda u: -abs(u))


def largest(z, A, m=1):
    """Largest |x| along the motion: at the zeros of the velocity."""
    P = 2 * mp.pi * m / z[2]
    pieces = []
    flow(*z[:2], mpf(A), z[2], P, True, pieces)
    best = abs(z[0])
    for _, h, X in pieces:
        for k in range(8):
            a, b = h * k / 8, h * (k + 1) / 8
            va, vb = value(X, a)[1], value(X, b)[1]
            if va * vb <= 0:
                s = mp.findroot(lambda u: value(X, u)[1], (a, b), solver="anderson", tol=1e-60)
                best = max(best, abs(value(X, s)[0]))
    return best


# ---- branches in doubles ----

def augmented(z, A, m):
    """F and dF/d(x, v, w)."""
    x, v, w = z
    P = 2 * math.pi * m / w
    a, b, M = flow(x, v, A, w, P)
    h = 1e-6
    p, q = (flow(x, v, A, w + d, 2 * math.pi * m / (w + d)) for d in (h, -h))
    J = np.array([[M[0][0] - 1, M[0][1], (p[0] - q[0]) / (2 * h)], [M[1][0], M[1][1] - 1, (p[1] - q[1]) / (2 * h)]])
    return np.array([a - x, b - v]), J, np.array(M)


def follow(z, A, m, direction, lower, upper, step=0.02, limit=600, longest=0.05, tangent=None):
    """Points (z, tangent, M) along a branch in double precision while the frequency stays in its interval."""
    z = np.array(z, dtype=float)
    old = np.array([0, 0, direction], dtype=float) if tangent is None else tangent
    found = []
    if tangent is None:
        for _ in range(30):
            F, J, M = augmented(z, A, m)
            d = np.linalg.solve(J[:, :2], -F)
            z[:2] += d
            if abs(d).max() < 1e-11:
                break
    while len(found) < limit:
        _, J, M = augmented(z, A, m)
        t = np.linalg.svd(J)[2][2]
        t *= np.sign(t @ old) or 1
        found.append((z.copy(), t, M))
        if not lower <= z[2] <= upper or (len(found) > 30 and abs(z - found[0][0]).max() < step / 4):
            break
        while True:
            y = z + step * t
            for it in range(8):
                F, J, _ = augmented(y, A, m)
                try:
                    d = np.linalg.solve(np.vstack([J, t]), -np.append(F, t @ (y - z) - step))
                except np.linalg.LinAlgError:
                    d = np.full(3, 1.0)
                y += d
                if abs(y - z).max() > 4 * step:
                    it = 9
                    break
                if abs(d).max() < 1e-10:
                    break
            else:
                it = 9
            if it == 9:
                step /= 2
                if step < 1e-7:
                    print("follow: stuck at", z)
                    return found
                continue
            break
        if it < 4:
            step = min(step * 1.3, longest)
        old, z = t, y
    return found


def specials(branch):
    """(kind, point before, point after) of the sign changes along a branch."""
    out = []
    for (a, ta, Ma), (b, tb, Mb) in zip(branch, branch[1:]):
        det = lambda M, s: (M[0, 0] - s) * (M[1, 1] - s) - M[0, 1] * M[1, 0]
        if det(Ma, 1) * det(Mb, 1) < 0:
            out.append(("fold" if ta[2] * tb[2] < 0 else "branch", a, b, det(Ma, 1), det(Mb, 1)))
        if det(Ma, -1) * det(Mb, -1) < 0:
            out.append(("doubling", a, b, det(Ma, -1), det(Mb, -1)))
    return out


# ---- checks ----

def balance(z, A, m, pinned=False):
    """Harmonic balance from the motion through z: (x(0), v(0), w, dw/dx(0) if x(0) is prescribed)."""
    x0, v0, w = map(float, z)
    count = 512 if A > 5 else 192
    P = 2 * math.pi * m / w
    tau = np.arange(count) / count
    pieces = []
    flow(x0, v0, A, w, P, pieces=pieces)
    x = np.array([next(value(X, s * P - t)[0] for t, h, X in pieces if s * P <= t + h) for s in tau])
    modes = np.fft.fftfreq(count, 1 / count)
    F = np.fft.fft(np.eye(count), axis=0)
    odd = modes.copy()
    odd[count // 2] = 0
    d1 = np.fft.ifft(1j * odd[:, None] * F, axis=0).real
    d2 = np.fft.ifft(-(modes**2)[:, None] * F, axis=0).real
    force = A * np.cos(2 * math.pi * m * tau)
    for _ in range(12):
        o = w / m
        R = o * o * (d2 @ x) + 0.1 * o * (d1 @ x) + x + x**3 - force
        J = o * o * d2 + 0.1 * o * d1 + np.diag(1 + 3 * x * x)
        if pinned:
            full = np.zeros((count + 1, count + 1))
            full[:count, :count], full[count, 0] = J, 1
            full[:count, count] = (2 * o * (d2 @ x) + 0.1 * (d1 @ x)) / m
            d = np.linalg.solve(full, -np.append(R, x[0] - x0))
            x, w = x + d[:-1], w + d[-1]
        else:
            d = np.linalg.solve(J, -R)
            x = x + d
        if abs(d).max() < 1e-13:
            break
    slope = np.linalg.solve(full, np.append(np.zeros(count), 1))[-1] if pinned else 0
    return x[0], w / m * (d1 @ x)[0], w, slope


def dop853(z, A, m):
    """Multipliers by scipy."""
    w = float(z[2])

    def rhs(t, y):
        k = -1 - 3 * y[0] * y[0]
        return [y[1], A * math.cos(w * t) - 0.1 * y[1] - y[0] - y[0]**3, y[3], k * y[2] - 0.1 * y[3], y[5],
                k * y[4] - 0.1 * y[5]]
    s = solve_ivp(rhs, (0, 2 * math.pi * m / w), [float(z[0]), float(z[1]), 1, 0, 0, 1], method="DOP853", rtol=1e-13,
                  atol=1e-15).y[:, -1]
    assert abs(s[0] - float(z[0])) + abs(s[1] - float(z[1])) < 1e-9, (s, z)
    return np.linalg.eigvals([[s[2], s[4]], [s[3], s[5]]])


COLUMNS = ["kind", "A", "m", "symmetric", "w", "x0", "v0", "top", "re1", "im1", "re2", "im2"]
WORST = {"balance": 0.0, "fold": 0.0, "dop853": 0.0}


def row(kind, z, A, m, symmetric):
    mu = multipliers(z, A, m)
    a = float(A)
    if kind in ("regular", "start"):
        x, v, _, _ = balance(z, a, m)
        WORST["balance"] = max(WORST["balance"], abs(x - z[0]), abs(v - z[1]))
        near = min(1, abs(1 - mu[0] - mu[1] + mu[0] * mu[1]))    # det(M - 1)
        assert max(abs(x - z[0]), abs(v - z[1])) < 4e-11 / near, (z, x, v, near)
    else:
        sign = -1 if kind == "doubling" else 1
        assert min(abs(u - sign) for u in mu) < 1e-22, mu
        off = min(abs(u - sign) for u in dop853(z, a, m))
        WORST["dop853"] = max(WORST["dop853"], off)
        assert off < 1e-8, off
        if kind == "fold":
            _, _, w, slope = balance(z, a, m, True)
            WORST["fold"] = max(WORST["fold"], abs(w - z[2]))
            assert abs(w - z[2]) < 1e-11 and abs(slope) < 1e-8, (w, z, slope)
    half = flow(z[0], z[1], mpf(A), z[2], mp.pi / z[2], True)
    assert (m == 1 and abs(half[0] + z[0]) + abs(half[1] + z[1]) < 1e-15) == bool(symmetric), half
    return [kind, mpf(A), m, symmetric, z[2], z[0], z[1], largest(z, A, m), mu[0].real, mu[0].imag, mu[1].real, mu[1].imag]


def locate(special, A, m):
    kind, a, b, da, db = special
    z = a + (b - a) * abs(da) / (abs(da) + abs(db))
    return kind, polish(z, A, m, kind)


def off(z, A, m, sign):
    """A point of the branch that leaves the special point z, and its direction."""
    z = np.array([float(a) for a in z])
    _, J, _ = augmented(z, A, m)
    phi = sign * np.append(np.linalg.svd(J[:, :2])[2][1], 0)
    y = z + 0.01 * phi
    for _ in range(15):
        F, J, _ = augmented(y, A, m)
        d = np.linalg.solve(np.vstack([J, phi]), -np.append(F, phi @ (y - z) - 0.01))
        y += d
        if abs(d).max() < 1e-11:
            return y, phi
    raise ValueError(f"no branch leaves {z}")


def points(branch, A, m, symmetric, count, kind="regular"):
    """Rows evenly along a branch, at frequencies of four decimals, except where a fold is too near."""
    rows = []
    length = np.cumsum([0] + [np.linalg.norm(b[0] - a[0]) for a, b in zip(branch, branch[1:])])
    for s in np.linspace(0, length[-1], count):
        z = [float(a) for a in branch[int(np.argmin(abs(length - s)))][0]]
        near = [z[0], z[1], mpf(str(round(z[2], 4)))]
        try:
            y = polish(near, A, m)
        except (ValueError, OverflowError):
            y = None
        if y is None or abs(y[0] - z[0]) + abs(y[1] - z[1]) > 0.05:
            y = polish(z, A, m)
        rows.append(row(kind, y, A, m, symmetric))
    return rows


def main():
    rows = []
    for A in (0.3, 0.5):
        branch = follow((-A / 5.25, 0, 2.5), A, 1, -1, 0.4, 2.501, longest=0.04, limit=600)
        found = [(k, z) for k, z in (locate(s, str(A), 1) for s in specials(branch))]
        print(A, [(k, mp.nstr(z[2], 15)) for k, z in found], flush=True)
        rows += points([b for b in branch if b[0][2] >= 0.4], str(A), 1, 1, 15)
        rows += [row(k, z, str(A), 1, 1) for k, z in found]
    rows += symmetry_breaking()
    rows += doubling()
    tables.write(__file__, "duffing", """
x'' + 0.1 x' + x + x^3 = A cos(w t): motions of the period m 2 pi / w through x0, v0 at t = 0. top: largest |x| along the
motion; re1 .. im2: Floquet multipliers over the period; symmetric: x(t + pi / w) = -x(t). kind: regular, fold (multiplier
+1), branch (multiplier +1, an asymmetric branch leaves the symmetric one), doubling (multiplier -1).
34 digits, made and checked by duffing.py. All digits are good.
""", COLUMNS, rows)
    print({k: float(v) for k, v in WORST.items()})


def symmetry_breaking():
    """A = 1.5: two branch points, and the asymmetric branch that connects them."""
    A = "1.5"
    branch = follow((1.78427195, 0.74374798, 1.6), 1.5, 1, -1, 0.45, 1.7, longest=0.05, limit=200)
    found = [locate(s, 1.5, 1) for s in specials(branch)]
    print(A, [(k, mp.nstr(z[2], 15)) for k, z in found], flush=True)
    rows = points(branch, A, 1, 1, 12) + [row(k, z, A, 1, 1) for k, z in found]
    y, phi = off(next(z for k, z in found if k == "branch"), 1.5, 1, 1)
    loop = follow(y, 1.5, 1, 0, 0.5, 1.5, step=0.02, longest=0.04, limit=110, tangent=phi)
    return rows + points(loop[3:], A, 1, 0, 10)


def doubling():
    """A = 14: a branch point, the asymmetric branch, its doublings and motions of twice the period."""
    A = "14"
    branch = follow((2.2391428315073307, 0.5554937825417668, 0.75), 14.0, 1, -1, 0.5, 0.8, longest=0.05, limit=50)
    last = min(range(len(branch)), key=lambda i: branch[i][0][2])
    point = polish(branch[last][0], 14, 1, "branch")
    found = [locate(s, 14.0, 1) for s in specials(branch[:last])]
    print(A, "branch", mp.nstr(point[2], 15), [(k, mp.nstr(z[2], 15)) for k, z in found], flush=True)
    rows = points(branch[:last - 3], A, 1, 0, 10)
    rows += [row("branch", point, A, 1, 1)] + [row(k, z, A, 1, 0) for k, z in found]
    for way in (-1, 1):
        z = point
        for k in (1, 2, 3):
            z = polish([z[0], z[1], mpf(str(round(float(point[2]) + way * k / 250, 4)))], A, 1, "symmetric")
            rows.append(row("regular", z, A, 1, 1))
    for k, z in found:
        if k == "doubling":
            y, phi = off(z, 14.0, 2, 1)
            twice = follow(y, 14.0, 2, 0, 0.6, 0.75, step=0.01, longest=0.02, limit=22, tangent=phi)
            print("doubled", twice[-1][0])
            rows += points(twice[2:], A, 2, 0, 5)
    return rows


if __name__ == "__main__":
    main()
