"""Fits how the size of an ellipsoid or a lying cylinder changes the force of `hertz` on its top.

Draws COUNT bodies with a rigid finger of radius R: full axes of 2.5 to 10 R and a height of 1.5 to
6 R, or a radius of 1 to 5 R and a length of 2 to 14 R; nu 0 to 0.495; depths to 0.5 R. Their truth
is coupled springs, refined by their own error. The fit, theory.md (68), takes the even ones; the
odd ones count how often `hertz` states at least its true error.

    curved_bodies.py PALPATE COUNT      prints a table; half a second a body
"""
import concurrent.futures
import csv
import os
import random
import subprocess
import sys
import tempfile

import numpy as np

SCENARIO = """schema = 1
[tissue]
young_modulus = "30 kPa"
poisson_ratio = {nu:.4f}
shape = {shape}
[finger]
material = "rigid"
radius = "{radius:.4g} mm"
[contact]
viscosity = "none"
[output]
interval = "0.1 s"
pressure_maps = false
fits = false
figures = false
[[step]]
kind = "indent"
to = "{depth:.6g} mm"
rate = "{depth:.6g} mm/s"
"""


def draw(number):
    """A scenario, with what the fit needs of it; lengths in mm."""
    u = random.Random(number).uniform
    radius, nu = u(5.0, 15.0), u(0.0, 0.495)
    if number // 2 % 2:
        kind = "cylinder"
        own, length = u(1.0, 5.0) * radius, u(2.0, 14.0) * radius
        size, curvatures = (2.0 * own, length, 2.0 * own), (1.0 / own, 0.0)
        shape = f'{{ kind = "cylinder", radius = "{own:.6g} mm", length = "{length:.6g} mm" }}'
    else:
        kind = "ellipsoid"
        size = (u(2.5, 10.0) * radius, u(2.5, 10.0) * radius, u(1.5, 6.0) * radius)
        curvatures = [2.0 * size[2] / width ** 2 for width in size[:2]]
        shape = '{ kind = "ellipsoid", size = ["%.6g mm", "%.6g mm", "%.6g mm"] }' % size
    depth = min(0.5 * radius, 0.3 * size[2]) * u(0.03, 1.0)
    effective = np.prod([1.0 / radius + one for one in curvatures]) ** -0.5
    return {"kind": kind, "size": size, "q": (1.0 - 2.0 * nu) / (1.0 - nu),
            "contact": np.sqrt(effective * depth),
            "text": SCENARIO.format(nu=nu, shape=shape, radius=radius, depth=depth)}


def findings(program, folder, *settings):
    """Force and stated error; None where palpate refuses."""
    words = [word for one in settings for word in ("--set", one)]
    ended = subprocess.run([program, "run", "press.toml", "--out", "out", "--force"] + words,
                           cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if ended.returncode != 0:
        return None
    with open(os.path.join(folder, "out", "press", "findings.csv"), newline="") as file:
        found = next(csv.DictReader(file))
    return float(found["peak_force_N"]), float(found["stated_error"])


def measure(program, number):
    body = draw(number)
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "press.toml"), "w") as file:
            file.write(body["text"])
        # Both with the factor of a deep press, or without it where the body is too curved for it.
        for depth in ("contact.depth=neo_hookean", "contact.depth=hertz"):
            found = findings(program, folder, depth, "solver.model=hertz")
            if found:
                break
        force, stated = found
        truth, _ = findings(program, folder, depth, "solver.model=coupled_springs",
                            "solver.tolerance=0.01")
    x, z = body["contact"] / body["size"][2], body["size"][2]
    along_x, along_y = z / body["size"][0], z / body["size"][1]
    slenderness = along_x + along_y if body["kind"] == "ellipsoid" else along_y ** 2
    return {"kind": body["kind"], "number": number, "change": truth / force - 1.0,
            "error": abs(force / truth - 1.0), "stated": stated,
            "terms": [x, x * body["q"], x * slenderness]}


def main():
    program, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = list(pool.map(lambda number: measure(program, number), range(count)))
    print("| body | fitted to | terms | others | covered, % | stated over true, median |")
    print("|---|---|---|---|---|---|")
    for kind in ("ellipsoid", "cylinder"):
        fitted, others = ([row for row in rows if row["kind"] == kind and row["number"] % 2 == odd]
                          for odd in (0, 1))
        terms = np.linalg.lstsq(np.array([row["terms"] for row in fitted]),
                                np.array([row["change"] for row in fitted]), rcond=None)[0]
        covered = np.mean([row["error"] <= row["stated"] for row in others])
        ratio = np.median([row["stated"] / row["error"] for row in others])
        print(f"| {kind} | {len(fitted)} | {', '.join(f'{one:.2f}' for one in terms)} | "
              f"{len(others)} | {100 * covered:.0f} | {ratio:.1f} |")


if __name__ == "__main__":
    main()
