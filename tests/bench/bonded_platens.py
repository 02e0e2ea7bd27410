#!/usr/bin/env python3
"""How much bonded platens stiffen cylinders and blocks, and what a coarse mesh adds to it.

    tests/bench/bonded_platens.py build/dev/palpate [--random BODIES SEED]

Every body is compressed on meshes of 700, 2800 and 11 000 nodes by `coupled_springs`; the limit of fine
meshes is extrapolated from the last two, whose error falls with the square of the spacing. A row has the
shape, S (loaded over free surface, halved where one platen slips), Poisson's ratio, the limit over Young's
modulus, the same by the closed form of src/scene/estimates.h, and the errors of 700 and 2800 nodes beside
the stated ones. With --random, bodies are drawn at random, on the default mesh and on one of 300 to 1500
nodes, and it is counted how often the stated error holds the true one.
"""

import csv
import json
import os
import random
import subprocess
import sys
import tempfile

MODULUS = 15.0  # kPa
SIZES = [(10, 20), (10, 10), (20, 10), (20, 5)]  # radius or half a side, and height, mm
NODES = [700, 2800, 11000]
RATIOS = [0.3, 0.45, 0.49]
SCENARIO = f"""schema = 1
[tissue]
young_modulus = "{MODULUS} kPa"
poisson_ratio = 0.45
base          = "bonded"
viscosity     = "none"
[solver]
model = "coupled_springs"
[[step]]
kind   = "compress"
strain = 0.01
rate   = "0.1 1/s"
[output]
interval = "100 ms"
figures  = false
report   = false
"""


def shape(kind, half, other, height):
    if kind == "cylinder":
        return f'{{kind="cylinder",radius="{half} mm",length="{height} mm"}}'
    return f'{{kind="cuboid",size=["{2 * half} mm","{2 * other} mm","{height} mm"]}}'


def modulus(program, folder, body, ends, ratio, nodes):
    """Modulus (kPa), nodes and stated error; the default mesh without `nodes`."""
    base, platen = ends
    settings = ["tissue.shape=" + body, "tissue.base=" + base, "step.1.platen=" + platen]
    settings.append(f"tissue.poisson_ratio={ratio}")
    if nodes:
        settings.append(f'tissue.mesh={{kind="tetgen",nodes={nodes}}}')
    rest = ["press.toml"] + [word for one in settings for word in ("--set", one)]
    subprocess.run([program, "--quiet", "run", "--force"] + rest, cwd=folder, check=True)
    told = subprocess.run([program, "explain", "--json"] + rest, cwd=folder, check=True, capture_output=True)
    with open(os.path.join(folder, "out/press/findings.csv")) as file:
        row = next(csv.DictReader(file))
    return float(row["secant_modulus_kPa"]), int(row["nodes"]), json.loads(told.stdout)["error"]


def extrapolated(middle, fine):
    return fine[0] - (middle[0] - fine[0]) / ((fine[1] / middle[1]) ** (2 / 3) - 1)


def stiffening(form, ratio):
    confined = (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio))
    return 1 + 1 / (1 / (2 * form**2) + 1 / (confined - 1))


def table(program, folder):
    print("| body | S | Poisson's ratio | E_s / E | closed form | error, 700 nodes, % | stated | 2800 | stated |")
    print("|---|---|---|---|---|---|---|---|---|")
    for kind in ("cylinder", "block"):
        for half, height in SIZES:
            for platen, ends in (("frictionless", 1), ("bonded", 2)):
                for ratio in RATIOS:
                    body = shape(kind, half, half, height)
                    found = [modulus(program, folder, body, ("bonded", platen), ratio, n) for n in NODES]
                    limit = extrapolated(found[1], found[2])
                    form = 0.25 * ends * half / height
                    errors = " | ".join(f"{100 * (one[0] / limit - 1):.1f} | {100 * one[2]:.1f}" for one in found[:2])
                    print(
                        f"| {kind} {2 * half} x {height} mm | {form:g} | {ratio} | {limit / MODULUS:.2f} "
                        f"| {stiffening(form, ratio):.2f} | {errors} |",
                        flush=True,
                    )


def at_random(program, folder, bodies, seed):
    random.seed(seed)
    ways = [("bonded", "bonded"), ("bonded", "frictionless"), ("frictionless", "bonded")]
    missed, shares = 0, []
    for _ in range(bodies):
        body = shape(
            random.choice(["cylinder", "block"]), random.uniform(5, 25), random.uniform(5, 25), random.uniform(4, 40)
        )
        ends, ratio = random.choice(ways), random.choice([random.uniform(0, 0.4), random.uniform(0.4, 0.495)])
        limit = extrapolated(*(modulus(program, folder, body, ends, ratio, n) for n in NODES[1:]))
        for nodes in (None, random.choice([300, 700, 1500])):
            found, _, stated = modulus(program, folder, body, ends, ratio, nodes)
            error = abs(found / limit - 1)
            shares.append(stated / max(error, 1e-9))
            if error > stated:
                missed += 1
                print(f"missed: {body} {ends} {ratio:.3f}, {nodes} nodes: {error:.3f}, stated {stated:.3f}", flush=True)
    shares.sort()
    print(f"{len(shares) - missed} of {len(shares)} hold; stated over true, median: {shares[len(shares) // 2]:.2f}")


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "press.toml"), "w") as file:
            file.write(SCENARIO)
        if sys.argv[2:3] == ["--random"]:
            at_random(program, folder, int(sys.argv[3]), int(sys.argv[4]))
        else:
            table(program, folder)


if __name__ == "__main__":
    main()
