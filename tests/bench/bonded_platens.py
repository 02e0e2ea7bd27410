#!/usr/bin/env python3
"""How much bonded platens stiffen cylinders and blocks, and what a coarse mesh adds to it.

    tests/bench/bonded_platens.py build/dev/palpate

Every body is compressed on meshes of 700, 2800 and 11 000 nodes by `coupled_springs`; the limit of fine
meshes is extrapolated from the last two, whose error falls with the square of the spacing. A row has the
shape, S (loaded over free surface, halved where one platen slips), Poisson's ratio, the limit over Young's
modulus, the same by the closed form of src/scene/estimates.h, and the errors of 700 and 2800 nodes beside
the stated ones.
"""

import csv
import json
import os
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


def shape(kind, half, height):
    if kind == "cylinder":
        return f'{{kind="cylinder",radius="{half} mm",length="{height} mm"}}'
    return f'{{kind="cuboid",size=["{2 * half} mm","{2 * half} mm","{height} mm"]}}'


def modulus(program, folder, body, platen, ratio, nodes):
    call = [program, "--quiet", "run", "press.toml", "--force"]
    for setting in (
        "tissue.shape=" + body, "step.1.platen=" + platen, f"tissue.poisson_ratio={ratio}",
        f'tissue.mesh={{kind="tetgen",nodes={nodes}}}',
    ):
        call += ["--set", setting]
    subprocess.run(call, cwd=folder, check=True)
    told = [program, "explain", "press.toml", "--json"] + call[5:]
    told = json.loads(subprocess.run(told, cwd=folder, check=True, capture_output=True).stdout)
    with open(os.path.join(folder, "out/press/findings.csv")) as file:
        return float(next(csv.DictReader(file))["secant_modulus_kPa"]), told


def stiffening(form, ratio):
    confined = (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio))
    return 1 + 1 / (1 / (2 * form**2) + 1 / (confined - 1))


def main():
    program = os.path.abspath(sys.argv[1])
    print("| body | S | Poisson's ratio | E_s / E | closed form | error, 700 nodes, % | stated | 2800 | stated |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "press.toml"), "w") as file:
            file.write(SCENARIO)
        for kind in ("cylinder", "block"):
            for half, height in SIZES:
                for platen, ends in (("frictionless", 1), ("bonded", 2)):
                    for ratio in RATIOS:
                        body = shape(kind, half, height)
                        found = [modulus(program, folder, body, platen, ratio, n) for n in NODES]
                        coarse, middle, fine = (one[0] for one in found)
                        stated = [one[1]["error"] for one in found]
                        limit = fine - (middle - fine) / ((NODES[2] / NODES[1]) ** (2 / 3) - 1)
                        form = 0.25 * ends * half / height
                        print(
                            f"| {kind} {2 * half} x {height} mm | {form:g} | {ratio} | {limit / MODULUS:.2f} "
                            f"| {stiffening(form, ratio):.2f} | {100 * (coarse / limit - 1):.1f} "
                            f"| {100 * stated[0]:.1f} | {100 * (middle / limit - 1):.1f} "
                            f"| {100 * stated[1]:.1f} |",
                            flush=True,
                        )


if __name__ == "__main__":
    main()
