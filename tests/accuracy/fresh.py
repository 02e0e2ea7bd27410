#!/usr/bin/env python3
"""Counts how often what palpate states is true, on scenes that nobody chose: a table of docs/accuracy.md.

    tests/accuracy/fresh.py PALPATE FOLDER [--seed N] [--scenes N] [--calculix N] [--only TRUTH]

Scenes of fresh_scenes.py run by the defaults. The truth of --scenes of them is `palpate reference`, and of the first
--calculix of those CalculiX as well, of which nothing is palpate's. Without --seed the draw is new.
FOLDER/SEED-TRUTH.csv keeps every finished row, so that the same call with its seed goes on where one was stopped. A
run of more than 60 s of processor time, or a reference of more than two minutes, is stopped and counted apart. Of a
viscous hold the ends of ramp and hold are compared, and the worse one counts.
"""
import argparse
import concurrent.futures
import csv
import hashlib
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True

import calculix
import fresh_scenes

NAMES = ["scene", "kind", "body", "model", "force_mN", "truth_mN", "error", "stated", "doubt",
         "seconds", "truth_seconds", "note"]
LIMIT = 60  # s of a processor, of a run
TRUTH_LIMIT = 120  # of a reference


def call(words, folder, limit=LIMIT):
    """Processor time (s); RuntimeError with what was said where it fails, or "too long"."""
    before = processor()
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)))
    taken = processor() - before
    if done.returncode != 0:
        if done.returncode < 0 and taken > 0.9 * limit:  # ended by the limit
            raise RuntimeError("too long")
        raise RuntimeError(done.stderr.strip().replace("\n", " ") or f"exit code {done.returncode}")
    return taken


def ends(path, error):
    """(force in mN, its error in mN) at the end of every step."""
    with open(path, encoding="utf-8", newline="") as file:
        last = {row["step"]: row for row in csv.DictReader(file)}
    return [(1e3 * float(row["contact_force_N"]), 1e3 * float(row.get(error) or 0)) for _, row in sorted(last.items())]


def processor():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def truth_of(by, program, scene, folder):
    """(force in mN, its error in mN) at the end of every step; RuntimeError where there is none."""
    if by == "reference":
        call([program, "reference", "scene.toml", "--out", "truth"], folder, TRUTH_LIMIT)
        return ends(folder / "truth/scene_reference.csv", "error_N")
    with concurrent.futures.ProcessPoolExecutor(1) as alone:  # Gmsh ends its process where it fails
        forces = alone.submit(calculix.by_calculix, scene, folder).result()
    return [(1e3 * force, 1e3 * error) for force, error in forces]


def measure(program, seed, number, by):
    """The row of a scene."""
    scene = fresh_scenes.draw(seed, number)
    row = {"scene": number, "kind": scene["kind"], "body": scene["body"]}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        fresh_scenes.write(scene, folder)
        try:
            row["seconds"] = f"{call([program, 'run', 'scene.toml', '--out', 'out'], folder):.1f}"
            forces = [force for force, _ in ends(folder / "out/scene/force_indentation.csv", "")]
            with open(folder / "out/scene/findings.csv", encoding="utf-8", newline="") as file:
                findings = next(csv.DictReader(file))
        except RuntimeError as wrong:
            return row | {"note": f"run: {wrong}"}
        row |= {"model": findings["model"], "stated": findings["stated_error"]}
        before = processor()
        try:
            truths = truth_of(by, program, scene, folder)
        except Exception as wrong:  # of Gmsh, which has no class of its own
            return row | {"note": f"{by}: {wrong}", "truth_seconds": f"{processor() - before:.1f}"}
    largest = max(truth for truth, _ in truths)
    force, (truth, doubt) = max(zip(forces, truths), key=lambda pair: abs(pair[0] - pair[1][0]))
    return row | {"force_mN": f"{force:.6g}", "truth_mN": f"{truth:.6g}", "error": f"{(force - truth) / largest:.5f}",
                  "doubt": f"{doubt / largest:.5f}", "truth_seconds": f"{processor() - before:.1f}"}


