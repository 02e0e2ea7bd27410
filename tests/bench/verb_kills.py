#!/usr/bin/env python3
"""Ends every verb at random moments, and looks at what is left.

    tests/bench/verb_kills.py build/release/palpate [KILLS] [--calls "run,sweep merge"] [--seed 1]

No test: it takes half an hour with 100 KILLS a call. Half of the kills are SIGTERM, which has to end the call within a
second (longer where more processes run than there are processors) and 0.3 s of processor time, and half SIGKILL. Where a verb writes, an earlier result is there and `--force` is given. A finding is a longer
wait, another exit code, a child process that goes on, a file that is neither the old one nor the new one, the same call
afterwards that neither works nor says that the result is there, and another result of it than without a kill, temporary
files included. Findings are printed, and the exit code is 1.
"""

import argparse
import hashlib
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from press import PRESS, curve, meshed  # noqa: E402

PLAIN = PRESS + "figures = false\n"
SHORT = PLAIN.replace("0.4 mm", "0.1 mm")


def swept(points, press=PLAIN, first="10 kPa"):
    return press + f'[sweep]\n"tissue.young_modulus" = {{ from = "{first}", to = "20 kPa", points = {points} }}\n'


FILES = {
    "s.toml": PLAIN,
    "other.toml": PLAIN.replace("20 kPa", "30 kPa"),
    "modes.toml": meshed([4, 4, 3], SHORT) + 'integrator = "modal"\nmodes = 225\n',
    "lowest.toml": meshed([8, 8, 6], SHORT) + 'integrator = "modal"\nmodes = 30\n',
    "body.toml": SHORT.replace(
        "[finger]", 'shape = { kind = "ellipsoid", size = ["60 mm", "50 mm", "40 mm"] }\nmesh = { kind = "tetgen", nodes = 300 }\n[finger]')
    + '[solver]\nmodel = "mass_spring"\n',
    "solid.toml": SHORT + '[solver]\nmodel = "solid"\ntolerance = 0.3\n',
    "figures.toml": swept(4, PRESS),
    "sweep.toml": swept(60),
    "larger.toml": swept(119),
    # The stiffest of these diverge.
    "failing.toml": '[tissue]\nviscosity = "none"\nmesh = { kind = "mirrored", cells = [2, 2, 2] }\n'
    '[solver]\nmodel = "mass_spring"\nintegrator = "central_difference"\nsubsteps = 4\nallow_unstable = true\n'
    '[output]\ninterval = "12 ms"\n[[step]]\nkind = "creep"\nload_time = "0.6 s"\nrecovery_time = "60 ms"\n'
    '[sweep]\n"tissue.young_modulus" = ["8 kPa", "13 kPa", "30 kPa", "31 kPa", "32 kPa"]\n',
    "maps.toml": meshed([2, 2, 2], SHORT),
    "many.toml": swept(200),
    "coupled.toml": swept(3, meshed([16, 16, 12], SHORT).replace('"mass_spring"', '"coupled_springs"\nvolume = "tetrahedron"')),
    "chart.toml": SHORT.replace("[tissue]\n", '[tissue]\nshape = { kind = "half_space" }\n'),
    "data.csv": curve(200, 0.01),
    "prologue.sh": "true\n",
    "golden/g/scenario.toml": PLAIN,
}
PLAN = ["sweep", "plan", "sweep.toml"]
RUN = ["sweep", "run", "out/sweep_sweep", "--done", "d"]
DONE = ["run", "s.toml"]
MERGE = ["sweep", "merge", "out/sweep_sweep", "--force"]
FIT = ["fit", "data.csv", "--x", "travel_mm", "--y", "force_N", "--model", "hertz", "--radius", "5 mm", "--poisson", "0.45"]
IDENTIFY = ["identify", "data.csv", "s.toml", "--x", "travel_mm", "--y", "force_N", "--unknown", "tissue.young_modulus=2 kPa..60 kPa"]
# A change of an input between the earlier result and the call, whose result is another one then.
CHANGE = {name: PLAIN.replace("20 kPa", "21 kPa") for name in ("s.toml", "golden/g/scenario.toml")}
COMMIT = "git init -q . && git add -A && git -c user.name=a -c user.email=a commit -qm a"
BASELINE = ["golden", "add", "--force", "golden/g/scenario.toml", "--reason", "a test"]


