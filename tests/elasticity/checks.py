"""Presses whose answers are known, into checks.csv: layer, half-space, large radius, energy."""
import csv
import os
import sys

import numpy as np

import block_contact
import layer

HERE = os.path.dirname(os.path.abspath(__file__))
RADIUS = 11.0


def block(half, height, zone, level, nu, base="clamped", ratios=(1.45, 1.3), whole_x=False):
    """Quarter (or half) of a square block of E = 1."""
    side = block_contact.half_axis(half, zone, level, ratios[0])
    x = np.concatenate([-side[:0:-1], side]) if whole_x else side
    down = block_contact.down_axis([height], zone, level, ratios[1])
    return block_contact.Surface([x, side, down], [(height, 1.0, nu)], base, 0.999 * zone)


def hertz(nu, radius, depth):
    return 4.0 / 3.0 / (1.0 - nu ** 2) * np.sqrt(radius) * depth ** 1.5


def paraboloid(surface, radius, depth):
    return block_contact.answer(
        surface, *block_contact.vertical(surface, radius, depth, "paraboloid"), False)


def wide_layer():
    """A block twelve times as wide as thick against the infinitely wide layer."""
    for nu, base in ((0.33, "clamped"), (0.45, "clamped"), (0.49, "clamped"),
                     (0.499, "clamped"), (0.45, "frictionless")):
        for depth in (0.25, 1.0):
            exact, exact_radius = layer.press(RADIUS, depth, 10.0, nu, base)
            zone = 1.3 * np.sqrt(RADIUS * depth)
            for level in (8, 12, 16):
                surface = block(60.0, 10.0, zone, level, nu, base)
                force, a = paraboloid(surface, RADIUS, depth)
                name = f"{base} layer 10 mm, nu {nu}, depth {depth} mm, level {level}"
                yield f"{name}: F/F_Hertz", exact, force / hertz(nu, RADIUS, depth)
                if level == 16:
                    yield f"{name}: contact radius mm", exact_radius, a


def wider_slippery_layer():
    """On a frictionless base the free sides are felt far away, falling with the width squared."""
    exact, _ = layer.press(RADIUS, 1.0, 10.0, 0.45, "frictionless")
    for half in (60.0, 120.0, 240.0):
        surface = block(half, 10.0, 1.3 * np.sqrt(RADIUS), 12, 0.45, "frictionless")
        force, _ = paraboloid(surface, RADIUS, 1.0)
        yield (f"frictionless layer 10 mm, nu 0.45, depth 1.0 mm, level 12, {2 * half:g} mm wide: "
               "F/F_Hertz", exact, force / hertz(0.45, RADIUS, 1.0))


def stiff_substrate():
    """A 3 mm layer on one a million times as stiff against the exact clamped layer of 3 mm."""
    zone = 1.45 * np.sqrt(RADIUS * 0.25)
    side = block_contact.half_axis(30.0, zone, 12)
    surface = block_contact.Surface(
        [side, side, block_contact.down_axis([3.0, 20.0], zone, 12)],
        [(3.0, 1.0, 0.45), (20.0, 1e6, 0.45)], "clamped", 0.999 * zone)
    force, _ = paraboloid(surface, RADIUS, 0.25)
    yield ("3 mm on a substrate 1e6 times as stiff, nu 0.45, depth 0.25 mm, level 12: F/F_Hertz",
           layer.press(RADIUS, 0.25, 3.0, 0.45, "clamped")[0], force / hertz(0.45, RADIUS, 0.25))


