"""Free motion of lattices with cubic springs by Taylor series of any order, in doubles, complex numbers or mpmath numbers.

q'' = -K q - B' (b (B q)^3): B has one row a cubic spring (its elongation), b their coefficients. Arrays have a column for
every motion; numbers of mpmath live in arrays of objects, and complex ones give derivatives (complex steps).
"""
import mpmath as mp
import numpy as np


def orders(q):
    """(order, tolerance) of the series."""
    return (44, mp.mpf(10)**-36) if q.dtype == object else (26, 1e-18)


def length(new, old, order, tol, rest):
    """Length of a step from the last two coefficients."""
    size = max(abs(a) for a in old.ravel()) + 1
    big = max(max(abs(a) for a in c.ravel()) for c in new) / size
    return min((tol / big)**(type(tol)(1) / (order - 1)), rest) if big > 0 else rest


def horner(coef, h):
    p = coef[-1]
    for a in coef[-2::-1]:
        p = p * h + a
    return p


def flow(K, B, b, q, v, time, low=None):
    """(q, v) after the time. low: a list that receives the least displacements, at 16 times of every step."""
    order, tol = orders(q)
    b = np.asarray(b)[:, None]
    while time > 0:
        Q = np.empty((order + 1,) + q.shape, dtype=q.dtype)
        D = np.empty((order + 1, len(B), q.shape[1]), dtype=q.dtype)
        S = np.empty_like(D)
        Q[0], Q[1] = q, v
        for k in range(order - 1):
            force = -(K @ Q[k])
            if len(B):
                D[k] = B @ Q[k]
                S[k] = (D[:k + 1] * D[k::-1]).sum(axis=0)
                force = force - B.T @ (b * (D[:k + 1] * S[k::-1]).sum(axis=0))
            Q[k + 2] = force / ((k + 1) * (k + 2))
        h = length(Q[-2:], q, order, tol, time)
        if low is not None:
            low.extend(horner(Q, h * j / 16) for j in range(16))
        V = np.array([Q[k] * k for k in range(1, order + 1)])
        q, v = horner(Q, h), horner(V, h)
        time = time - h
    return q, v


def column(values):
    return np.array(values).reshape(-1, 1)


def precise(array):
    """Numbers of mpmath from doubles or text."""
    array = np.asarray(array)
    return np.array([mp.mpf(a) if isinstance(a, (str, mp.mpf)) else mp.mpf(float(a)) for a in array.ravel()],
                    dtype=object).reshape(array.shape)


def newton(residual, z, digits=30):
    """Root of residual(columns): doubles with complex steps, then residuals in mpmath with that Jacobian."""
    z = np.array(z, dtype=float)

    def jacobian(z):
        n = len(z)
        return residual(z[:, None] + 1e-40j * np.eye(n)).imag / 1e-40
    for _ in range(40):
        step = np.linalg.solve(jacobian(z), residual(column(z))[:, 0])
        z -= step
        if abs(step).max() < 1e-12:
            break
    else:
        raise ValueError("Newton's method does not converge")
    inverse = precise(np.linalg.inv(jacobian(z)))
    z, last = precise(z), 1
    for _ in range(12):
        step = inverse @ residual(z.reshape(-1, 1))[:, 0]
        z, last = z - step, max(abs(a) for a in step)
        if last < mp.mpf(10)**-digits:
            return z
    raise ValueError(f"the last step is {last}")
