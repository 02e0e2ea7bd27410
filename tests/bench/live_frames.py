#!/usr/bin/env python3
"""Runs of 1 kHz against the emulator's arm by the real clock, a minute each, and what they cost.

    tests/bench/live_frames.py build/release/palpate build/release/palpate-emulator [SECONDS [LABEL...]]

No test: jitter is the machine's. A hand of the emulator presses a model once a second, 1.5 mm deep.
Every run of the table is one row, out of its device_health.json: frames, deadlines missed, our own
compute time a frame, how late frames began, and the energy that the hand was given against what
docs/devices.md bounds it by. A machine that stands still for 0.1 s ends a run by the rules; the row
then says after how many seconds. A virtual processor that idles is taken away and comes back late:
programs of idle priority keep the machine's awake meanwhile.
"""

import csv
import json
import os
import signal
import subprocess
import sys
import tempfile

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Label, scenario, and what is set in it: the paper's cube and leg, and a cube of 19 683 nodes, by what
# docs/speed.md takes for frames.
MODAL = "solver.integrator=modal"
CENTRAL = "solver.integrator=central_difference"
FINE = 'tissue.mesh={kind="kuhn",cells=[26,26,26]}'
RUNS = [
    ("cube modal", "model_cube", [MODAL]),
    ("cube central_difference", "model_cube", [CENTRAL]),
    ("leg modal", "model_upper_leg", [MODAL]),
    ("leg central_difference", "model_upper_leg", [CENTRAL]),
    ("fine cube modal", "model_cube", [MODAL, FINE]),
]
SURFACE = 130.0  # mm
START = 140.0  # mm: 10 mm above it
SLEW = 50.0  # N/s, the rules' own


def hand_file(seconds):
    """Down for half a second and up for half a second, over and over: also while the model is made."""
    lines = [f'[hand]\nstart = ["0 mm", "-120 mm", "{START} mm"]\n']
    for second in range(seconds + 300):
        for at, height in ((0.5, SURFACE - 1.5), (1.0, SURFACE + 5.0)):
            lines.append(
                f'[[waypoint]]\nat = "{second + at + 1.0} s"\n'
                f'position = ["0 mm", "-120 mm", "{height} mm"]\n'
            )
    return "".join(lines)


def scenario_file(name, seconds):
    """The scenario with a programme that a minute does not end."""
    with open(os.path.join(PROJECT, "scenarios", name + ".toml")) as file:
        head = file.read().split("[[step]]")[0]
    return (
        head + '[[step]]\nkind = "indent"\nto = "1 mm"\nrate = "5 mm/s"\n'
        f'[[step]]\nkind = "hold"\ntime = "{seconds + 60} s"\n'
        '[output]\ninterval = "1 ms"\npressure_maps = false\nfits = false\n'
    )


def energy_bound(rows, frame):
    """E = F v (3 T + F / (2 s)) of docs/devices.md, J; v from two rows, in contact."""
    force = speed = 0.0
    for before, row in zip(rows, rows[1:]):
        force = max(force, float(row["sent_force_N"]))
        passed = float(row["time_s"]) - float(before["time_s"])
        way = float(row["measured_travel_mm"]) - float(before["measured_travel_mm"])
        if float(row["contacts"]) > 0 and passed > 0.0:
            speed = max(speed, abs(way) * 1e-3 / passed)
    return force * speed * (3.0 * frame + force / (2.0 * SLEW))


def stay_awake():
    """A program of idle priority a processor, which gives way to whatever else wants to run."""
    spin = "import os; os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))\nwhile True: pass"
    return [subprocess.Popen([sys.executable, "-c", spin]) for _ in range(os.cpu_count())]


def live(programs, folder, name, sets, seconds):
    palpate, emulator = programs
    with open(os.path.join(folder, "hand.toml"), "w") as file:
        file.write(hand_file(seconds))
    with open(os.path.join(folder, name + ".toml"), "w") as file:
        file.write(scenario_file(name, seconds))
    arm = subprocess.Popen(
        [emulator, "inverse3", "--hand", "hand.toml"],
        cwd=folder, stdout=subprocess.PIPE, text=True,
    )
    try:
        hello = json.loads(arm.stdout.readline())
        link = f"inverse3:127.0.0.1:{hello['port']}:{hello['events_port']}"
        call = [palpate, "run", name + ".toml", "--device", link]
        call += ["--arm", "--realtime", "--surface", f"{SURFACE} mm", "--seconds", str(seconds)]
        call += ["--force"] + [word for one in sets for word in ("--set", one)]
        ended = subprocess.run(call, cwd=folder, capture_output=True, text=True)
    finally:
        arm.send_signal(signal.SIGTERM)
        summary = json.loads(arm.communicate()[0].splitlines()[-1])["summary"]
    health_file = os.path.join(folder, "out", name, "device_health.json")
    # 6: the link was lost, the rows till then are there.
    if ended.returncode not in (0, 6) or not os.path.exists(health_file):
        sys.exit(ended.stderr)
    with open(health_file) as file:
        health = json.load(file)
    with open(os.path.join(folder, "out", name, "force_indentation.csv")) as file:
        rows = list(csv.DictReader(file))
    return health, rows, summary


def main():
    programs = [os.path.abspath(program) for program in sys.argv[1:3]]
    seconds = int(sys.argv[3]) if len(sys.argv) > 3 else 60
    wanted = sys.argv[4:] or [label for label, _, _ in RUNS]
    print("| model | frames | missed | compute p50, p99, p99.9 below, us | late p99 below, us "
          "| longest gap, ms | given to the hand, uJ | bound, uJ |")
    print("|---|---|---|---|---|---|---|---|")
    awake = stay_awake()
    try:
        for label, name, sets in RUNS:
            if label not in wanted:
                continue
            with tempfile.TemporaryDirectory() as folder:
                health, rows, summary = live(programs, folder, name, sets, seconds)
            if float(rows[-1]["time_s"]) < seconds - 1:
                label += f" (link lost after {float(rows[-1]['time_s']):.0f} s)"
            compute = health["compute"]
            bound = energy_bound(rows, health["longest_gap_s"])
            print(
                f"| {label} | {health['frames']} | {health['deadline_misses']} "
                f"| {1e6 * compute['p50_below_s']:.0f}, {1e6 * compute['p99_below_s']:.0f}, "
                f"{1e6 * compute['p999_below_s']:.0f} "
                f"| {1e6 * health['lateness']['p99_below_s']:.0f} "
                f"| {1e3 * health['longest_gap_s']:.1f} "
                f"| {1e6 * summary['most_work_by_device_J']:.1f} | {1e6 * bound:.1f} |",
                flush=True,
            )
    finally:
        for spinner in awake:
            spinner.kill()


if __name__ == "__main__":
    main()
