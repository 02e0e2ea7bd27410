#!/usr/bin/env python3
"""How well a stand finds the surface by itself, where its gauge scatters.

    tests/bench/surface_search.py build/dev/palpate build/dev/palpate-emulator [RUNS]

RUNS emulated runs (20 unless given) of scenarios/device_stand.toml without `--surface` for each noise, which is the
standard deviation of a reading: the gauge's own average is off. A run withdraws to the surface that it found, which
is compared with the tissue's. A run that ends with a sentence in place of a surface is counted by itself.
"""

import argparse
import json
import os
import signal
import subprocess
import tempfile

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENARIO = os.path.join(PROJECT, "scenarios", "device_stand.toml")
TISSUE = os.path.join(PROJECT, "scenarios", "emulator", "stand_tissue.toml")
SURFACE = -2.0  # mm, of that tissue
ALLOWED = {1: 0.05, 3: 0.05, 10: 0.1, 30: 0.3}  # mm, by the noise in mN


def play(arguments, noise, seed):
    """The error of the surface in mm, or the sentence of a run without one."""
    with tempfile.TemporaryDirectory() as folder:
        stand = os.path.join(folder, "stand.toml")
        with open(stand, "w") as file:
            file.write(f'[gauge]\nfilter = 0\nnoise = "{noise} mN"\n')
        call = [arguments.emulator, "mark10", "--clock", "virtual", "--seed", str(seed)]
        call += ["--tissue", TISSUE, "--stand", stand]
        emulator = subprocess.Popen(call, cwd=folder, stdout=subprocess.PIPE, text=True)
        try:
            port = json.loads(emulator.stdout.readline())["port"]
            call = [arguments.palpate, "run", SCENARIO, "--device", "mark10:" + port, "--arm"]
            call += ["--clock", "virtual", "--set", "output.figures=false"]
            ended = subprocess.run(call, cwd=folder, stderr=subprocess.PIPE, text=True, timeout=60)
        finally:
            emulator.send_signal(signal.SIGTERM)
            summary = json.loads(emulator.communicate()[0].splitlines()[-1])
        if ended.returncode != 0:
            return [line for line in ended.stderr.splitlines() if "palpate: " in line][-1]
    return 1e3 * summary["summary"]["position_m"] - SURFACE


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate", type=os.path.abspath)
    parser.add_argument("emulator", type=os.path.abspath)
    parser.add_argument("runs", type=int, nargs="?", default=20)
    arguments = parser.parse_args()
    print("| noise, mN | allowed, mm | within it | mean, mm | farthest, mm | without a surface |")
    print("|---|---|---|---|---|---|")
    said = set()
    for noise, allowed in ALLOWED.items():
        found = [play(arguments, noise, seed) for seed in range(1, arguments.runs + 1)]
        errors = [error for error in found if not isinstance(error, str)]
        said.update(error for error in found if isinstance(error, str))
        within = sum(abs(error) <= allowed for error in errors)
        mean = sum(errors) / len(errors) if errors else float("nan")
        most = max(errors, key=abs) if errors else float("nan")
        print(f"| {noise} | {allowed} | {within} of {len(found)} | {mean:.3f} | {most:.3f} | {len(found) - len(errors)} |")
    for sentence in sorted(said):
        print(sentence)


if __name__ == "__main__":
    main()
