"""axisymmetric.py where the answer is known: fills axisymmetric_checks.csv.

Bodies of tests/cases/bodies.csv, the exact linear layers of layer.py, Sneddon's sphere on a
half-space and the fitted factors of deep presses in tests/cases/physics.csv. `error` is what a
coarser mesh (16 instead of 24 elements under the contact) differs by, and `deviation` what the
finer one differs by from the given value; both are fractions of it.
"""
import csv
import os
import re

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np

import axisymmetric_mesh as meshes
from axisymmetric import SmallStrain, Solid, press
from deep_layers import layer_mesh, linear_force

HERE = os.path.dirname(os.path.abspath(__file__))
CASES = os.path.join(HERE, "..", "cases")
MESHES = (16, 24)


def read(name):
    with open(os.path.join(CASES, name), newline="") as file:
        return list(csv.DictReader(file))


def numbers(text):
    return [float(word) for word in text.split("/")]


def body_mesh(case, shape, contact, elements):
    """The mesh of a case of bodies.csv, by its name and its column `shape`."""
    if case.startswith("dome"):
        return meshes.dome(*numbers(case[4:].split("-nu")[0].replace("-", "/")), contact, elements)
    if case.startswith("disc"):
        radius, height = numbers(case[4:].split("-nu")[0].replace("-", "/"))
        return meshes.disc(radius, [height], contact, elements)
    if case.startswith("block"):
        return meshes.disc(33.851, [30.0], contact, elements)
    if case.startswith("lump"):
        if "x1-" in case:
            return meshes.disc(45.135, [40.0], contact, elements)
        return meshes.disc_with_ball(45.135, 40.0, 5.0, 10.0, contact, elements)
    layers = {"layers-skin-fat-muscle": [2.0, 8.0, 20.0], "layers-skin2-on-muscle28": [2.0, 28.0]}
    return meshes.disc(80.0, layers[case], contact, elements)


def bodies():
    cases = {}
    for row in read("bodies.csv"):
        cases.setdefault(row["case"], []).append(row)
    for case, rows in cases.items():
        radius = float(rows[0]["sphere_radius_mm"])
        travels = [float(row["travel_mm"]) for row in rows]
        deepest = travels[-1]
        path = sorted(set(travels) | {deepest * (k / 12.0) ** 2 for k in range(3, 12)})
        youngs = numbers(rows[0]["young_modulus_kPa"])
        poisson = numbers(rows[0]["poisson_ratio"])
        if case.startswith("lump-x1-"):
            youngs = youngs[:1]
        found = []
        for elements in MESHES:
            mesh = body_mesh(case, rows[0]["shape"], 1.35 * np.sqrt(radius * deepest), elements)
            solid = Solid(mesh, youngs, poisson if len(poisson) == len(youngs) else poisson[0])
            linear = SmallStrain(solid, 1.3 * np.sqrt(2.0 * radius * deepest))
            both = [{r.depth: r.force for r in linear.press(radius, path, name)}
                    for name in ("vertical", "normal")]
            deep = {r.depth: r.force for r in press(solid, radius, path)}
            found.append({"force_low_mN": {t: min(f[t] for f in both) for t in travels},
                          "force_high_mN": {t: max(f[t] for f in both) for t in travels},
                          "force_neo_hookean_mN": {t: deep[t] for t in travels}})
        for row, travel in zip(rows, travels):
            for name in found[0]:
                if row[name]:
                    yield case, f"{name} at {travel:g} mm", float(row[name]), \
                        [forces[name][travel] for forces in found]


def exact_layers():
    for base in ("bonded", "frictionless"):
        for poisson, thickness in ((0.33, 1.0), (0.499, 0.3), (0.45, 64.0)):
            path = np.array([0.01, 0.04, 0.1, 0.2]) * min(1.0, thickness)
            found = []
            for elements in MESHES:
                solid = Solid(layer_mesh(thickness, path[-1], elements, base), 1.0, poisson, base)
                readings = SmallStrain(solid, 1.0).press(1.0, path, "paraboloid")
                found.append([reading.force for reading in readings])
            for k, depth in enumerate(path):
                yield f"layer {base} nu {poisson:g} t/R {thickness:g}", \
                    f"paraboloid at h/R {depth:g}", \
                    linear_force(depth, thickness, poisson, base), [f[k] for f in found]


def large():
    """The cases of group `large`: ratios to Hertz's force on a half-space, here a body 64 radii
    thick whose linear force is the exact one of its thickness."""
    groups = {}
    for row in read("physics.csv"):
        match = re.match(r"neo-Hookean frictionless sphere nu=([\d.]+) h/R=([\d.]+)", row["input"])
        if row["group"] == "large" and match:
            groups.setdefault(float(match[1]), []).append((float(match[2]), row))
    sneddon = [row for row in read("physics.csv") if row["id"] == "large-19"][0]
    for poisson, rows in groups.items():
        path = sorted({0.5 * (k / 12.0) ** 2 for k in range(3, 13)} | {0.1, 0.3, 0.5})
        found = []
        for elements in MESHES:
            solid = Solid(layer_mesh(64.0, 0.5, elements, "bonded"), 1.0, poisson)
            found.append({r.depth: r.force for r in press(solid, 1.0, path)})
            if poisson == 0.45:
                vertical = SmallStrain(solid, 1.3).press(1.0, [0.1, 0.2, 0.3], "vertical")[-1]
                found[-1]["sneddon"] = vertical.force
        for depth, row in rows:
            exact = linear_force(depth, 64.0, poisson, "bonded")
            yield row["id"], row["input"], float(row["value"]), [f[depth] / exact for f in found]
        if poisson == 0.45:
            exact = linear_force(0.3, 64.0, poisson, "bonded")
            yield "large-19", sneddon["input"], float(sneddon["value"]), \
                [f["sneddon"] / exact for f in found]


def main():
    with open(os.path.join(HERE, "axisymmetric_checks.csv"), "w") as file:
        file.write("case,quantity,given,computed,deviation,error\n")
        for part in (bodies, exact_layers, large):
            worst = 0.0
            for case, quantity, given, (coarse, fine) in part():
                quantity = quantity.replace(",", "")
                worst = max(worst, abs(fine / given - 1.0))
                file.write(f"{case},{quantity},{given:.6g},{fine:.6g},{fine / given - 1.0:+.5f},"
                           f"{abs(fine - coarse) / given:.5f}\n")
                file.flush()
            print(part.__name__, f"deviate by {worst:.4f} at most", flush=True)


if __name__ == "__main__":
    main()