def half_space():
    """A block 20 m wide and 10 m deep against Hertz's paraboloid and Sneddon's sphere."""
    for nu in (0.10, 0.49):
        for level in (8, 10, 12):
            surface = block(1e4, 1e4, 1.3 * np.sqrt(RADIUS), level, nu, ratios=(1.7, 1.6))
            name = f"half-space, nu {nu}, level {level}"
            flat = hertz(nu, RADIUS, 1.0)
            base, a = paraboloid(surface, RADIUS, 1.0)
            yield f"{name}: paraboloid F/F_Hertz", 1.0, base / flat
            # Sneddon: h = a/2 ln((R+a)/(R-a)), F = E* [(a^2+R^2)/2 ln((R+a)/(R-a)) - a R]
            low, high = 0.0, 0.9 * RADIUS
            for _ in range(80):
                a = 0.5 * (low + high)
                log = np.log((RADIUS + a) / (RADIUS - a))
                low, high = (a, high) if 0.5 * a * log < 1.0 else (low, a)
            exact = (0.5 * (a * a + RADIUS ** 2) * log - a * RADIUS) / (1.0 - nu ** 2)
            (force, reached), _ = block_contact.press(surface, RADIUS, 1.0)
            yield f"{name}: sphere, vertical, F/F_Hertz", exact / flat, force / flat
            if level == 12:
                yield f"{name}: sphere, vertical, contact radius mm", a, reached
                # Normal over paraboloid - 1 = (1-2nu)/(pi (1-nu)) sqrt(h/R) + O(h/R), a kept
                radius, depth = np.sqrt(RADIUS / 1e-6), np.sqrt(RADIUS * 1e-6)
                _, (force, _) = block_contact.press(surface, radius, depth)
                base, _ = paraboloid(surface, radius, depth)
                yield (f"{name}: (normal/paraboloid - 1)/sqrt(h/R) at h/R 1e-6",
                       (1 - 2 * nu) / np.pi / (1 - nu), (force / base - 1) / 1e-3)


def energy():
    """The force is the derivative of the stored energy, in both variants."""
    surface = block(30.0, 10.0, 1.3 * np.sqrt(RADIUS), 12, 0.45)
    for name, solve in (("vertical", block_contact.vertical), ("normal", block_contact.normal)):
        stored = []
        for depth in (0.99, 1.01):
            forces, moved = solve(surface, RADIUS, depth)
            stored.append(0.5 * surface.times * np.sum(forces * moved))
        force, _ = block_contact.answer(surface, *solve(surface, RADIUS, 1.0), False)
        yield f"{name}: F against dW/dh over 0.02 mm", force, (stored[1] - stored[0]) / 0.02
    forces, moved = block_contact.normal(surface, RADIUS, 1.0)
    away = np.vstack([surface.points, np.full(moved.shape[1], 1.0 - RADIUS)]) + moved
    yield ("normal: distance of the deepest node from the centre, mm", RADIUS,
           np.min(np.sqrt(np.sum(away ** 2, axis=0))))


def half_model():
    """The half block of the press aside gives the quarter's force where both can be had."""
    quarter, half = (block(30.0, 10.0, 1.3 * np.sqrt(RADIUS), 6, 0.45, whole_x=whole)
                     for whole in (False, True))
    for name, one, other in zip(("vertical", "normal"), block_contact.press(quarter, RADIUS, 1.0),
                                block_contact.press(half, RADIUS, 1.0)):
        yield f"half block against quarter, {name}", one[0], other[0]


CHECKS = (half_model, energy, stiff_substrate, wider_slippery_layer, half_space, wide_layer)


def save(path, rows):
    with open(path + ".new", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["check", "exact", "here", "relative_difference"])
        writer.writerows([name, *cells] for name, cells in rows.items())
    os.replace(path + ".new", path)


if __name__ == "__main__":
    # checks.py NAME...: only these, the other rows of checks.csv stay.
    path, rows = os.path.join(HERE, "checks.csv"), {}
    if os.path.exists(path):
        with open(path, newline="") as file:
            rows = {row[0]: row[1:] for row in list(csv.reader(file))[1:]}
    for check in CHECKS:
        if len(sys.argv) > 1 and check.__name__ not in sys.argv[1:]:
            continue
        for name, exact, here in check():
            rows[name] = [f"{exact:.7g}", f"{here:.7g}", f"{here / exact - 1:.1e}"]
            save(path, rows)
            print(name, *rows[name], flush=True)
