"""Cases a second of sweeps over E and nu, and the time of one run, from start to files.

    python3 tests/bench/sweep_rates.py build/measure/palpate [another program to compare with]

Plans 25 values of E with 20 of nu on the cube of scenarios/sweep_modulus_ratio.toml for every kind of
model, runs the 500 cases with one worker, and counts processor time. With a second program both take
turns, and the ratio of their times is printed.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent.parent.parent
MODELS = ["hertz", "layer", "coupled_springs", "mass_spring"]
ROUNDS = 3


def processor_time(command):
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        raise SystemExit(f"{' '.join(command)} ended with {status}")
    return usage.ru_utime + usage.ru_stime


def sweep(program, model, folder):
    """Processor time of 500 cases, s."""
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([program, "sweep", "plan", str(HERE / "scenarios/sweep_modulus_ratio.toml"),
                    "--set", f"solver.model={model}",
                    "--set", 'sweep.tissue.young_modulus={from="1 kPa",to="100 kPa",points=25,scale="log"}',
                    "--set", "sweep.tissue.poisson_ratio={from=0.1,to=0.49,points=20}",
                    "--out", str(folder), "--yes"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    planned = next(folder.glob("*_sweep"))
    return processor_time([program, "sweep", "run", str(planned), "--jobs", "1"])


def quickstart(program, folder):
    return processor_time([program, "run", str(HERE / "scenarios/quickstart.toml"), "--out",
                           str(folder), "--force"])


def main():
    programs = sys.argv[1:3]
    print("| what | " + " | ".join(f"{name}, s" for name in ["processor time", "of the other"][:len(programs)])
          + " | a second |" + (" ratio |" if len(programs) == 2 else ""))
    print("|---" * (len(programs) + 2 + (len(programs) == 2)) + "|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "sweep"
        for what, work, count in [(f"500 cases by {model}", lambda p, m=model: sweep(p, m, folder), 500)
                                  for model in MODELS] + [
                                      ("quickstart, start to files",
                                       lambda p: quickstart(p, pathlib.Path(name) / "out"), 1)]:
            least = [min(times) for times in
                     zip(*[[work(program) for program in programs] for _ in range(ROUNDS)])]
            line = f"| {what} | " + " | ".join(f"{seconds:.3f}" for seconds in least)
            line += f" | {count / least[0]:.0f} |"
            if len(least) == 2:
                line += f" {least[0] / least[1]:.2f} |"
            print(line, flush=True)


main()
