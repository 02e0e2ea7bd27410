"""Finite strain over linear elasticity for a sphere on wide layers: fills deep_layers.csv.

Lengths are in radii of the sphere and forces in E R^2. The linear force is the exact one of a
paraboloid on a linear layer (layer.py); the other one is of axisymmetric.py. What the file holds
already is not computed again, so a run that was stopped goes on.
    deep_layers.py [ELEMENTS...]    elements under the contact; 24 and 40 if not given
"""
import csv
import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np
from scipy.optimize import brentq

from axisymmetric import Solid, press
from axisymmetric_mesh import disc
from layer import contact

HERE = os.path.dirname(os.path.abspath(__file__))
NAMES = ["base", "poisson", "thickness", "elements", "depth", "force", "linear_force", "ratio",
         "contact_radius", "least_volume", "stable"]
RATIOS = (0.45, 0.33, 0.49, 0.2, 0.4, 0.0, 0.499, 0.475, 0.27)
THICKNESSES = (64.0, 1.0, 0.5, 2.0, 4.0, 0.3, 0.7, 1.4, 2.8, 8.0, 0.4, 16.0)
STEPS = 24


def linear_force(depth, thickness, poisson, base):
    """The exact force of a paraboloid, in E R^2."""
    name = "clamped" if base == "bonded" else "frictionless"
    radius = brentq(lambda a: contact(a / thickness, poisson, name)[0] * a * a - depth,
                    0.3 * np.sqrt(depth), 2.5 * np.sqrt(depth), xtol=1e-12, rtol=1e-10)
    force = 2.0 * radius ** 3 * contact(radius / thickness, poisson, name)[1]
    return force / (1.0 - poisson ** 2)


def depths(thickness):
    """Up to 0.8 radii and 0.6 thicknesses; the square roots are equally far apart."""
    deepest = min(0.8, 0.6 * thickness)
    return deepest * (np.arange(3, STEPS + 1) / STEPS) ** 2


def layer_mesh(thickness, deepest, elements, base):
    """A disc so wide that its side changes the force by less than 5e-4.

    Where the base holds the layer, its motion dies out within a few thicknesses.
    """
    widest = 1.1 * np.sqrt(deepest * (2.0 - deepest))
    width = widest + (10.0 if base == "bonded" else 40.0) * thickness
    return disc(width, [thickness], widest, elements)


def run(base, poisson, thickness, elements):
    """Rows of one path; shorter where no equilibrium is found."""
    wanted = depths(thickness)
    solid = Solid(layer_mesh(thickness, wanted[-1], elements, base), 1.0, poisson, base)
    for reading in press(solid, 1.0, wanted):
        linear = linear_force(reading.depth, thickness, poisson, base)
        yield [base, poisson, thickness, elements, f"{reading.depth:.8g}", f"{reading.force:.7g}",
               f"{linear:.7g}", f"{reading.force / linear:.6f}", f"{reading.contact_radius:.5f}",
               f"{reading.least_volume:.4f}", int(reading.stable)]


def main():
    path = os.path.join(HERE, "deep_layers.csv")
    done = set()
    if os.path.exists(path):
        with open(path, newline="") as file:
            done = {(r["base"], float(r["poisson"]), float(r["thickness"]), int(r["elements"]))
                    for r in csv.DictReader(file)}
    else:
        with open(path, "w") as file:
            file.write(",".join(NAMES) + "\n")
    for elements in [int(word) for word in sys.argv[1:]] or [24, 40]:
        for base in ("bonded", "frictionless"):
            for thickness in THICKNESSES:
                for poisson in RATIOS:
                    key = (base, poisson, thickness, elements)
                    if key in done:
                        continue
                    start = time.time()
                    rows = list(run(*key))
                    with open(path, "a") as file:
                        file.writelines(",".join(map(str, row)) + "\n" for row in rows)
                    last = rows[-1] if rows else ["-"] * 11
                    print(*key, "to", last[4], "ratio", last[7], f"{time.time() - start:.1f} s",
                          file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