def replacing(call):
    """The call, on top of its earlier result with another input."""
    return [call, CHANGE], call + ["--force"]


# What is done before (calls, lines of a shell, and files that are written), and the call that is killed.
CALLS = {
    "run": replacing(DONE),
    "run, all modes": ([], ["run", "modes.toml"]),
    "run, lowest modes": ([], ["run", "lowest.toml"]),
    "run, TetGen": ([], ["run", "body.toml"]),
    "run, solid": ([], ["run", "solid.toml"]),
    "run, figures": ([], ["run", "figures.toml"]),
    "run, 200 maps": ([], ["run", "many.toml"]),
    "run, coupled springs": ([], ["run", "coupled.toml"]),
    "run --device": ([DONE], ["run", "s.toml", "--device", "replay:out/s/force_indentation.csv", "--out", "l"]),
    "explain": ([], ["explain", "s.toml"]),
    "explain --json": ([], ["explain", "sweep.toml", "--json"]),
    "fit": ([FIT + ["--out", "f"]], FIT + ["--out", "f", "--force"]),
    "data": ([], ["data", "data.csv"]),
    "compare": ([DONE, ["compare", "out/s", "out/s", "--report", "c.html", "--junit", "c.xml"], CHANGE, DONE + ["--out", "n"]],
                ["compare", "out/s", "n/s", "--report", "c.html", "--junit", "c.xml"]),
    "open": ([DONE, ["open", "out"], ["run", "other.toml"]], ["open", "out"]),
    "golden add": replacing(["golden", "add", "s.toml"]),
    "golden check": ([["golden", "add", "s.toml"]], ["golden", "check", "s.toml"]),
    "golden list": ([["golden", "add", "s.toml"]], ["golden", "list"]),
    "golden add --reason": ([COMMIT, BASELINE, CHANGE, COMMIT], BASELINE),
    "convert": ([], ["convert", "body.toml", "--out", "m.node", "--force"]),
    "reference": ([["reference", "s.toml", "--out", "r"], CHANGE], ["reference", "s.toml", "--out", "r", "--force"]),
    "chart --frames": ([], ["chart", "maps.toml", "--frames", "20", "--report", "b.html"]),
    "chart": ([["chart", "chart.toml", "--repeats", "1"]], ["chart", "chart.toml", "--repeats", "1", "--force"]),
    "stability": ([["stability", "maps.toml"]], ["stability", "maps.toml", "--force"]),
    "sweep plan": ([], PLAN),
    "sweep plan --reuse": ([PLAN, RUN], ["sweep", "plan", "larger.toml", "--reuse", "out/sweep_sweep"]),
    "sweep run": ([PLAN], RUN),
    "sweep status": ([PLAN, RUN], ["sweep", "status", "out/sweep_sweep"]),
    "sweep retry": ([["sweep", "plan", "failing.toml"], ["sweep", "run", "out/failing_sweep", "--accept-failed"]],
                    ["sweep", "retry", "out/failing_sweep"]),
    "sweep merge": ([PLAN, ["sweep", "run", "out/sweep_sweep", "--shard", "1/2"], MERGE, RUN], MERGE),
    "sweep parts": ([PLAN], ["sweep", "parts", "out/sweep_sweep", "--of", "4", "--json"]),
    "sweep slurm": ([PLAN, ["sweep", "slurm", "out/sweep_sweep"]],
                    ["sweep", "slurm", "out/sweep_sweep", "--chunk", "3", "--prologue", "prologue.sh"]),
    "identify": ([IDENTIFY, CHANGE], IDENTIFY + ["--force"]),
    "convert results": ([DONE, ["convert", "out/s", "--to", "csv-si", "--out", "e"], CHANGE, DONE + ["--force"]],
               ["convert", "out/s", "--to", "csv-si", "--out", "e", "--force"]),
    "device probe": ([DONE], ["device", "probe", "replay:out/s/force_indentation.csv"]),
    "device monitor": ([DONE], ["device", "monitor", "replay:out/s/force_indentation.csv"]),
    "new": ([["new", "press", "n.toml"]], ["new", "creep", "n.toml", "--force"]),
    "open results": ([DONE], ["open", "out/s"]),
    "manual": ([], ["manual"]),
    "schema": ([], ["schema"]),
    "completion": ([], ["completion", "bash"]),
    "complete": ([], ["complete", "run", "s"]),
    "help": ([], ["help", "sweep"]),
}
MOST = 1.0  # s, from SIGTERM to the end
MOST_WORK = 0.3  # s of processor time, without that of children
FINISHED = re.compile("--force|already|finished")
TEMPORARY = re.compile(r"\.partial[-/]|\.palpate-part\d+$|\.part\d+$|\.old$|\.before|\.replaced$")
# Times are among what these say, and of a baseline whether the tree was clean, which it is not after a kill.
TIMES = re.compile(r"_chart/|^b\.html$|/baseline\.toml$")
# Files that say in themselves whether they are whole.
LINES = re.compile(r"\.rows$|\.lock$|_measurements/")


