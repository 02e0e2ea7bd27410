#!/usr/bin/env python3
"""How often a live run names the fault that it has, and how often one without fault agrees.

    tests/bench/verdicts.py build/dev/palpate build/dev/palpate-emulator [RUNS] [--seed 1] [--show]

RUNS emulated runs (200 unless given) have one fault each and as many have none, on the motorised stand and on
a sketch that prints time, force and travel. The seed draws the tissue's modulus and the finger's radius, the gauge's
noise, the sketch's rate, and the size and time of the fault: sizes are fractions of the model's largest force. A fault
is named if `measured_causes` is that cause and no other, or if the run ends by its link with a sentence that says it.

A quarter as many runs have two faults at once, and as many a tissue that relaxes otherwise. None of these has a single
cause, and a verdict that is sure of a cause that the run does not have is wrong.
"""

import argparse
import collections
import csv
import itertools
import json
import os
import random
import signal
import subprocess
import tempfile

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENARIO = os.path.join(PROJECT, "scenarios", "device_stand.toml")
HAND = os.path.join(PROJECT, "scenarios", "emulator", "gauge_hx711.toml")
SKETCH = os.path.join(PROJECT, "scenarios", "gauges", "hx711.toml")
PEAK = 222.0  # mN, of the scenario as it is
TOUCHED = 1.0  # s of both emulators: the press, the hold and the way back take a second each


def fault(kind, at, **more):
    table = {"kind": kind, "at": f"{at:.3f} s", **more}
    return "[[fault]]\n" + "".join(f'{key} = "{value}"\n' for key, value in table.items())


class Run:
    """One session: files of the emulator, options of palpate, and what it should say."""

    def __init__(self, seed, number, kind):
        chance = random.Random(f"{seed} {number} {kind}")
        self.seed, self.kind = chance.randrange(1, 10**6), kind
        self.device = chance.choice(["stand", "sketch"])
        self.surface, self.faults = "-2 mm", ""
        self.relaxation, self.instantaneous = 0.5, 2.5  # s, and E0 over Einf
        self.modulus, self.radius = chance.uniform(6, 30), chance.uniform(4, 8)  # kPa, mm
        peak = PEAK * self.modulus / 12 * (self.radius / 5) ** 0.5
        # A reading is the mean of 8 samples.
        self.noise = peak * chance.uniform(0.001, 0.01) * 8 ** 0.5
        self.rate = chance.choice([8, 10, 12.5, 20, 40, 80])  # of the sketch, 1/s
        self.settings = {"tissue.young_modulus": f"{self.modulus:.3f} kPa", "finger.radius": f"{self.radius:.3f} mm"}
        self.travel = 4.0  # mm, deepest of the hand
        self.chance = chance
        for one in kind.split(" and "):
            self.add(one, peak)

    def add(self, kind, peak):
        chance, share = self.chance, self.chance.uniform
        self.said = kind  # or a part of the sentence of a run that the link ends
        sign = chance.choice([-1, 1])
        if kind == "tare":
            self.said = "wrong_tare"
            self.faults += fault("spike", 0, value=f"{sign * share(0.08, 1.0) * peak:.2f} mN")
        elif kind == "sign":
            self.said = "wrong_sign"
            self.faults = fault("sign_flip", 0)
        elif kind == "surface":
            self.said = "wrong_surface"
            self.surface = f"{-2 + sign * share(0.2, 0.6):.3f} mm"
            self.travel = 4.6  # the hand reaches the travel that is asked of it
        elif kind == "stiffness":
            self.said = "wrong_stiffness"
            self.settings["tissue.young_modulus"] = (
                f"{self.modulus * chance.choice([share(0.4, 0.82), share(1.22, 2.5)]):.3f} kPa")
        elif kind == "no specimen":
            self.said = "no_specimen"
        elif kind == "drift":
            self.faults += fault("drift", 0, value=f"{sign * share(0.07, 0.5) * peak:.2f} mN")
        elif kind == "friction":
            self.faults += fault("friction", 0, value=f"{share(0.1, 0.6) * peak:.2f} mN")
        elif kind == "lag":
            # 140 ms are the longest that the emulator's gauge can be late.
            self.faults += fault("lag", 0, value=f"{share(100, 140):.0f} ms")
        elif kind == "lost force":
            self.said = "lost_force"
            self.faults = fault("lost_force", TOUCHED + share(0.4, 1.7))
        elif kind == "outlier":
            self.said = "outliers"
            period = 0.02 if self.device == "stand" else 1 / self.rate
            # A reading beyond the stand's ceiling of 5 N would end the run.
            size = sign * min(share(0.3, 20) * peak, 4000.0)
            self.faults = fault("spike", TOUCHED + share(0.2, 1.8), value=f"{size:.2f} mN", duration=f"{period:.4f} s")
        elif kind == "noise":
            self.noise = share(0.035, 0.2) * peak * 8 ** 0.5
        elif kind == "overload":
            self.said = "the gauge is overloaded"
            self.faults = fault("overload", TOUCHED + share(0.5, 1.5))
        elif kind == "short press":
            self.said = "short_press"
            self.travel = 2 + share(1.0, 1.8)
            if self.device == "stand":
                self.said = "the stand stopped on its way"
                self.faults = fault("limit_switch", TOUCHED + share(0.1, 0.8))
        elif kind == "relaxation":
            self.relaxation = chance.choice([share(0.05, 0.25), share(1, 5)])
            self.instantaneous = share(1.5, 4)
        elif kind == "clock jump":
            self.device, self.said = "sketch", "the device's own time jumped ahead"
            self.faults = fault("clock_jump", TOUCHED + share(0.2, 2.5), value=f"{share(2, 3600):.1f} s")

    def emulator(self, folder):
        tissue = "none" if self.kind == "no specimen" else write(folder, "tissue.toml", (
            f'E0 = "{self.instantaneous * self.modulus:.4f} kPa"\nEinf = "{self.modulus:.4f} kPa"\n'
            f'tau = "{self.relaxation:.4f} s"\nnu = 0.45\n'
            f'R = "{self.radius:.3f} mm"\nsurface = "-2 mm"\n'))
        words = ["--clock", "virtual", "--seed", str(self.seed), "--tissue", tissue]
        if self.faults:
            words += ["--fault", write(folder, "faults.toml", self.faults)]
        gauge = f'noise = "{self.noise:.3f} mN"\n'
        if self.device == "stand":
            return ["mark10"] + words + ["--stand", write(folder, "stand.toml", "[gauge]\n" + gauge)]
        with open(HAND) as file:
            hand = file.read().replace('"4 mm"', f'"{self.travel:.2f} mm"').replace('noise    = "0.2 mN"\n', gauge)
        hand = hand.replace("rate     = 10\n", f"rate = {self.rate}\n")
        with open(SKETCH) as file:
            sketch = file.read().replace("rate        = 10\n", f"rate = {self.rate}\n")
        if self.kind == "noise":
            # A tare by one reading of such noise would be a second fault.
            sketch = sketch.replace('start       = "t"', 'start = "x"')
        self.sketch = write(folder, "sketch.toml", sketch)
        return ["gauge", "--baud", "57600", "--gauge", write(folder, "hand.toml", hand)] + words

    def link(self, port):
        return f"mark10:{port}" if self.device == "stand" else f"serial:{port},{self.sketch}"


