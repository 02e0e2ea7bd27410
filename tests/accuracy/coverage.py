"""Counts how often what palpate states about its forces is true, on bodies of revolution.

Every body of tests/elasticity/unseen_bodies.csv is pressed to one of its four depths, drawn with its number as the seed;
the truth is the neo-Hookean force of that independent program, in viscous scenes integrated over time by theory.md
[viscous]. A scene has the defaults, a model or mesh of its own, or viscosity. fresh.py counts other bodies.

    coverage.py PALPATE RESULTS.csv      prints Markdown; a stopped run goes on
"""
import collections
import concurrent.futures
import csv
import hashlib
import json
import os
import random
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "elasticity"))
import deep_bodies

NAMES = ["scene", "kind", "setting", "model", "nodes", "depth_over_radius", "force_mN",
         "truth_mN", "truth_error_mN", "stated"]
TOLERANCE = 0.05  # `solver.tolerance`, which the scenes leave alone

SCENARIO = """schema = 1
[tissue]
material = "skin"
{tissue}
[finger]
material = "rigid"
{finger}
[contact]
{contact}
[solver]
{solver}
[output]
interval = "{interval:.9g} s"
pressure_maps = false
fits = false
figures = false
[[step]]
kind = "indent"
to = "{depth:.9g} mm"
rate = "{rate:.9g} mm/s"
"""


def unseen_bodies():
    """The rows of unseen_bodies.csv by body, without depths that have no reference."""
    bodies = collections.defaultdict(list)
    with open(os.path.join(HERE, "..", "elasticity", "unseen_bodies.csv"), newline="") as file:
        for row in csv.DictReader(file):
            if row["neo_hookean"]:
                bodies[int(row["body"])].append(row)
    return bodies


def setting(draw, closed, layered, tissues=1):
    """The words of `[solver]`, the mesh of `[tissue]` and a name for both.

    Independent springs have no Poisson's ratios of regions.
    """
    kind = draw.random()
    if kind < 0.15 and (closed or layered):
        model = "layer" if layered and (not closed or draw.random() < 0.7) else "hertz"
        return f'model = "{model}"', "", "model"
    if kind < 0.4:
        model = draw.choice(["coupled_springs"] + (["mass_spring"] if tissues == 1 else []))
        nodes = round(200 * 25 ** draw.random())
        return f'model = "{model}"\nintegrator = "quasi_static"', \
            f'mesh = {{ kind = "tetgen", nodes = {nodes} }}', "mesh"
    return "", "", "defaults"


def hereditary(rows, depth, time, relaxation, ratio):
    """The force of a ramp to `depth` within `time`, relative to that of the relaxed tissue.

    The elastic force is h^(3/2) times a factor that is linear between the rows' depths.
    """
    known = [(float(row["depth"]), float(row["neo_hookean"]) / float(row["depth"]) ** 1.5)
             for row in rows]

    def force(h):
        return h ** 1.5 * float(deep_bodies.np.interp(h, *zip(*known)))

    steps = 2000
    total = before = 0.0
    for k in range(1, steps + 1):
        now = force(depth * k / steps)
        middle = time * (1.0 - (k - 0.5) / steps)
        total += (1.0 + (ratio - 1.0) * deep_bodies.np.exp(-middle / relaxation)) * (now - before)
        before = now
    return total / before


def unseen_scene(number, rows):
    draw = random.Random(number)
    row = draw.choice(rows)
    kind = row["kind"]
    shape, youngs, poisson = (json.loads(row[name]) for name in ("shape", "youngs", "poisson"))
    depth, radius = float(row["depth"]), float(row["sphere_radius"])
    files = {}
    layered = kind == "layers"
    if layered:
        side = 2.0 * shape["radius"]
        form = f'{{ size = ["{side:g} mm", "{side:g} mm", "{sum(shape["layers"]):g} mm"] }}'
        place = ""
    else:
        files["body.off"] = deep_bodies.surface(*deep_bodies.profile(kind, shape))
        form = '{ kind = "file", file = "body.off", unit = "mm" }'
        place = 'x = "0 mm"\ny = "0 mm"\n'
    solver, mesh, name = setting(draw, kind in ("disc", "dome", "dish"), layered,
                                 len(poisson))
    time, contact, factor = 1.0, 'viscosity = "none"', 1.0
    viscous = ""
    if len(youngs) == 1 and draw.random() < 0.2:
        time = 0.2 * 10 ** draw.random()
        relaxation = time * 10 ** draw.uniform(-1.0, 1.0)
        ratio = draw.uniform(1.2, 4.0)
        contact, name = "", name + ", viscous"
        viscous = (f'viscosity = "standard_linear_solid"\nrelaxation_time = "{relaxation:.6g} s"\n'
                   f'instantaneous_ratio = {ratio:.6g}\n')
        factor = hereditary(rows, depth, time, relaxation, ratio)
    tissue = (f'young_modulus = "{youngs[0]} kPa"\npoisson_ratio = {poisson[0]}\n'
              f'base = "{row["base"]}"\nshape = {form}\n{viscous}{mesh}\n'
              + deep_bodies.regions(kind, shape, youngs, poisson))
    text = SCENARIO.format(tissue=tissue, finger=f'radius = "{radius} mm"\n{place}',
                           contact=contact, solver=solver, interval=time / 50.0, depth=depth,
                           rate=depth / time)
    truth = factor * float(row["neo_hookean"])
    error = factor * float(row["neo_hookean_error"] or 0.0)
    return {"kind": kind, "setting": name, "text": text, "files": files,
            "ratio": depth / radius, "truth": (truth, error)}