def worked(process):
    """The processor time of a process, which may be a zombie, s."""
    with open(f"/proc/{process}/stat") as file:
        state = file.read().rsplit(")", 1)[1].split()
    return (int(state[11]) + int(state[12])) / os.sysconf("SC_CLK_TCK")


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


def files_in(folder):
    """The hashes of all files, by name; numbers of processes in names are excluded."""
    found = {}
    for above, folders, names in os.walk(folder):
        folders[:] = [one for one in folders if one != ".git"]
        for name in names:
            path = os.path.join(above, name)
            with open(path, "rb") as file:
                found[re.sub(r"_\d+_\d+\.rows$", ".rows", os.path.relpath(path, folder))] = hashlib.sha256(file.read()).hexdigest()
    return found


def is_listed(found, root, folder):
    """Whether what the list of a result folder names is there, as listed."""
    if os.path.join(folder, "contents.sha256") not in found:
        return False
    with open(os.path.join(root, folder, "contents.sha256")) as file:
        listed = [line.split("  ", 1) for line in file.read().splitlines() if line and not line.startswith("#")]
    return all(found.get(os.path.join(folder, path)) == value for value, path in listed)


class Calls:
    """A call that is killed in copies of one folder, and what it leaves without a kill."""

    def __init__(self, program, root, before, call):
        self.program, self.root, self.call = program, root, call
        self.start_folder = os.path.join(root, "start")
        os.mkdir(self.start_folder)
        for step in [FILES] + before:
            if isinstance(step, str):
                subprocess.run(step, cwd=self.start_folder, shell=True, check=True)
                continue
            if isinstance(step, list):
                code, said = self.whole(self.start_folder, step)
                assert code in (0, 7), (step, code, said)
                continue
            for name, text in step.items():
                path = os.path.join(self.start_folder, name)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w") as file:
                    file.write(text)
        self.old = files_in(self.start_folder)
        ends = []
        for _ in range(2):
            folder = self.copy()
            begun = time.monotonic()
            self.good, self.said = self.whole(folder, call)
            self.takes = time.monotonic() - begun
            ends.append(files_in(folder))
        # A time or a name of a process differs from call to call.
        self.new = {name: value if ends[1].get(name) == value and not TIMES.search(name) else None
                    for name, value in ends[0].items()}

    def copy(self):
        folder = os.path.join(self.root, "copy")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.start_folder, folder, symlinks=True)
        return folder

    def begin(self, folder, call):
        return subprocess.Popen(
            [self.program] + call, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True, start_new_session=True,
        )

    def whole(self, folder, call):
        running = self.begin(folder, call)
        said = running.communicate()[1]
        return running.returncode, said

    def half_written(self, folder):
        found = files_in(folder)
        wrong = []
        for name, value in found.items():
            if value == self.old.get(name) or value == self.new.get(name) or TEMPORARY.search(name) or LINES.search(name):
                continue
            # An incomplete result, and one whose bytes differ from call to call, have lists of their files.
            folders = [os.path.dirname(name), os.path.dirname(os.path.dirname(name))]
            lists = [one for one in folders if os.path.join(one, "contents.sha256") in found]
            if lists and all(is_listed(found, folder, one) for one in lists) or not lists and self.new.get(name, "") is None:
                continue
            wrong.append(f"{name} is neither old nor new")
        # A result whose figures a signal ended has fewer of them, and lists those.
        wrong += [f"{name} is gone" for name in self.old if name not in found and name in self.new
                  and not is_listed(found, folder, os.path.dirname(name))]
        return wrong

    def other_end(self, folder):
        found = files_in(folder)
        # Finished cases of a killed run, and rows of a live one, stay (docs/results.md).
        kept = {name.split("/contents.sha256")[0] for name in found if ".partial-" in name and name.endswith("/contents.sha256")}
        wrong = [f"{name} is left" for name in found if name not in self.new and name not in self.old
                 and not any(name.startswith(one + "/") for one in kept)]
        wrong += [f"{name} is missing" for name in self.new if name not in found]
        # A list says which result it replaced.
        return wrong + [f"{name} is another one" for name, value in self.new.items()
                        if value and found.get(name, value) != value and not LINES.search(name) and not name.endswith("contents.sha256")]

    def killed(self, wait, how):
        """What is wrong after a kill, the times from the signal to the end, and whether there was one."""
        folder = self.copy()
        running = self.begin(folder, self.call)
        try:
            running.wait(wait)
        except subprocess.TimeoutExpired:
            pass
        sent, before = time.monotonic(), worked(running.pid) if running.returncode is None else 0.0
        running.send_signal(how)
        work = 0.0
        if running.returncode is None:
            os.waitid(os.P_PID, running.pid, os.WEXITED | os.WNOWAIT)
            work = worked(running.pid) - before
        took = time.monotonic() - sent
        said = running.communicate()[1]
        wrong = []
        # -15: in the first milliseconds, before the program listens.
        codes = {self.good, 130, 75, -15} if how == signal.SIGTERM else {self.good, -9}
        if running.returncode not in codes:
            wrong.append(f"exit code {running.returncode}: {said[-300:]}")
        most = MOST * max(1.0, os.getloadavg()[0] / os.cpu_count())
        if how == signal.SIGTERM and (took > most or work > MOST_WORK):
            wrong.append(f"{took:.1f} s until the end, {work:.2f} s of them of processor time")
        until = time.monotonic() + most
        while left := processes_of(running.pid):
            if time.monotonic() > until:
                wrong.append(f"{len(left)} children go on")
                for one in left:
                    os.kill(int(one), signal.SIGKILL)
                break
            time.sleep(0.01)
        wrong += self.half_written(folder)
        ended = running.returncode != self.good
        code, said = self.whole(folder, self.call) if ended else (self.good, "")
        if code != self.good and not (code == 2 and FINISHED.search(said)):
            wrong.append(f"again: exit code {code}: {said[-300:]}")
        # What was measured before a live run was interrupted is a result, which is not replaced.
        return wrong + (self.other_end(folder) if code == self.good else []), took, work, ended


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate", type=os.path.abspath)
    parser.add_argument("kills", type=int, nargs="?", default=100)
    parser.add_argument("--calls", default="", help="names of calls, with commas and no blanks between them")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    os.environ["BROWSER"] = "true"  # of `open`
    os.environ.pop("CI", None)  # where no result is replaced
    chance = random.Random(arguments.seed)
    asked = re.split(",(?! )", arguments.calls) if arguments.calls else list(CALLS)
    findings = 0
    print("| call | takes, s | kills | of which before the end | longest end after SIGTERM, s | most processor time of it, s | findings |")
    print("|---|---|---|---|---|---|---|")
    for name in asked:
        with tempfile.TemporaryDirectory() as root:
            calls = Calls(arguments.palpate, root, *CALLS[name])
            if calls.good not in (0, 3, 4, 7):
                print(f"{name}: exit code {calls.good} without a kill: {calls.said[-400:]}")
                findings += 1
                continue
            longest, most, early, wrong = 0.0, 0.0, 0, []
            for kill in range(arguments.kills):
                how = signal.SIGTERM if kill % 2 == 0 else signal.SIGKILL
                moment = chance.uniform(0.0, calls.takes)
                found, took, work, ended = calls.killed(moment, how)
                if how == signal.SIGTERM:
                    longest, most = max(longest, took), max(most, work)
                early += ended
                wrong += [f"{name}, {how.name} after {moment:.2f} s: {one}" for one in found]
        print(f"| `{name}` | {calls.takes:.2f} | {arguments.kills} | {early} | {longest:.2f} | {most:.2f} | {len(wrong)} |", flush=True)
        print("\n".join(wrong[:8]), end="\n" if wrong else "", flush=True)
        findings += len(wrong)
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
