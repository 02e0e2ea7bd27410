#!/usr/bin/env python3
"""How often the intervals of `identify` contain the tissue of a stand with late readings.

    tests/bench/live_identify.py build/dev/palpate build/dev/palpate-emulator [SESSIONS] [--jobs N] [--clock real]

Every session presses the emulator's tissue with another noise. By the virtual clock each has a link of its
own: the readings are older than their replies by 0 to 8 ms, and by a random time of up to 0 to 8 ms from
reading to reading. The programme is identified as it was planned and as the stand carried it out
(as_moved.toml). By the real clock, a machine that stands still for 0.1 s ends a session by the safety rules; such
sessions are counted and repeated. The true values are those of scenarios/emulator/stand_tissue.toml.
"""

import argparse
import concurrent.futures
import csv
import json
import os
import shutil
import signal
import subprocess
import tempfile

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENARIO = os.path.join(PROJECT, "scenarios", "device_stand.toml")
TISSUE = os.path.join(PROJECT, "scenarios", "emulator", "stand_tissue.toml")
TRUTH = {
    "tissue.young_modulus": 12.0,
    "tissue.relaxation_time": 0.5,
    "tissue.instantaneous_ratio": 2.5,
}
UNKNOWNS = [
    "tissue.young_modulus=2 kPa..60 kPa",
    "tissue.relaxation_time=0.05 s..5 s",
    "tissue.instantaneous_ratio=1.1..6",
]
WITHDRAWAL = '[[step]]\nkind = "retract"\nto   = "0 mm"\nrate = "2 mm/s"\n'
LINK_LOST = 6  # exit code of a run whose link is lost
START = "step.1.time=0.1 ms..100 ms"


def live(arguments, folder, seed):
    latency = [] if arguments.clock == "real" else [
        "--latency", f"{seed % 9} ms", "--jitter", f"{seed // 9 % 9} ms",
    ]
    stand = subprocess.Popen(
        [arguments.emulator, "mark10", "--tissue", TISSUE, "--clock", arguments.clock]
        + ["--seed", str(seed)] + latency,
        cwd=folder, stdout=subprocess.PIPE, text=True,
    )
    try:
        port = json.loads(stand.stdout.readline())["port"]
        subprocess.run(
            [arguments.palpate, "--quiet", "run", SCENARIO, "--device", "mark10:" + port, "--arm"]
            + ["--clock", arguments.clock, "--surface", "-2 mm", "--set", "output.figures=false"],
            cwd=folder, check=True, stderr=subprocess.PIPE, text=True,
        )
    finally:
        stand.send_signal(signal.SIGTERM)
        stand.communicate()


def identified(arguments, folder, scenario, unknowns):
    call = [arguments.palpate, "--quiet", "identify", "out/device_stand/force_indentation.csv"]
    call += [scenario, "--x", "time_s", "--y", "measured_force_N", "--force", "--out", "found"]
    call += ["--set", "output.figures=false"]
    for unknown in unknowns:
        call += ["--unknown", unknown]
    subprocess.run(call, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    name = os.path.splitext(os.path.basename(scenario))[0] + "_identified"
    with open(os.path.join(folder, "found", name, "identified.csv")) as file:
        return {row["unknown"]: row for row in csv.DictReader(file)}


def session(arguments, seed, ended):
    with tempfile.TemporaryDirectory() as folder:
        while True:
            try:
                live(arguments, folder, seed)
                break
            except subprocess.CalledProcessError as fault:
                if fault.returncode != LINK_LOST or arguments.clock != "real":
                    raise RuntimeError(fault.stderr) from fault
                ended.append(fault.stderr)
                shutil.rmtree(os.path.join(folder, "out"), ignore_errors=True)
        # Press and hold: the emulator's tissue is exact there.
        planned = os.path.join(folder, "planned.toml")
        with open(SCENARIO) as shipped, open(planned, "w") as file:
            file.write(shipped.read().replace(WITHDRAWAL, ""))
        moved = os.path.join(folder, "out/device_stand/as_moved.toml")
        return (
            identified(arguments, folder, planned, UNKNOWNS),
            identified(arguments, folder, moved, UNKNOWNS + [START]),
        )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate", type=os.path.abspath)
    parser.add_argument("emulator", type=os.path.abspath)
    parser.add_argument("sessions", type=int, nargs="?", default=100)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--clock", default="virtual", choices=("virtual", "real"))
    arguments = parser.parse_args()
    ways = {"planned": [], "as moved": []}
    ended = []
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        seeds = range(1, arguments.sessions + 1)
        for both in pool.map(lambda seed: session(arguments, seed, ended), seeds):
            for way, found in zip(ways, both):
                ways[way].append(found)
    print("| programme | unknown | true | mean | standard deviation | contained |")
    print("|---|---|---|---|---|---|")
    for way, sessions in ways.items():
        for key, truth in TRUTH.items():
            found = [float(one[key]["estimate"]) for one in sessions if one[key]["estimate"]]
            mean = sum(found) / len(found)
            scatter = (sum((one - mean) ** 2 for one in found) / max(1, len(found) - 1)) ** 0.5
            inside = sum(
                float(one[key]["profile_low"] or "-inf") < truth < float(one[key]["profile_high"] or "inf")
                for one in sessions
                if one[key]["estimate"]
            )
            print(f"| {way} | `{key}` | {truth:g} | {mean:.4g} | {scatter:.2g} | {inside} of {len(found)} |")
    if ended:
        print(f"{len(ended)} sessions were ended by the safety rules and repeated, the first with: {ended[0].strip()}")


if __name__ == "__main__":
    main()
