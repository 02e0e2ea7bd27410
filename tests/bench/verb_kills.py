#!/usr/bin/env python3
"""Ends every verb at random moments, and looks at what is left.

    tests/bench/verb_kills.py build/release/palpate [KILLS] [--verbs run,mesh] [--seed 1]

No test: it takes an hour with 100 KILLS a call. Half of the kills are SIGTERM, which has to end the call within a
second, and half SIGKILL. A finding is a longer wait, another exit code, a child process that goes on, or the same
call afterwards that neither works nor says that the result is there. Findings are printed, and the exit code is 1.
"""

import argparse
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from press import PRESS, curve, meshed  # noqa: E402

FILES = {
    "s.toml": PRESS,
    "modes.toml": meshed([7, 7, 6]) + 'integrator = "modal"\nmodes = 1152\n',
    "lowest.toml": meshed([14, 14, 10]) + 'integrator = "modal"\nmodes = 150\n',
    "body.toml": PRESS.replace(
        "[finger]", 'shape = { kind = "ellipsoid", size = ["60 mm", "50 mm", "40 mm"] }\nmesh = { kind = "tetgen", nodes = 12000 }\n[finger]')
    + '[solver]\nmodel = "mass_spring"\n',
    "solid.toml": PRESS + '[solver]\nmodel = "solid"\ntolerance = 0.01\n',
    "figures.toml": PRESS + '[sweep]\n"tissue.young_modulus" = { from = "10 kPa", to = "20 kPa", points = 64 }\n',
    "sweep.toml": PRESS + '[sweep]\n"tissue.young_modulus" = { from = "10 kPa", to = "20 kPa", points = 300 }\n',
    "maps.toml": meshed([3, 3, 2]),
    "chart.toml": PRESS.replace("[tissue]\n", '[tissue]\nshape = { kind = "half_space" }\n'),
    "data.csv": curve(400, 0.01),
}
PLAN = ["sweep", "plan", "sweep.toml"]
RAN = [PLAN, ["sweep", "run", "out/sweep_sweep"]]
DONE = ["run", "s.toml"]
FIT = ["fit", "data.csv", "--x", "travel_mm", "--y", "force_N", "--model", "hertz", "--radius", "5 mm", "--poisson", "0.45"]
# What is called before, and the call that is killed.
CALLS = {
    "run": ([], ["run", "s.toml"]),
    "run, all modes": ([], ["run", "modes.toml"]),
    "run, lowest modes": ([], ["run", "lowest.toml"]),
    "run, TetGen": ([], ["run", "body.toml"]),
    "run, solid": ([], ["run", "solid.toml"]),
    "run, figures": ([], ["run", "figures.toml"]),
    "explain": ([], ["explain", "body.toml"]),
    "fit": ([], FIT + ["--out", "f"]),
    "data": ([], ["data", "data.csv"]),
    "compare": ([DONE], ["compare", "out/s", "out/s", "--report", "c.html", "--junit", "c.xml"]),
    "report": ([DONE], ["report", "out"]),
    "golden add": ([], ["golden", "add", "s.toml", "--force"]),
    "golden check": ([["golden", "add", "s.toml"]], ["golden", "check", "s.toml"]),
    "mesh": ([], ["mesh", "body.toml", "--out", "m.node", "--force"]),
    "reference": ([], ["reference", "s.toml"]),
    "bench": ([], ["bench", "maps.toml"]),
    "chart": ([], ["chart", "chart.toml", "--repeats", "1"]),
    "stability": ([], ["stability", "maps.toml"]),
    "sweep plan": ([], PLAN),
    "sweep run": ([PLAN], ["sweep", "run", "out/sweep_sweep"]),
    "sweep status": (RAN, ["sweep", "status", "out/sweep_sweep"]),
    "sweep retry": (RAN, ["sweep", "retry", "out/sweep_sweep"]),
    "sweep merge": (RAN, ["sweep", "merge", "out/sweep_sweep"]),
    "sweep parts": ([PLAN], ["sweep", "parts", "out/sweep_sweep", "--of", "4"]),
    "sweep slurm": ([PLAN], ["sweep", "slurm", "out/sweep_sweep"]),
    "identify": ([], ["identify", "data.csv", "s.toml", "--x", "travel_mm", "--y", "force_N", "--unknown", "tissue.young_modulus=2 kPa..60 kPa"]),
    "export": ([DONE], ["export", "out/s", "--to", "csv-si", "--out", "e"]),
    "device": ([DONE], ["device", "probe", "replay:out/s/force_indentation.csv"]),
    "live": ([DONE], ["run", "s.toml", "--device", "replay:out/s/force_indentation.csv", "--out", "l"]),
    "new": ([], ["new", "n.toml", "--force"]),
    "manual": ([], ["manual"]),
    "schema": ([], ["schema"]),
    "completion": ([], ["completion", "bash"]),
}
MOST = 1.0  # s, from SIGTERM to the end
FINISHED = re.compile("--force|already|holds|is finished|finished")


