#!/usr/bin/env python3
"""Prints a table of docs/accuracy.md: forces against tests/cases/solid.csv, with what is stated, nodes
and processor time. `solid` with a tolerance of 0.05 takes one mesh, with 0.005 three; `auto` takes the
model of the defaults.

    tests/accuracy/solid_cases.py PALPATE MODEL TOLERANCE [ID...]
"""
import csv
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

CASES = pathlib.Path(__file__).resolve().parent.parent / "cases"
IN_TIME = {"tap", "shaft_creep", "short_relax", "visc_dome_kv"}
TRAVELS = {"finger_bone_061": 0.61}  # mm, where the scenario goes deeper


def run(program, case, model, tolerance):
    """Force (mN), stated error, model, nodes of the finest mesh and processor time (s) of a case."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [program, "run", str(CASES / "scenes" / f"{case}.toml"), "--set", f"solver.model={model}",
             "--set", f"solver.tolerance={tolerance}", "--out", os.path.join(folder, "out")],
            check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        files = {path.name: path for path in pathlib.Path(folder).rglob("*.csv")}
        with open(files["force_indentation.csv"], encoding="utf-8") as text:
            rows = list(csv.DictReader(text))
        with open(files["findings.csv"], encoding="utf-8") as text:
            findings = next(csv.DictReader(text))
    travel = TRAVELS.get(case, float(rows[-1]["travel_mm"]))
    row = min(rows, key=lambda one: abs(float(one["travel_mm"]) - travel))
    return (1e3 * float(row["contact_force_N"]), float(findings["stated_error"]),
            findings["model"], int(float(findings.get("nodes") or 0)),
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def main():
    program, model, tolerance, wanted = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
    print("| case | force, mN | palpate, mN | error, % | stated, % | model | nodes | time, s |")
    print("|---|---|---|---|---|---|---|---|")
    with open(CASES / "solid.csv", encoding="utf-8") as text:
        for case in csv.DictReader(text):
            name, force = case["id"], float(case["force_mN"])
            if name in IN_TIME or (wanted and name not in wanted):
                continue
            found, stated, taken, nodes, seconds = run(program, name, model, tolerance)
            print(f"| {name} | {force:g} | {found:.2f} | {100 * (found / force - 1):+.2f} | "
                  f"{100 * stated:.1f} | {taken} | {nodes} | {seconds:.1f} |", flush=True)


if __name__ == "__main__":
    main()