KINDS = ["tare", "sign", "surface", "stiffness", "no specimen", "drift", "friction", "lag", "lost force",
         "outlier", "noise", "overload", "short press", "clock jump"]


SINGLE = {"tare": "wrong_tare", "surface": "wrong_surface", "stiffness": "wrong_stiffness", "drift": "drift",
          "friction": "friction", "lag": "lag"}  # what may be wrong beside another fault
PAIRS = [f"{one} and {other}" for one, other in itertools.combinations(SINGLE, 2)]


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
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--show", action="store_true", help="the last message of runs that are not named")
    arguments = parser.parse_args()
    named = collections.Counter()
    played = collections.Counter()
    agreed = 0
    for number in range(arguments.runs):
        run = Run(arguments.seed, number, KINDS[number % len(KINDS)])
        verdict, causes, said = play(arguments, run)
        good = causes == run.said and (verdict == "differs" or run.kind == "noise")
        good = good or (" " in run.said and run.said in said and verdict != "agrees")
        played[run.kind] += 1
        named[run.kind] += good
        if not good and arguments.show:
            print(number, run.device, run.kind, repr(run.faults or run.surface), said.strip().splitlines()[-1])
        verdict, causes, said = play(arguments, Run(arguments.seed, number, "none"))
        agreed += verdict == "agrees" and causes == ""
        if verdict != "agrees" and arguments.show:
            print(number, "without fault", said.strip().splitlines()[-1])
    several = {"two faults": collections.Counter(), "another relaxation": collections.Counter()}
    for number in range(arguments.runs // 2):
        kind = PAIRS[number // 2 % len(PAIRS)] if number % 2 == 0 else "relaxation"
        run = Run(arguments.seed, number, kind)
        verdict, causes, said = play(arguments, run)
        # A tissue that relaxes otherwise has another stiffness.
        true = {SINGLE.get(one, "wrong_stiffness") for one in kind.split(" and ")}
        if verdict == "agrees":
            end = "agrees"
        elif causes.endswith(("unexplained", "unsure")):
            end = "not sure"
        else:
            end = "true" if set(causes.split()) <= true else "wrong"
        several["another relaxation" if kind == "relaxation" else "two faults"][end] += 1
        if end == "wrong" and arguments.show:
            print(number, run.device, kind, repr(run.faults or run.surface), said.strip().splitlines()[-1])
    print("| fault | runs | named, and nothing else |")
    print("|---|---|---|")
    for kind in KINDS:
        print(f"| {kind} | {played[kind]} | {named[kind]} |")
    print(f"| all | {sum(played.values())} | {sum(named.values())} |")
    print(f"| none | {arguments.runs} | {agreed} agree |")
    print("\n| fault | not sure | sure of causes of the run | agrees | sure of another cause |\n|---|---|---|---|---|")
    for kind, ends in several.items():
        print(f"| {kind} | {ends['not sure']} | {ends['true']} | {ends['agrees']} | {ends['wrong']} |")


if __name__ == "__main__":
    main()
