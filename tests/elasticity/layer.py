"""Exact frictionless contact of a rigid paraboloid with an infinitely wide layer.

The integral equation of the elastic layer with its Green's function in Hankel space; see the
layer's section of docs/theory.md. Written out here again so that the check is on its own feet.
"""
import functools

import numpy as np

gauss = functools.lru_cache(np.polynomial.legendre.leggauss)  # 800 points take a second


def transform_gap(u, nu, base):
    """M = 1 - L of the layer's kernel, u = wave number times thickness."""
    e = np.exp(-2.0 * u)
    if base == "clamped":  # L = (2 k sinh 2u - 4u) / (2 k cosh 2u + 1 + k^2 + 4u^2), k = 3 - 4 nu
        k = 3.0 - 4.0 * nu
        top = k * (1.0 - e * e) - 4.0 * u * e
        return 1.0 - top / (k * (1.0 + e * e) + (1.0 + k * k + 4.0 * u * u) * e)
    # L = (cosh 2u - 1) / (sinh 2u + 2u); 0/0 at u = 0, where L -> 0 like u/2
    with np.errstate(invalid="ignore"):
        ratio = (0.5 * (1.0 + e * e) - e) / (0.5 * (1.0 - e * e) + 2.0 * u * e)
    return 1.0 - np.where(u == 0.0, 0.0, ratio)


def contact(ratio, nu, base, points=48):
    """For contact radius over thickness `ratio`: depth R / a^2 and F R / (2 E* a^3)."""
    s, weight = gauss(points)
    s, weight = 0.5 * (s + 1.0), 0.5 * weight
    u, step = gauss(800)
    u, step = 25.0 * (u + 1.0), 25.0 * step  # M falls like exp(-2u)
    waves = np.cos(np.outer(np.append(s, 1.0), u) * ratio)
    kernel = 2.0 / np.pi * ratio * (waves * (step * transform_gap(u, nu, base))) @ waves[:-1].T
    # g(s) - int Q(s,t) g(t) dt = D - s^2 with g(1) = 0 sets D
    matrix = np.eye(points) - kernel[:-1] * weight
    unit = np.linalg.solve(matrix, np.ones(points))
    square = np.linalg.solve(matrix, s * s)
    edge = lambda g, right: right + kernel[-1] @ (weight * g)
    depth = edge(square, 1.0) / edge(unit, 1.0)
    return depth, weight @ (depth * unit - square)


def press(radius, depth, thickness, nu, base):
    """F over Hertz's force on a half-space, and the contact radius."""
    low, high = 0.2, 1.6
    for _ in range(60):
        middle = 0.5 * (low + high)
        a = middle * np.sqrt(radius * depth)
        reached = contact(a / thickness, nu, base)[0] * a * a / radius
        low, high = (middle, high) if reached < depth else (low, middle)
    force = contact(a / thickness, nu, base)[1] * 2.0 * a ** 3 / radius
    return force / (4.0 / 3.0 * np.sqrt(radius) * depth ** 1.5), a
