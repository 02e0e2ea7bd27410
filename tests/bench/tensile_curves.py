#!/usr/bin/env python3
"""Draws 25 tensile tests of five kinds and says how `palpate fit --model modulus` takes them: right (the slope at 2 to 10 %
strain within 4 standard errors or 2 %), refused with a sentence, or wrong. `tensile_curves.py PALPATE FOLDER [SEED]`"""

import csv
import io
import random
import subprocess
import sys
from pathlib import Path


def strains(kind, draw, end):
    """Strains in order, and the kind's own options."""
    n = draw.randint(200, 600)
    up = [end * i / n for i in range(n + 1)]
    if kind == "cycles":
        low = [0.12 * i / 60 for i in range(61)]
        return (low + low[::-1]) * draw.randint(2, 4) + up, ["--cycle", "1"]
    if kind == "directions":
        return [-0.15 + (0.15 + end) * i / n for i in range(n + 1)], []
    return up, []


def curve(kind, draw):
    young = 20 * 20 ** draw.random()  # kPa
    stiffening = 1.5 * draw.random()
    rupture = 0.3 + 0.4 * draw.random()
    toe = 0.05 * draw.random() if kind == "toe" else 0.0
    slip = 0.15 + 0.1 * draw.random() if kind == "slip" else 9.0
    noise = (0.02 if kind == "noise" else 0.003) * young * 0.3

    def law(e):
        stress = young * e * (1 + stiffening * abs(e))
        return stress * (0.97 if e > slip else 1.0)

    x, options = strains(kind, draw, 1.5 * rupture)
    y = [0.02 * law(rupture) if e > rupture else law(e - toe) if e > toe or toe == 0 else 0.0 for e in x]
    y = [each + draw.gauss(0, noise) for each in y]
    # The least-squares slope of the law over the range that is fitted.
    low, high = (0.02 + toe, 0.1 + toe)
    inside = [e for e in x[:61] if low <= e <= high] if kind == "cycles" else [e for e in x if low <= e <= high]
    mean = sum(inside) / len(inside)
    spread = sum((e - mean) ** 2 for e in inside)
    slope = sum((e - mean) * law(e - toe) for e in inside) / spread
    return x, y, slope, [*options, "--from", f"{100 * low:.6f} %", "--to", f"{100 * high:.6f} %"]


def main():
    palpate, folder = sys.argv[1], Path(sys.argv[2])
    draw = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 77)
    folder.mkdir(parents=True, exist_ok=True)
    wrong = 0
    print("| curve | slope, kPa | palpate | verdict |\n|---|---|---|---|")
    for k in range(25):
        kind = ("toe", "slip", "cycles", "directions", "noise")[k % 5]
        x, y, slope, options = curve(kind, draw)
        path = folder / f"{kind}_{k // 5 + 1}.csv"
        rows = "".join(f"{a:.6g},{b:.6g}\n" for a, b in zip(x, y, strict=True))
        path.write_text("strain (mm/mm),stress (kPa)\n" + rows)
        words = [palpate, "fit", str(path), "--x", "strain (mm/mm)", "--y", "stress (kPa)", "--model", "modulus", "--csv"]
        done = subprocess.run([*words, *options], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            print(f"| {path.stem} | {slope:.4g} | {done.stderr.strip().splitlines()[-1]} | refused |")
            continue
        first = next(csv.DictReader(io.StringIO(done.stdout)))
        found, error = float(first["estimate"]), float(first["std_error"])
        right = abs(found - slope) <= max(4 * error, 0.02 * slope)
        wrong += not right
        print(f"| {path.stem} | {slope:.4g} | {found:.4g} +- {error:.2g} | {'right' if right else 'WRONG'} |")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
