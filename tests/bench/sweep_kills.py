#!/usr/bin/env python3
"""Kills a small sweep at random moments, many times, and compares what is merged at the end.

    tests/bench/sweep_kills.py build/release/palpate [KILLS] [SEED]

No test: it takes minutes. A run of the sweep is killed (SIGKILL) after a random time; where it ends
by itself first, the plan begins afresh. Every plan that gets its cases together is merged and
compared, byte by byte, with one that nobody disturbed.
"""

import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

CASES = 48
SCENARIO = (
    '[tissue]\nmesh = { kind = "kuhn", cells = [3, 4, 6] }\n'
    '[solver]\nmodel = "mass_spring"\n'
    '[[step]]\nkind = "indent"\nto = "0.005 mm"\nrate = "0.02 mm/s"\n'
    '[output]\ninterval = "10 ms"\nfits = false\npressure_maps = false\n'
    '[sweep]\n"step.1.to" = ['
    + ", ".join(f'"{0.01 + i * 1e-4:.4f} mm"' for i in range(CASES))
    + "]\n"
)


def call(program, folder, *words):
    return subprocess.run([program, "sweep", *words], cwd=folder, capture_output=True, text=True)


def merged(program, folder):
    ended = call(program, folder, "merge", "out/s_sweep")
    assert ended.returncode == 0, ended.stderr
    with open(os.path.join(folder, "out/s_sweep/merged/results.csv"), "rb") as file:
        return file.read()


def rows(folder):
    results = os.path.join(folder, "out/s_sweep/results")
    whole, torn = 0, 0
    for name in os.listdir(results) if os.path.isdir(results) else []:
        with open(os.path.join(results, name), "rb") as file:
            text = file.read()
        whole += max(0, text.count(b"\n") - 1)
        torn += 1 if text and not text.endswith(b"\n") else 0
    return whole, torn


def main():
    program = os.path.abspath(sys.argv[1])
    kills = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    chance = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    folder = tempfile.mkdtemp(prefix="palpate-kills-")
    with open(os.path.join(folder, "s.toml"), "w") as file:
        file.write(SCENARIO)
    ended = call(program, folder, "plan", "s.toml")
    assert ended.returncode == 0, ended.stderr
    start = time.monotonic()
    assert call(program, folder, "run", "out/s_sweep").returncode == 0
    undisturbed = time.monotonic() - start
    whole = merged(program, folder)
    count = {"kills": 0, "in time": 0, "plans": 0, "rows lost": 0, "rows twice": 0, "torn lines": 0}

    def finish():
        assert call(program, folder, "run", "out/s_sweep").returncode == 0
        got, torn = rows(folder)
        count["plans"] += 1
        count["rows twice"] += got - CASES
        count["torn lines"] += torn
        assert merged(program, folder) == whole, "the merged table differs"

    def afresh():
        for name in ("results", "merged", "locks"):
            shutil.rmtree(os.path.join(folder, "out/s_sweep", name), ignore_errors=True)

    afresh()
    while count["kills"] < kills:
        before, _ = rows(folder)
        run = subprocess.Popen([program, "sweep", "run", "out/s_sweep"], cwd=folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0.0, 0.5 * undisturbed))
        run.send_signal(signal.SIGKILL)
        in_time = run.wait() == -signal.SIGKILL
        count["kills"] += 1
        count["in time"] += 1 if in_time else 0
        after, _ = rows(folder)
        count["rows lost"] += max(0, before - after)
        if not in_time or after >= CASES:
            finish()
            afresh()
    finish()
    shutil.rmtree(folder)
    print(f"{CASES} cases, {undisturbed:.2f} s undisturbed; every merged table was the same bytes")
    for name, number in count.items():
        print(f"{name:12} {number}")


if __name__ == "__main__":
    main()
