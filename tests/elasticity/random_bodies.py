"""Reference forces on random bodies of revolution: fills random_bodies.csv and unseen_bodies.csv.

Discs, domes (half ellipsoids), layered discs and discs with a ball on the axis, and from number 200
to 299 discs with a hollow top, pressed on the axis up to half the sphere's radius; from number 300
on up to 0.8 radii. Numbers from 400 on are layers under a thin stiff skin, to half a radius. Those
from 500 on are of all kinds and go to unseen_bodies.csv: no formula is fitted to them. Body k is
drawn with the seed k, so that the files can be extended and a stopped run goes on. Lengths in mm,
moduli in kPa, forces in mN.
    random_bodies.py FIRST LAST
"""
import csv
import json
import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np

import axisymmetric_mesh as meshes
from axisymmetric import SmallStrain, Solid, press

HERE = os.path.dirname(os.path.abspath(__file__))
READINGS = ("paraboloid", "vertical", "normal", "neo_hookean")
NAMES = ["body", "kind", "shape", "youngs", "poisson", "base", "sphere_radius", "depth"] \
    + [part for name in READINGS for part in (name, name + "_error")]
MESHES = (16, 24)  # elements under the contact
DEPTHS = (0.15, 0.35, 0.65, 1.0)  # of the deepest


def draw(number):
    """The body of this number: kind, shape (mm), moduli, ratios, base, sphere and deepest press."""
    random = np.random.default_rng(number)
    kind = ("disc", "dome", "layers", "ball", "disc", "dome")[number % 6]
    if 200 <= number < 300:
        kind = "dish"
    elif number >= 400:
        kind = "layers"
    if number >= 500:
        kind = ("disc", "dome", "layers", "ball", "dish", "layers")[number % 6]
    under_skin = 400 <= number and (number < 500 or number % 6 == 5)
    radius = random.uniform(6.0, 14.0)
    youngs = random.uniform(5.0, 80.0)
    poisson = random.uniform(0.0, 0.49) if random.random() < 0.5 else random.uniform(0.4, 0.49)
    shape, ratios, base = {}, [poisson], "bonded"
    moduli = [youngs]
    if kind == "disc":
        height = radius * np.exp(random.uniform(np.log(0.4), np.log(4.0)))
        shape = {"radius": radius * random.uniform(1.8, 5.0), "layers": [height]}
        base = "bonded" if random.random() < 0.75 else "frictionless"
    elif kind == "dome":
        width = radius * random.uniform(1.5, 5.0)
        height = width * random.uniform(0.3, 1.1)
        shape = {"radius": width, "height": height}
    elif kind == "dish":
        hollow = radius * random.uniform(2.0, 6.0)
        height = radius * np.exp(random.uniform(np.log(0.5), np.log(3.0)))
        shape = {"radius": min(0.8 * hollow, 4.0 * radius), "height": height, "hollow": hollow}
    elif kind == "layers":
        count = random.integers(2, 4)
        layers = radius * np.exp(random.uniform(np.log(0.15), np.log(1.5), count))
        moduli = list(youngs * np.exp(random.uniform(np.log(0.1), np.log(10.0), count)))
        ratios = list(random.uniform(0.3, 0.49, count))
        if under_skin:
            layers[0] = radius * random.uniform(0.08, 0.4)
            layers[1:] = radius * random.uniform(0.5, 2.0, count - 1)
            moduli = [youngs] + list(youngs / np.exp(random.uniform(np.log(2.0), np.log(20.0),
                                                                    count - 1)))
        height = layers.sum()
        shape = {"radius": radius * 5.0, "layers": layers}
    else:
        height = radius * random.uniform(2.0, 4.0)
        ball = radius * random.uniform(0.25, 0.5)
        centre = ball + radius * random.uniform(0.3, 0.8)
        shape = {"radius": radius * 4.0, "height": height, "ball": ball, "centre": centre}
        moduli = [youngs, youngs * np.exp(random.uniform(np.log(0.2), np.log(20.0)))]
        ratios = [poisson, poisson]
    deepest = min((0.8 if 300 <= number < 400 else 0.5) * radius, 0.45 * height)
    if kind == "ball":
        deepest = min(deepest, 0.6 * (shape["centre"] - shape["ball"]))
    shape = {name: np.round(value, 3).tolist() for name, value in shape.items()}
    return {"body": number, "kind": kind, "shape": shape, "base": base,
            "youngs": np.round(moduli, 3).tolist(), "poisson": np.round(ratios, 4).tolist(),
            "sphere_radius": round(radius, 3), "deepest": round(deepest, 4)}