def run(program, folder):
    """The row of findings.csv of press.toml; what palpate says where it has none."""
    result = subprocess.run([program, "run", "press.toml", "--out", "out"], cwd=folder,
                            capture_output=True, text=True)
    if result.returncode != 0:
        return None, result.stderr
    with open(os.path.join(folder, "out", "press", "findings.csv"), newline="") as file:
        return next(csv.DictReader(file)), ""


def write(folder, name, text):
    with open(os.path.join(folder, name), "w") as file:
        file.write(text)


def measure(program, number, scene):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in scene["files"].items():
            write(folder, name, text)
        truth, error = scene["truth"]
        write(folder, "press.toml", scene["text"])
        found, sentence = run(program, folder)
        if found is None:
            raise RuntimeError(f"{number}: {sentence}\n{scene['text']}")
        return [number, scene["kind"], scene["setting"], found["model"], found.get("nodes") or "",
                f"{scene['ratio']:.4f}", f"{1e3 * float(found['peak_force_N']):.6g}", f"{truth:.6g}",
                f"{error:.3g}", f"{float(found['stated_error']):.6f}"]


def measured(program, path):
    """All rows of the results; computes what is missing. Another program starts anew."""
    with open(program, "rb") as file:
        version = "# " + hashlib.sha256(file.read()).hexdigest() + "\n"
    lines = []
    if os.path.exists(path):
        with open(path) as file:
            lines = file.readlines()
    if not lines or lines[0] != version:
        lines = [version, ",".join(NAMES) + "\n"]
        with open(path, "w") as file:
            file.writelines(lines)
    done = {int(row["scene"]) for row in csv.DictReader(lines[1:])}
    bodies = unseen_bodies()
    failures = 0

    def one(number):
        return measure(program, number, unseen_scene(number, bodies[number]))

    with open(path, "a", newline="") as file, \
            concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        tasks = [pool.submit(one, number) for number in sorted(bodies) if number not in done]
        for task in concurrent.futures.as_completed(tasks):
            try:
                csv.writer(file, lineterminator="\n").writerow(task.result())
                file.flush()
            except RuntimeError as error:
                failures += 1
                print(error, file=sys.stderr, flush=True)
    if failures:
        sys.exit(f"{failures} scenes have no answer; run this again to compute only them")
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file.readlines()[1:]))
    for row in rows:
        force, truth = float(row["force_mN"]), float(row["truth_mN"])
        row["error"] = force / truth - 1.0
        row["doubt"] = float(row["truth_error_mN"]) / truth
        row["stated"] = float(row["stated"])
        row["covered"] = abs(row["error"]) <= row["stated"] + row["doubt"]
    return rows


def share(rows, holds):
    return f"{100.0 * sum(map(holds, rows)) / len(rows):.0f}"


def summary(title, rows):
    far = max(rows, key=lambda row: abs(row["error"]))
    return f"| {title} | {len(rows)} | {share(rows, lambda r: r['covered'])} | " \
        f"{share(rows, lambda r: r['stated'] < 3.0 * abs(r['error']))} | " \
        f"{share(rows, lambda r: abs(r['error']) <= TOLERANCE)} | " \
        f"{100.0 * far['error']:.1f} ({100.0 * far['stated']:.1f}) |"


def report(rows):
    print("| scenes | number | covered, % | stated below three times the error, % | within 5 %, % | "
          "largest error (stated), % |\n|---|---|---|---|---|---|")
    print(summary("all", rows))
    for key in ("kind", "setting", "model"):
        for value in sorted({row[key] for row in rows}):
            print(summary(f"{key}: {value}", [row for row in rows if row[key] == value]))
    for row in rows:
        if not row["covered"]:
            print(f"- not covered: body {row['scene']}, {row['kind']}, {row['setting']}, by `{row['model']}`: "
                  f"{100.0 * row['error']:+.1f} %, {100.0 * row['stated']:.1f} % stated")


def main():
    program, results = (os.path.abspath(word) for word in sys.argv[1:3])
    report(measured(program, results))


if __name__ == "__main__":
    main()
