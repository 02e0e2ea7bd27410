#!/usr/bin/env python3
"""Runs palpate with mutated command lines and input files.

    command_lines.py PROGRAM [--count 200] [--seed 1] [--memory GIB]

Every verb is called. A finding is a signal, an exit code that `palpate --help` does not list or that
is 1, an error without a sentence, a text of a library or a sanitizer, or a call that goes on for
20 s and then ignores Ctrl-C for 20 s more. Each is printed with its call and files, and the exit code is 1.
"""
import argparse
import collections
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

GOOD = {0, 2, 3, 4, 5, 6, 7, 8, 75, 130}
# Texts of libraries, of sanitizers and of the language.
FOREIGN = [b"Sanitizer", b"runtime error:", b"terminate called", b"what():", b"std::", b"basic_string",
           b"vector::", b"json.exception", b"Assertion", b"internal error", b"bad_"]
PATIENCE = 20.0  # s

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from press import PRESS, curve, meshed  # noqa: E402

SCENARIO = PRESS + "figures = false\n"
FILES = {
    "s.toml": SCENARIO,
    "mesh.toml": meshed([2, 2, 2], SCENARIO),
    "half.toml": SCENARIO.replace("[tissue]\n", '[tissue]\nshape = { kind = "half_space" }\n'),
    "sweep.toml": SCENARIO + '[sweep]\n"tissue.young_modulus" = ["10 kPa", "20 kPa"]\n',
    "stl.toml": SCENARIO.replace(
        "[finger]", 'shape = { kind = "file", file = "b.stl", unit = "mm" }\n[finger]'),
    "b.stl": "solid s\n" + "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join("vertex %d %d %d\n" % v for v in f)
        + "endloop\nendfacet\n"
        for f in (((0, 0, 0), (0, 20, 0), (20, 0, 0)), ((0, 0, 0), (20, 0, 0), (0, 0, 20)),
                  ((0, 0, 0), (0, 0, 20), (0, 20, 0)), ((20, 0, 0), (0, 20, 0), (0, 0, 20)))),
    "data.csv": curve(12, 0.05),
    "other.csv": "time_s,travel_mm,force_N\n0,0,0\n0.1,0.1,0.01\n",
    "tolerances.toml": "[default]\nrel = 1e-3\n[column.force_N]\nabs = 0.01\nreason = \"noise\"\n",
}
CALLS = [line.split() for line in """
run s.toml --out o
run mesh.toml --set step.1.to=0.1_mm --jobs 1 --out o
run s.toml sweep.toml --out o --force --quiet
run stl.toml --out o
run s.toml --device replay:data.csv --out l
run s.toml --dry-run
explain s.toml
explain mesh.toml --json
explain sweep.toml
explain tissue.young_modulus
convert mesh.toml --out m.node
convert b.stl --unit mm --out m.off --force
data data.csv
fit data.csv --x travel_mm --y force_N --model hertz --radius 5_mm --poisson 0.5
fit data.csv other.csv --x 2 --y 3 --model hertz --radius 5_mm --poisson 0.5 --out f
fit data.csv --x time_s --y force_N --model prony
identify data.csv s.toml --x travel_mm --y force_N --unknown tissue.young_modulus=2_kPa..60_kPa --out o
sweep plan sweep.toml --out o
sweep plan sweep.toml --out p --reuse o/sweep_sweep --curves
sweep run o/sweep_sweep --shard 1/2 --accept-failed --done d
sweep retry o/sweep_sweep --shard 1/2 --jobs 1
sweep status o/sweep_sweep
sweep merge o/sweep_sweep --force --show peak_force_N
sweep parts o/sweep_sweep --of 3 --json
sweep slurm o/sweep_sweep --chunk 1 --time 01:00:00 --program p --prologue s.toml
compare data.csv other.csv --tolerances tolerances.toml --report c.html --junit c.xml
open o --quiet
convert o/s --to csv-si --out e --force
device probe replay:data.csv
device monitor replay:data.csv
device stop mark10:nowhere
reference half.toml --out truth
chart mesh.toml --frames 2
chart half.toml --repeats 1 --out o
stability mesh.toml --out o
open o/s
new press n.toml --force
manual commands --man
schema
completion bash
complete run s.t
help sweep plan
golden add s.toml
golden check s.toml
golden list
golden add s.toml --reason because
""".strip().splitlines()]
WORDS = ["", "-", "--", "--help", "--json", "--quiet", "--force", "--set", "--out", "/dev/null", "/",
         ".", "nan", "inf", "-1", "0", "1e308", "1e-308", "99999999999999999999", "0.3_mm", "\x1b[2J",
         "\xff", "a=b", "a.b.c=1", "step.1.to=1_N", "tissue.mesh={kind=\"kuhn\",cells=[1,2,3]}",
         "tissue.shape={kind=\"half_space\"}", "solver.model=\"coupled_springs\"", "--jobs", "1/0",
         "/dev/full", "/dev/zero", "x" * 5000, "s.toml", "data.csv", "b.stl", "o/sweep_sweep"]