def processes_of(session):
    """The processes of a session, without zombies."""
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat") as file:
                state = file.read().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(state[3]) == session and state[0] != "Z":
            found.append(name)
    return found


class Calls:
    def __init__(self, program):
        self.program = program

    def start(self, folder, call):
        return subprocess.Popen(
            [self.program] + call, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True, start_new_session=True,
        )

    def whole(self, folder, call):
        running = self.start(folder, call)
        said = running.communicate()[1]
        return running.returncode, said

    def folder_for(self, folder, before):
        for name, text in FILES.items():
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        for call in before:
            code, said = self.whole(folder, call)
            assert code == 0, (call, code, said)


def killed(calls, before, call, wait, how, good):
    """What is wrong after a kill, and the time from the signal to the end."""
    with tempfile.TemporaryDirectory() as folder:
        calls.folder_for(folder, before)
        running = calls.start(folder, call)
        try:
            running.wait(wait)
        except subprocess.TimeoutExpired:
            pass
        sent = time.monotonic()
        running.send_signal(how)
        said = running.communicate()[1]
        took = time.monotonic() - sent
        wrong = []
        # -15: in the first milliseconds, before the program listens.
        codes = {good, 130, 75, -15} if how == signal.SIGTERM else {good, -9}
        if running.returncode not in codes:
            wrong.append(f"exit code {running.returncode}: {said[-300:]}")
        if how == signal.SIGTERM and took > MOST:
            wrong.append(f"{took:.1f} s until the end")
        until = time.monotonic() + MOST
        while left := processes_of(running.pid):
            if time.monotonic() > until:
                wrong.append(f"{len(left)} children go on")
                for one in left:
                    os.kill(int(one), signal.SIGKILL)
                break
            time.sleep(0.05)
        if running.returncode != good:
            code, said = calls.whole(folder, call)
            if code != good and not (code == 2 and FINISHED.search(said)):
                wrong.append(f"again: exit code {code}: {said[-300:]}")
        return wrong, took


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate", type=os.path.abspath)
    parser.add_argument("kills", type=int, nargs="?", default=100)
    parser.add_argument("--verbs", help="names of calls, with commas between them")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    calls = Calls(arguments.palpate)
    chance = random.Random(arguments.seed)
    names = [name for name in CALLS if not arguments.verbs or name.split(",")[0] in arguments.verbs.split(",")
             or name in arguments.verbs.split(";")]
    findings = 0
    print("| call | takes, s | kills | longest end after SIGTERM, s | findings |")
    print("|---|---|---|---|---|")
    for name in names:
        before, call = CALLS[name]
        with tempfile.TemporaryDirectory() as folder:
            calls.folder_for(folder, before)
            begun = time.monotonic()
            good, said = calls.whole(folder, call)
            takes = time.monotonic() - begun
        if good not in (0, 4):
            print(f"{name}: exit code {good} without a kill: {said[-400:]}")
            findings += 1
            continue
        longest, wrong = 0.0, []
        for kill in range(arguments.kills):
            how = signal.SIGTERM if kill % 2 == 0 else signal.SIGKILL
            moment = chance.uniform(0.0, takes)
            found, took = killed(calls, before, call, moment, how, good)
            if how == signal.SIGTERM:
                longest = max(longest, took)
            wrong += [f"{name}, {how.name} after {moment:.2f} s: {one}" for one in found]
        print(f"| {name} | {takes:.2f} | {arguments.kills} | {longest:.2f} | {len(wrong)} |", flush=True)
        print("\n".join(wrong[:6]), end="\n" if wrong else "", flush=True)
        findings += len(wrong)
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
