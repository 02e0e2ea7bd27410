"""Counts how often `hertz` states at least its true error on bodies that stand on part of themselves.

Draws COUNT bodies with a rigid finger of radius R, pressed near their top: lumpy ellipsoids from a
file, turned at random, of which half are cut off flat below, and layered limbs of one tissue. They
are held by their flat underside or by their lowest tenth. Their truth is coupled springs, refined
by their own error to 1 %.

    standing_bodies.py PALPATE COUNT [FIRST]      prints a table; three seconds a body
"""
import concurrent.futures
import os
import random
import sys
import tempfile

import numpy as np

sys.dont_write_bytecode = True
from curved_bodies import SCENARIO, findings

TAGGED = """[[region]]
kind = "tagged"
tag = {tag}
material = "skin"
young_modulus = "30 kPa"
poisson_ratio = {nu:.4f}
"""


def sphere(rounds):
    """Vertices on the unit sphere and triangles: an octahedron, split `rounds` times."""
    vertices = [np.array(v, float) for v in
                ((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    triangles = [(i, (i + 1) % 4, 4) for i in range(4)] + [((i + 1) % 4, i, 5) for i in range(4)]
    for _ in range(rounds):
        middles, finer = {}, []

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                point = vertices[i] + vertices[j]
                middles[key] = len(vertices)
                vertices.append(point / np.linalg.norm(point))
            return middles[key]

        for a, b, c in triangles:
            x, y, z = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, x, z), (b, y, x), (c, z, y), (x, y, z)]
        triangles = finer
    return np.array(vertices), triangles


def lumpy(draw, radius, flat):
    """An OFF file, mm, with a place of the finger near the top and the height."""
    u = draw.uniform
    points, triangles = sphere(4)
    turn, _ = np.linalg.qr([[draw.gauss(0, 1) for _ in range(3)] for _ in range(3)])
    turn *= np.sign(np.linalg.det(turn))
    lumps = np.ones(len(points))
    for _ in range(4):
        towards = np.array([draw.gauss(0, 1) for _ in range(3)])
        cosine = np.clip(points @ towards / np.linalg.norm(towards), -1, 1)
        lumps += u(-0.12, 0.12) * np.cos(u(1, 3) * np.arccos(cosine))
    axes = np.array([u(1.5, 6) * radius for _ in range(3)])
    points = (points * lumps[:, None] * axes) @ turn.T
    if flat:
        low = points[:, 2].min()
        points[:, 2] = np.maximum(points[:, 2], low + u(0.08, 0.25) * np.ptp(points[:, 2]))
    points -= points.min(axis=0)
    size = np.ptp(points, axis=0)
    place = points[points[:, 2].argmax()][:2] + u(0, 0.35) * u(-1, 1) * size[:2]
    text = f"OFF\n{len(points)} {len(triangles)} 0\n"
    text += "".join("%.6f %.6f %.6f\n" % tuple(p) for p in points)
    return text + "".join("3 %d %d %d\n" % t for t in triangles), place, size[2]


def draw_body(number):
    """The kind, and the files of a scenario by name."""
    draw = random.Random(number)
    u = draw.uniform
    radius, nu = u(5, 15), u(0, 0.495)
    kind = ("round below", "flat below", "limb")[number % 3]
    files, regions, finger = {}, "", ""
    if kind == "limb":
        own = u(1.5, 8) * radius
        end, height = own * u(0.5, 1), 2.0 * own
        shape = (f'{{ kind = "layered_limb", radius = "{own:.5g} mm", end_radius = "{end:.5g} mm", '
                 f'length = "{u(4, 30) * radius:.5g} mm", skin_thickness = "{0.2 * end:.5g} mm", '
                 f'bone_radius = "{0.2 * end:.5g} mm" }}')
        regions = "".join(TAGGED.format(tag=tag, nu=nu) for tag in (1, 2))
    else:
        shape = '{ kind = "file", file = "body.off", unit = "mm" }'
        files["body.off"], place, height = lumpy(draw, radius, kind == "flat below")
        finger = 'x = "%.5g mm"\ny = "%.5g mm"\n' % tuple(place)
    depth = min(0.5 * radius, 0.3 * height) * u(0.03, 0.6)
    text = SCENARIO.format(nu=nu, shape=shape, radius=radius, depth=depth)
    files["press.toml"] = text.replace("[contact]", finger + "[contact]") + regions
    return kind, files


def measure(program, number):
    kind, files = draw_body(number)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        # Both with the factor of a deep press, or without it where the body is too curved for it.
        for depth in ("contact.depth=neo_hookean", "contact.depth=hertz"):
            found = findings(program, folder, depth, "solver.model=hertz")
            if found:
                break
        truth = found and findings(program, folder, depth, "solver.model=coupled_springs",
                                   "solver.tolerance=0.02")
    if not truth:
        return kind, None
    return kind, (abs(found[0] / truth[0] - 1.0), found[1], truth[1])


def main():
    program, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = list(pool.map(lambda i: measure(program, i), range(first, first + count)))
    print("| body | pressed | refused | true error, median and largest, % | covered, % | of those "
          "below 25 %, % | stated over true, median |")
    print("|---|---|---|---|---|---|---|")
    for kind in sorted({kind for kind, _ in rows}):
        pressed = np.array([row for one, row in rows if one == kind and row])
        refused = sum(one == kind and row is None for one, row in rows)
        error, stated, _ = pressed.T
        print(f"| {kind} | {len(error)} | {refused} | {100 * np.median(error):.0f}, "
              f"{100 * error.max():.0f} | {100 * np.mean(error <= stated):.0f} | "
              f"{100 * np.mean((error <= stated)[error < 0.25]):.0f} | "
              f"{np.median(stated / error):.1f} |")


if __name__ == "__main__":
    main()
