"""Finite strain over linear elasticity for a sphere on wide layers: fills deep_layers.csv.

Lengths are in radii of the sphere and forces in E R^2. The linear force is the exact one of a
paraboloid on a linear layer (layer.py); the other one is of axisymmetric.py, on two meshes of 24
and 40 elements under the contact. deep_layers_runs.csv (300 kB, not kept here) has every mesh; what
it holds already is not computed again, so a run that was stopped goes on. deep_layers.csv has the
finer mesh, and in `error` the difference of the two, as a fraction; empty where one mesh found no
equilibrium. `stable` is 0 where the body would rather fold.
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
RATIOS = (0.45, 0.33, 0.49, 0.2, 0.4, 0.0, 0.499, 0.475, 0.27, 0.1)
THICKNESSES = (64.0, 1.0, 0.5, 2.0, 4.0, 0.3, 0.7, 1.4, 2.8, 8.0, 0.4, 16.0)
STEPS = 24
MESHES = (24, 40)


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


def compute(path):
    """Appends the paths that the journal lacks."""
    done = set()
    if os.path.exists(path):
        with open(path, newline="") as file:
            done = {(r["base"], float(r["poisson"]), float(r["thickness"]), int(r["elements"]))
                    for r in csv.DictReader(file)}
    else:
        with open(path, "w") as file:
            file.write(",".join(NAMES) + "\n")
    for key in [(base, poisson, thickness, elements) for elements in MESHES
                for base in ("bonded", "frictionless") for thickness in THICKNESSES
                for poisson in RATIOS]:
        if key in done:
            continue
        start = time.time()
        rows = list(run(*key))
        with open(path, "a") as file:
            file.writelines(",".join(map(str, row)) + "\n" for row in rows)
        print(*key, f"{len(rows)} depths, {time.time() - start:.1f} s", file=sys.stderr, flush=True)


def condense(journal, path):
    """One row per depth, in order."""
    meshes = {elements: {} for elements in MESHES}
    with open(journal, newline="") as file:
        for row in csv.DictReader(file):
            key = (row["base"], *[float(row[n]) for n in ("poisson", "thickness", "depth")])
            meshes[int(row["elements"])][key] = row
    coarse, fine = (meshes[elements] for elements in MESHES)
    with open(path, "w") as file:
        file.write("base,poisson,thickness,depth,linear_force,ratio,error,contact_radius,"
                   "least_volume,stable\n")
        for key in sorted(coarse.keys() | fine.keys()):
            row, error = fine.get(key) or coarse[key], ""
            if key in fine and key in coarse:
                error = f"{abs(float(row['force']) / float(coarse[key]['force']) - 1.0):.5f}"
            file.write(f"{key[0]},{key[1]:g},{key[2]:g},{key[3]:.6g},"
                       f"{float(row['linear_force']):.5g},{float(row['ratio']):.5f},{error},"
                       f"{float(row['contact_radius']):.4g},{float(row['least_volume']):.3f},"
                       f"{row['stable']}\n")


def main():
    journal = os.path.join(HERE, "deep_layers_runs.csv")
    compute(journal)
    condense(journal, os.path.join(HERE, "deep_layers.csv"))


if __name__ == "__main__":
    main()
