#!/usr/bin/env python3
"""Processor time and model of `palpate run` by the defaults, of two programs in turns, on scenes of fresh_scenes.py.

    tests/accuracy/auto_cost.py BEFORE AFTER SEED SCENES

BEFORE and AFTER are programs. A row has the smaller of two times (user and system, s) of each.
"""
import csv
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True

import fresh_scenes


def run(program, folder):
    """Seconds and model, or what the program says where it refuses."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "run", "scene.toml", "--out", "out", "--force"], cwd=folder, capture_output=True,
                          text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        return None, done.stderr.strip().splitlines()[-1]
    with open(folder / "out/scene/findings.csv", encoding="utf-8", newline="") as file:
        model = next(csv.DictReader(file))["model"]
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, model


def main():
    programs = [str(pathlib.Path(word).resolve()) for word in sys.argv[1:3]]
    seed, scenes = int(sys.argv[3]), int(sys.argv[4])
    print("| scene | before, s | model | after, s | model |\n|---|---|---|---|---|")
    ratios, sums = [], [[], []]
    for number in range(scenes):
        scene = fresh_scenes.draw(seed, number)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            fresh_scenes.write(scene, folder)
            tries = [[run(program, folder) for program in programs] for _ in range(2)]
        both = [min((one[k] for one in tries), key=lambda pair: pair[0] or 0.0) for k in range(2)]
        cells = " | ".join(f"{spent:.2f} | {model}" if spent is not None else f"- | {model}" for spent, model in both)
        print(f"| {scene['kind']}, {scene['body']} | {cells} |", flush=True)
        if all(spent is not None for spent, _ in both):
            ratios.append(both[1][0] / both[0][0])
            for k in range(2):
                sums[k].append(both[k][0])
    print(f"\nMedian of {len(ratios)}: {statistics.median(sums[0]):.2f} s before, {statistics.median(sums[1]):.2f} s after; "
          f"after over before {statistics.median(ratios):.2f} in the median.")


if __name__ == "__main__":
    main()