def solid(body, elements):
    shape, radius, deepest = body["shape"], body["sphere_radius"], body["deepest"]
    contact = 1.15 * np.sqrt(deepest * (2.0 * radius - deepest) * widening(body))
    contact = min(contact, 0.9 * shape["radius"])
    if body["kind"] in ("disc", "layers"):
        mesh = meshes.disc(shape["radius"], shape["layers"], contact, elements)
    elif body["kind"] == "dish":
        mesh = meshes.dish(shape["radius"], shape["height"], shape["hollow"], contact, elements)
    elif body["kind"] == "dome":
        mesh = meshes.dome(shape["radius"], shape["height"], contact, elements)
    else:
        mesh = meshes.disc_with_ball(shape["radius"], shape["height"], shape["ball"],
                                     shape["centre"], contact, elements)
    return Solid(mesh, body["youngs"], body["poisson"], body["base"])


def widening(body):
    """The square of how much wider a hollow makes the contact than a flat."""
    hollow = body["shape"].get("hollow")
    return 1.0 / (1.0 - body["sphere_radius"] / hollow) if hollow else 1.0


def forces(body, elements):
    """Forces by reading and depth; what was not found is missing."""
    pressed = solid(body, elements)
    radius, deepest = body["sphere_radius"], body["deepest"]
    wanted = [round(deepest * share, 4) for share in DEPTHS]
    path = sorted(set(wanted) | {deepest * (k / 12.0) ** 2 for k in range(3, 12)})
    linear = SmallStrain(pressed, 1.3 * np.sqrt(2.0 * radius * deepest * widening(body)))
    found = {name: linear.press(radius, path, name) for name in READINGS[:3]}
    found["neo_hookean"] = press(pressed, radius, path)
    return wanted, {(name, reading.depth): reading.force
                    for name, readings in found.items() for reading in readings}


def rows(body):
    """One row per depth: forces of the finer mesh and what the coarser one differs by."""
    (wanted, coarse), (_, fine) = [forces(body, elements) for elements in MESHES]
    for depth in wanted:
        row = [body["body"], body["kind"], json.dumps(body["shape"]), json.dumps(body["youngs"]),
               json.dumps(body["poisson"]), body["base"], body["sphere_radius"], f"{depth:g}"]
        for name in READINGS:
            both = [forces_of.get((name, depth)) for forces_of in (coarse, fine)]
            row += ["", ""] if None in both else [f"{both[1]:.6g}", f"{abs(both[1] - both[0]):.2g}"]
        yield row


def main():
    first, last = int(sys.argv[1]), int(sys.argv[2])
    path = os.path.join(HERE, "random_bodies.csv" if last < 500 else "unseen_bodies.csv")
    done = set()
    if os.path.exists(path):
        with open(path, newline="") as file:
            done = {int(row["body"]) for row in csv.DictReader(file)}
    else:
        with open(path, "w") as file:
            file.write(",".join(NAMES) + "\n")
    for number in range(first, last + 1):
        if number in done:
            continue
        start, body = time.time(), draw(number)
        made = list(rows(body))
        with open(path, "a", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(made)
        print(body, f"{time.time() - start:.1f} s", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
