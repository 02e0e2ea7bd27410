#!/usr/bin/env python3
"""How often a live run names the fault that it has, and how often one without fault agrees.

    tests/bench/verdicts.py build/dev/palpate build/dev/palpate-emulator [RUNS] [--show]

RUNS emulated runs (200 unless given) have one fault each and as many have none, on the motorised stand and on
a sketch that prints time, force and travel, both with the tissue of scenarios/device_stand.toml. Kind, size and
time of a fault follow from the run's number: sizes are fractions of the model's largest force, 0.22 N. A fault is
named if `measured_causes` is that cause and no other, or if the run ends by its link with a sentence that says it.
"""

import argparse
import collections
import csv
import json
import os
import random
import signal
import subprocess
import tempfile

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENARIO = os.path.join(PROJECT, "scenarios", "device_stand.toml")
TISSUE = os.path.join(PROJECT, "scenarios", "emulator", "stand_tissue.toml")
HAND = os.path.join(PROJECT, "scenarios", "emulator", "gauge_hx711.toml")
SKETCH = os.path.join(PROJECT, "scenarios", "gauges", "hx711.toml")
PEAK = 220.0  # mN
TOUCHED = 1.0  # s of both emulators: the press, the hold and the way back take a second each


def fault(kind, at, **more):
    table = {"kind": kind, "at": f"{at:.3f} s", **more}
    return "[[fault]]\n" + "".join(f'{key} = "{value}"\n' for key, value in table.items())


class Run:
    """One session: files of the emulator, options of palpate, and what it should say."""

    def __init__(self, number, kind):
        chance = random.Random(number)
        self.seed, self.kind = number + 1, kind
        self.device = chance.choice(["stand", "sketch"])
        self.surface, self.faults, self.noise = "-2 mm", "", None
        self.settings = {}
        self.sketch = SKETCH
        self.travel = 4.0  # mm, deepest of the hand
        self.said = kind  # or a part of the sentence of a run that the link ends
        share = chance.uniform
        sign = chance.choice([-1, 1])
        if kind == "tare":
            self.said = "wrong_tare"
            self.faults = fault("spike", 0, value=f"{sign * share(0.1, 0.6) * PEAK:.1f} mN")
        elif kind == "sign":
            self.said = "wrong_sign"
            self.faults = fault("sign_flip", 0)
        elif kind == "surface":
            self.said = "wrong_surface"
            self.surface = f"{-2 + sign * share(0.25, 0.6):.3f} mm"
            self.travel = 4.6  # the hand reaches the travel that is asked of it
        elif kind == "stiffness":
            self.said = "wrong_stiffness"
            self.settings["tissue.young_modulus"] = f"{12 * chance.choice([share(0.5, 0.8), share(1.3, 2)]):.2f} kPa"
        elif kind == "no specimen":
            self.said = "no_specimen"
        elif kind == "drift":
            self.faults = fault("drift", 0, value=f"{sign * share(0.08, 0.3) * PEAK:.1f} mN")
        elif kind == "friction":
            self.faults = fault("friction", 0, value=f"{share(0.12, 0.4) * PEAK:.1f} mN")
        elif kind == "lag":
            # 140 ms are the longest that the emulator's gauge can be late.
            self.faults = fault("lag", 0, value=f"{share(100, 140):.0f} ms")
        elif kind == "lost force":
            self.said = "lost_force"
            self.faults = fault("lost_force", TOUCHED + share(0.6, 1.6))
        elif kind == "outlier":
            self.said = "outliers"
            period = 0.02 if self.device == "stand" else 0.1
            size = sign * share(0.5, 10) * PEAK
            self.faults = fault("spike", TOUCHED + share(0.2, 1.8), value=f"{size:.1f} mN", duration=f"{period:.3f} s")
        elif kind == "noise":
            # A reading of the emulator is the mean of 8 samples.
            self.noise = share(0.04, 0.12) * PEAK * 8 ** 0.5
        elif kind == "overload":
            self.said = "the gauge is overloaded"
            self.faults = fault("overload", TOUCHED + share(0.5, 1.5))
        elif kind == "short press":
            self.said = "short_press"
            self.travel = 2 + share(1.0, 1.8)
            if self.device == "stand":
                self.said = "the stand stopped on its way"
                self.faults = fault("limit_switch", TOUCHED + share(0.1, 0.8))
        elif kind == "clock jump":
            self.device, self.said = "sketch", "the device's own time jumped ahead"
            self.faults = fault("clock_jump", TOUCHED + share(0.2, 2.5), value=f"{share(2, 3600):.1f} s")

    def emulator(self, folder):
        tissue = "none" if self.kind == "no specimen" else TISSUE
        words = ["--clock", "virtual", "--seed", str(self.seed), "--tissue", tissue]
        if self.faults:
            words += ["--fault", write(folder, "faults.toml", self.faults)]
        gauge = f'noise = "{self.noise:.2f} mN"\n' if self.noise else ""
        if self.device == "stand":
            if gauge:
                words += ["--stand", write(folder, "stand.toml", "[gauge]\n" + gauge)]
            return ["mark10"] + words
        with open(HAND) as file:
            hand = file.read().replace('"4 mm"', f'"{self.travel:.2f} mm"')
        if gauge:
            hand = hand.replace('noise    = "0.2 mN"\n', gauge)
            # A tare by one reading of such noise would be a second fault.
            with open(SKETCH) as file:
                self.sketch = write(folder, "sketch.toml", file.read().replace('start       = "t"', 'start = "x"'))
        return ["gauge", "--baud", "57600", "--gauge", write(folder, "hand.toml", hand)] + words

    def link(self, port):
        return f"mark10:{port}" if self.device == "stand" else f"serial:{port},{self.sketch}"


