#!/usr/bin/env python3
"""Kills an armed run on the emulated stand, its guard process, or both, again and again.

    tests/bench/stand_kills.py build/dev/palpate build/dev/palpate-emulator [--kills 300] [--seed 1]

Each run feels for the surface at 0.5 mm/s. At a random moment one of the two gets SIGKILL, SIGSTOP,
SIGTSTP or another signal, and the other one SIGKILL a random time later. The emulator's log says how
long and how far the stand moved after the first signal. Prints one line for each kind of blow, and
ends with 1 if a stand moved for longer than 0.5 s or further than 0.5 mm.
"""
import argparse
import csv
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SETTLE = 1.5  # s of the log that are looked at after the last signal
SIGNALS = [signal.SIGKILL] * 6 + [signal.SIGSTOP, signal.SIGTSTP, signal.SIGUSR1, signal.SIGQUIT,
                                  signal.SIGALRM, signal.SIGXCPU, signal.SIGHUP, signal.SIGINT]


def states(log):
    """(time s, position m, velocity m/s) of every row of the log that is complete."""
    with open(log, newline="") as file:
        rows = [row for row in csv.reader(file) if len(row) == 8][1:]
    return [(float(row[0]), float(row[3]), float(row[5])) for row in rows]


def heed_signals():
    """A shell starts programs in the background with some signals ignored."""
    for one in set(SIGNALS) - {signal.SIGKILL, signal.SIGSTOP}:
        signal.signal(one, signal.SIG_DFL)


def child_of(process):
    with open(f"/proc/{process}/task/{process}/children") as file:
        return int(file.read().split()[0])


def blow(arguments, folder, choose):
    tissue, log = os.path.join(folder, "tissue.toml"), os.path.join(folder, "log.csv")
    with open(tissue, "w") as file:
        file.write('surface = "-30 mm"\n')
    began = time.monotonic()
    stand = subprocess.Popen([arguments.emulator, "mark10", "--tissue", tissue, "--log", log],
                             stdout=subprocess.PIPE, text=True)
    port = json.loads(stand.stdout.readline())["port"]
    run = subprocess.Popen([arguments.palpate, "run", ROOT + "/scenarios/device_stand.toml", "--device",
                            "mark10:" + port, "--arm", "--set", "output.figures=false"],
                           cwd=folder, stderr=subprocess.DEVNULL, preexec_fn=heed_signals)
    try:
        while not any(velocity < 0.0 for _, _, velocity in states(log)):
            if run.poll() is not None or time.monotonic() > began + 30.0:
                return None
            time.sleep(0.02)
        guard = child_of(run.pid)
        time.sleep(choose.uniform(0.0, 2.5))
        first = choose.choice(["run", "guard"])
        with_signal = choose.choice(SIGNALS) if first == "run" else signal.SIGKILL
        pause = choose.choice([None, 0.0, 0.001, 0.005, 0.02, 0.05, 0.2])
        rows = len(states(log))
        try:
            os.kill(run.pid if first == "run" else guard, with_signal)
        except ProcessLookupError:
            return None
        if pause is not None:
            time.sleep(pause)
            try:
                os.kill(guard if first == "run" else run.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(SETTLE)
        seen = states(log)
        at, place, _ = seen[rows - 1]
        moving = [row for row in seen[rows:] if row[2] != 0.0]
        lasted = moving[-1][0] - at if moving else 0.0
        kind = f"{first} by {with_signal.name}" + (", then the other" if pause is not None else "")
        return kind, pause, lasted, place - seen[-1][1]
    finally:
        for process in (run, stand):
            process.kill()
            process.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("palpate")
    parser.add_argument("emulator")
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    arguments.palpate, arguments.emulator = map(os.path.abspath, (arguments.palpate, arguments.emulator))
    choose = random.Random(arguments.seed)
    kinds, done, failed = {}, 0, 0
    while done < arguments.kills:
        with tempfile.TemporaryDirectory() as folder:
            result = blow(arguments, folder, choose)
        if result is None:
            continue  # the machine stood still for so long that the run ended before
        done += 1
        kind, pause, lasted, further = result
        count, longest, furthest = kinds.get(kind, (0, 0.0, 0.0))
        kinds[kind] = (count + 1, max(longest, lasted), max(furthest, further))
        if lasted > 0.5 or further > 0.5e-3:
            failed += 1
            print(f"{kind}, {pause} s later: moved for {lasted:.3f} s, {1e3 * further:.3f} mm", flush=True)
    for kind, (count, longest, furthest) in sorted(kinds.items()):
        print(f"{count:4d}  {kind}: at most {longest:.3f} s and {1e3 * furthest:.3f} mm")
    print(f"{done} kills, {failed} beyond 0.5 s or 0.5 mm")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