def mutated_text(text, rng):
    for _ in range(rng.randint(1, 3)):
        lines = text.split("\n")
        at = rng.randrange(len(text) + 1)
        what = rng.randrange(7)
        if what == 0:
            text = text[:at] + chr(rng.randrange(256)) + text[at + 1:]
        elif what == 1:
            text = text[:at] + text[at + rng.randint(1, 8):]
        elif what == 2:
            text = text[:at] + rng.choice(WORDS) + text[at:]
        elif what == 3:
            text = text[:at]
        elif what == 4:
            i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
            lines[i] = lines[j]
            text = "\n".join(lines)
        elif what == 5:
            del lines[rng.randrange(len(lines))]
            text = "\n".join(lines)
        else:
            digits = [i for i, c in enumerate(text) if c.isdigit()]
            if digits:
                i = rng.choice(digits)
                text = text[:i] + rng.choice(["0", "9", "-", "1e9", "1e-300", ".", "00"]) + text[i + 1:]
    return text


def mutated_call(call, rng):
    call = list(call)
    for _ in range(rng.randint(0, 2)):
        at = rng.randrange(len(call))
        what = rng.randrange(5)
        if what == 0:
            call.insert(at, rng.choice(WORDS))
        elif what == 1 and len(call) > 1:
            del call[at]
        elif what == 2:
            call[at] = mutated_text(call[at], rng)
        elif what == 3:
            call[at] = rng.choice(WORDS)
        else:
            call.append(rng.choice(rng.choice(CALLS)))
    return [word.replace("_mm", " mm").replace("_kPa", " kPa").replace("_N", " N").replace("\0", "")
            for word in call]


def run(program, call, folder, memory):
    """The exit code (negative: a signal), or None for a hang; stderr; whether it was interrupted."""
    def limit():
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # a script in the background has it ignored
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if memory:
            resource.setrlimit(resource.RLIMIT_AS, (memory << 30, memory << 30))

    words = [word.encode("latin-1") for word in call]
    process = subprocess.Popen([program] + words, cwd=folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=limit)
    for interrupted in (False, True):
        try:
            return process.communicate(timeout=PATIENCE)[1], process.returncode, interrupted
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL if interrupted else signal.SIGINT)
    process.communicate()
    return b"", None, True


def why_bad(code, message, memory):
    if code is None:
        return "goes on after Ctrl-C"
    if code < 0:
        return "ended by signal %d" % -code
    if memory and b"the memory does not suffice" in message:
        return ""
    if code == 1 and b"/dev/full cannot be written: No space left on device" in message:
        return ""  # as of a disk
    if code not in GOOD:
        return "exit code %d" % code
    for text in FOREIGN:
        if text in message:
            return "says `%s`" % text.decode()
    return "no sentence" if code in (2, 4, 5, 6, 7, 8) and not message.strip() else ""


def verbs_of(program):
    """The verbs of the program's manual that have none below them."""
    text = subprocess.run([program, "manual", "commands"], check=True, capture_output=True, text=True).stdout
    verbs = [tuple(heading.split()) for heading in re.findall(r"^## palpate (.+)", text, re.M)]
    return [verb for verb in verbs if not any(other[:-1] == verb for other in verbs)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--memory", type=int, default=0, help="GiB that a call may take; 0: any")
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    rng = random.Random(options.seed)
    for verb in verbs_of(program):
        assert any(tuple(call[:len(verb)]) == verb for call in CALLS), "no call of " + " ".join(verb)
    codes = collections.Counter()
    slow = findings = 0
    start = tempfile.mkdtemp(prefix="palpate-calls-")
    for name, text in FILES.items():
        open(os.path.join(start, name), "w").write(text)
    # What some calls need is there already.
    for call in ("run s.toml --out o", "sweep plan sweep.toml --out o", "sweep run o/sweep_sweep"):
        subprocess.run([program] + call.split(), cwd=start, check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
    for number in range(options.count):
        folder = os.path.join(start, "call")
        shutil.copytree(start, folder, ignore=shutil.ignore_patterns("call"))
        call = mutated_call(rng.choice(CALLS), rng)
        changed = rng.choice(sorted(FILES)) if rng.random() < 0.6 else ""
        if changed:
            with open(os.path.join(folder, changed), "w", encoding="latin-1", newline="") as file:
                file.write(mutated_text(FILES[changed], rng))
        message, code, interrupted = run(program, call, folder, options.memory)
        codes[code] += 1
        slow += interrupted
        bad = why_bad(code, message, options.memory)
        if bad:
            findings += 1
            kept = tempfile.mkdtemp(prefix="palpate-finding-")
            shutil.copytree(folder, os.path.join(kept, "files"))
            print("finding: call %d of seed %d: %s\n  %r, with %s changed, in %s\n  %s" % (
                number, options.seed, bad, call, changed or "no file", kept,
                message[-2000:].decode("latin-1")), flush=True)
        shutil.rmtree(folder)
    shutil.rmtree(start)
    print("%d calls, exit codes %s, %d took more than %g s and were interrupted, %d findings" % (
        options.count, dict(sorted(codes.items(), key=str)), slow, PATIENCE, findings))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