KINDS = ["tare", "sign", "surface", "stiffness", "no specimen", "drift", "friction", "lag", "lost force",
         "outlier", "noise", "overload", "short press", "clock jump"]


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w") as file:
        file.write(text)
    return path


def play(arguments, run):
    """The verdict, its causes and the messages of a run."""
    with tempfile.TemporaryDirectory() as folder:
        emulator = subprocess.Popen(
            [arguments.emulator] + run.emulator(folder), cwd=folder, stdout=subprocess.PIPE, text=True
        )
        try:
            port = json.loads(emulator.stdout.readline())["port"]
            call = [arguments.palpate, "run", SCENARIO, "--device", run.link(port), "--arm"]
            call += ["--clock", "virtual", "--surface=" + run.surface, "--set", "output.figures=false"]
            for key, value in run.settings.items():
                call += ["--set", f"{key}={value}"]
            ended = subprocess.run(call, cwd=folder, stderr=subprocess.PIPE, text=True, timeout=60)
        finally:
            emulator.send_signal(signal.SIGTERM)
            emulator.communicate()
        found = {}
        path = os.path.join(folder, "out/device_stand/findings.csv")
        if os.path.exists(path):
            with open(path) as file:
                found = next(csv.DictReader(file))
    return found.get("measured_verdict", ""), found.get("measured_causes", ""), ended.stderr


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate", type=os.path.abspath)
    parser.add_argument("emulator", type=os.path.abspath)
    parser.add_argument("runs", type=int, nargs="?", default=200)
    parser.add_argument("--show", action="store_true", help="the last message of runs that are not named")
    arguments = parser.parse_args()
    named = collections.Counter()
    played = collections.Counter()
    agreed = 0
    for number in range(arguments.runs):
        run = Run(number, KINDS[number % len(KINDS)])
        verdict, causes, said = play(arguments, run)
        good = causes == run.said and (verdict == "differs" or run.kind == "noise")
        good = good or (" " in run.said and run.said in said and verdict != "agrees")
        played[run.kind] += 1
        named[run.kind] += good
        if not good and arguments.show:
            print(number, run.device, run.kind, repr(run.faults or run.surface), said.strip().splitlines()[-1])
        verdict, causes, said = play(arguments, Run(number, "none"))
        agreed += verdict == "agrees" and causes == ""
        if verdict != "agrees" and arguments.show:
            print(number, "without fault", said.strip().splitlines()[-1])
    print("| fault | runs | named, and nothing else |")
    print("|---|---|---|")
    for kind in KINDS:
        print(f"| {kind} | {played[kind]} | {named[kind]} |")
    print(f"| all | {sum(played.values())} | {sum(named.values())} |")
    print(f"| none | {arguments.runs} | {agreed} agree |")


if __name__ == "__main__":
    main()