def measured(program, folder, seed, by, scenes):
    """All rows of a seed and truth; computes what is missing. Another program starts anew."""
    path = folder / f"{seed}-{by}.csv"
    version = "# " + hashlib.sha256(pathlib.Path(program).read_bytes()).hexdigest() + "\n"
    folder.mkdir(parents=True, exist_ok=True)
    kept = path.read_text(encoding="utf-8").splitlines(True) if path.exists() else []
    if not kept or kept[0] != version:
        kept = [version, ",".join(NAMES) + "\n"]
        path.write_text("".join(kept), encoding="utf-8")
    done = {int(row["scene"]) for row in csv.DictReader(kept[1:])}
    with open(path, "a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, NAMES, restval="", lineterminator="\n")
        for number in scenes:
            if number not in done:
                writer.writerow(measure(program, seed, number, by))
                file.flush()
    with open(path, encoding="utf-8", newline="") as file:
        return [row for row in csv.DictReader(file.readlines()[1:]) if int(row["scene"]) in scenes]


def covered(row):
    return abs(float(row["error"])) <= float(row["stated"]) + float(row["doubt"])


def line(title, rows):
    """One row of the table, by the scenes that have a truth."""
    good = [row for row in rows if row["error"]]
    if not good:
        return f"| {title} | 0 | | | | |"
    errors = [abs(float(row["error"])) for row in good]
    ratios = [float(row["stated"]) / max(error, 1e-4) for error, row in zip(errors, good)]
    worst = max(good, key=lambda row: abs(float(row["error"])))
    return (f"| {title} | {len(good)} | {sum(map(covered, good))} | {statistics.median(ratios):.1f} | "
            f"{100 * float(worst['error']):+.2f} ({100 * float(worst['stated']):.1f}) | "
            f"{100 * sum(error <= 0.03 for error in errors) / len(good):.0f} |")


def table(by, rows):
    name = "CalculiX" if by == "calculix" else "`palpate reference`"
    print(f"\n| scenes, beside {name} | number | covered | median of stated over true | worst (stated), % "
          "| within 3 %, % |\n|---|---|---|---|---|---|")
    print(line("all", rows))
    for kind in fresh_scenes.KINDS:
        if any(row["kind"] == kind for row in rows):
            print(line(kind, [row for row in rows if row["kind"] == kind]))
    notes = [row for row in rows if row["note"]]
    late = sum("too long" in row["note"] for row in notes)
    print(f"\nNot compared: {len(notes)}, of which {late} were stopped.\n")
    for row in notes:
        if "too long" not in row["note"]:
            print(f"- scene {row['scene']}, {row['kind']}: {row['note']}")
    for row in rows:
        if row["error"] and not covered(row):
            print(f"- not covered: scene {row['scene']}, {row['kind']}, {row['body']}, by `{row['model']}`: "
                  f"{100 * float(row['error']):+.2f} %, {100 * float(row['stated']):.1f} % stated")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate", type=lambda word: str(pathlib.Path(word).resolve()))
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1, 10 ** 6))
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--calculix", type=int, default=60)
    parser.add_argument("--only", choices=("reference", "calculix"))
    parser.add_argument("--kind", choices=fresh_scenes.KINDS, action="append")
    arguments = parser.parse_args()
    print(f"Seed {arguments.seed}.", flush=True)
    kinds = arguments.kind or fresh_scenes.KINDS
    numbers = [number for number in range(100 * arguments.scenes)
               if fresh_scenes.KINDS[number % len(fresh_scenes.KINDS)] in kinds][:arguments.scenes]
    for by in ("reference", "calculix"):
        if arguments.only not in (None, by):
            continue
        scenes = numbers
        if by == "calculix":
            scenes = [number for number in numbers if fresh_scenes.KINDS[number % len(fresh_scenes.KINDS)]
                      not in fresh_scenes.NOT_FOR_CALCULIX][:arguments.calculix]
        rows = measured(arguments.palpate, arguments.folder.resolve(), arguments.seed, by, scenes)
        table(by, rows)


if __name__ == "__main__":
    main()
