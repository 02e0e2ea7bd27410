"""Time and memory of whole runs, from start to files, against the size of the mesh.

    python3 tests/bench/set_up.py build/measure/palpate [largest number of nodes]

A block of 60 x 60 x 30 mm of muscle is pressed by 1 mm on finer and finer meshes, each in a process
of its own. Prints a table and the exponent of time over nodes from 6000 nodes on; a million
tetrahedra take half a minute and 2.6 GB.
"""

import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

SCENARIO = """
schema = 1
[tissue]
material = "muscle"
shape = {{ kind = "cuboid", size = ["60 mm", "60 mm", "30 mm"] }}
mesh = {{ cells = [{0}, {0}, {1}] }}
[solver]
model = "{2}"
[[step]]
kind = "indent"
to = "1 mm"
rate = "10 mm/s"
"""
CELLS = [(6, 3), (14, 7), (22, 11), (33, 18), (50, 25), (70, 34)]


def measured(program, folder, cells, model):
    """Seconds, MB and the findings of one run."""
    scenario = folder / "block.toml"
    scenario.write_text(SCENARIO.format(*cells, model))
    start = time.monotonic()
    child = subprocess.Popen([program, "run", str(scenario), "--out", str(folder / "out"), "--force"],
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    seconds = time.monotonic() - start
    if status != 0:
        raise SystemExit(f"{model} on {cells} cells ended with {status}")
    with open(folder / "out/block/findings.csv", newline="", encoding="utf-8") as file:
        findings = next(csv.DictReader(file))
    return seconds, usage.ru_maxrss / 1e3, findings


def main():
    program = sys.argv[1]
    most = float(sys.argv[2]) if len(sys.argv) > 2 else math.inf
    print("| nodes | tetrahedra | coupled_springs, s | MB | mass_spring, s | MB | error of the solution |")
    print("|---|---|---|---|---|---|---|")
    points = []
    with tempfile.TemporaryDirectory() as name:
        for cells in CELLS:
            if (cells[0] + 1) ** 2 * (cells[1] + 1) > most:
                break
            row = []
            for model in ("coupled_springs", "mass_spring"):
                seconds, megabytes, findings = measured(program, pathlib.Path(name), cells, model)
                row.append((seconds, megabytes))
                if model == "coupled_springs":
                    points.append((float(findings["nodes"]), seconds))
                    coupled = findings
            error = coupled.get("solution_error") or "factored"
            if error != "factored":
                error = f"{float(error):.0e}"
            print(f"| {coupled['nodes']} | {coupled['tetrahedra']} | {row[0][0]:.2f} | {row[0][1]:.0f} "
                  f"| {row[1][0]:.2f} | {row[1][1]:.0f} | {error} |", flush=True)
    large = [(math.log(n), math.log(s)) for n, s in points if n > 6000]
    if len(large) > 1:
        x, y = large[0], large[-1]
        print(f"\nExponent of `coupled_springs` from 6000 nodes on: {(y[1] - x[1]) / (y[0] - x[0]):.2f}")


main()
