"""Counts what large strains change where a stiff layer bends on a softer one, per root of the moduli's
ratio and displacement in thicknesses of the layer: the 0.02 of `stretch_bound` in
src/scene/estimates.cpp. The exact linear stack (`layer`) beside `solid` on two meshes.

Usage: python3 tests/accuracy/stiff_skins.py PALPATE [STACKS] [SEED]     (24 stacks take four minutes)
"""
import csv
import pathlib
import random
import subprocess
import sys
import tempfile

SCENARIO = """schema = 1
[tissue]
young_modulus = "{stiff} kPa"
poisson_ratio = {ratio:.3f}
viscosity = "none"
shape = {{ kind = "cuboid", size = ["{width} mm", "{width} mm", "{height:.2f} mm"] }}
[[region]]
kind = "slab"
bottom = "0 mm"
top = "{top:.2f} mm"
young_modulus = "4 kPa"
poisson_ratio = {ratio:.3f}
[finger]
material = "rigid"
radius = "{radius:.1f} mm"
[contact]
depth = "hertz"
[solver]
tolerance = 0.01
[output]
interval = "1 s"
pressure_maps = false
fits = false
figures = false
[[step]]
kind = "indent"
to = "{travel:.3f} mm"
rate = "{travel:.3f} mm/s"
"""


def force(program, folder, model):
    done = subprocess.run([program, "run", str(folder / "skin.toml"), "--set", f"solver.model={model}", "--out",
                           str(folder / model), "--force"], capture_output=True, text=True)
    if done.returncode:
        return None
    with open(folder / model / "skin" / "findings.csv", encoding="utf-8") as file:
        return float(next(csv.DictReader(file))["peak_force_N"])


def main():
    program = sys.argv[1]
    draw = random.Random(sys.argv[3] if len(sys.argv) > 3 else 0)
    coefficients = []
    for _ in range(int(sys.argv[2]) if len(sys.argv) > 2 else 24):
        thickness = draw.choice([0.3, 0.5, 1.0, 2.0])
        stiffer = 2.0 * 100.0 ** draw.random()
        height = draw.uniform(10.0, 30.0)
        radius = draw.uniform(4.0, 12.0)
        travel = draw.uniform(0.1, 0.12) * radius
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "skin.toml").write_text(SCENARIO.format(
                stiff=round(4.0 * stiffer, 1), ratio=draw.uniform(0.3, 0.49), width=100, height=height,
                top=height - thickness, radius=radius, travel=travel), encoding="utf-8")
            linear, solid = force(program, folder, "layer"), force(program, folder, "solid")
        if not linear or not solid:
            print(f"{thickness} mm, {stiffer:.0f} times as stiff: not computed")
            continue
        change = solid / linear - 1.0
        per = change / (stiffer ** (1.0 / 3.0) * travel / thickness)
        coefficients.append(per)
        print(f"{thickness} mm, {stiffer:.0f} times as stiff, pressed {travel:.2f} mm: {100 * change:+.1f} %, {per:.4f}",
              flush=True)
    print(f"largest of {len(coefficients)}: {max(coefficients):.4f}")


main()
