"""Counts how often what palpate states about its forces is true, and writes the table and figure.

Scene i of two families is drawn with the seed i. `unseen` presses body 500 + i of
tests/elasticity/unseen_bodies.csv to one of its four depths; its truth is the neo-Hookean force of
that independent program, in viscous scenes integrated over time by theory.md [viscous]. `blocks` presses
bodies that are none of revolution, and its truth is `palpate reference`, which shares the factor of
a deep press with what it judges. A scene has the defaults, a model or mesh of its own, or viscosity.

Before them stand the deep presses of tests/cases/bodies.csv.

    coverage.py PALPATE RESULTS.csv FIGURE.gp      prints Markdown; a stopped run goes on
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
import random_bodies

NAMES = ["scene", "family", "kind", "setting", "model", "nodes", "depth_over_radius", "force_mN",
         "truth_mN", "truth_error_mN", "stated", "tolerance", "cheaper"]
BLOCKS = 60
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


def block_scene(number):
    draw = random.Random(10000 + number)
    u = draw.uniform
    radius = u(6.0, 14.0)
    kind = draw.choice(["block", "lump beside", "ellipsoid", "cylinder"])
    regions = place = ""
    ratio = u(0.0, 0.49)
    if kind in ("block", "lump beside"):
        sizes = [u(3.0, 7.0) * radius, u(3.0, 7.0) * radius, radius * 0.6 * 6.0 ** draw.random()]
        thickness = sizes[2]
        aside = [size * u(0.35, 0.65) for size in sizes[:2]]
        place = f'x = "{aside[0]:.4g} mm"\ny = "{aside[1]:.4g} mm"\n'
        shape = '{ size = ["%.4g mm", "%.4g mm", "%.4g mm"] }' % tuple(sizes)
        if kind == "lump beside":
            ball = min(u(0.2, 0.35) * thickness, 0.6 * radius)
            below = ball + u(0.15, 0.5) * thickness
            below = min(below, thickness - ball - 0.05 * thickness)
            regions = (f'[[region]]\nkind = "sphere"\ncentre = ["{aside[0] + u(-1, 1) * radius:.4g} '
                       f'mm", "{aside[1]:.4g} mm", "{thickness - below:.4g} mm"]\n'
                       f'radius = "{ball:.4g} mm"\nmaterial = "skin"\n'
                       f'young_modulus = "{30.0 * 10.0 ** u(-0.7, 1.0):.4g} kPa"\n'
                       f'poisson_ratio = {ratio:.4f}\n')
    elif kind == "ellipsoid":
        sizes = [u(4.0, 8.0) * radius, u(4.0, 8.0) * radius, u(2.0, 5.0) * radius]
        thickness = sizes[2]
        shape = '{ kind = "ellipsoid", size = ["%.4g mm", "%.4g mm", "%.4g mm"] }' % tuple(sizes)
    else:
        own = u(1.5, 4.0) * radius
        thickness = 2.0 * own
        shape = '{ kind = "cylinder", radius = "%.4g mm", length = "%.4g mm" }' \
            % (own, u(5.0, 9.0) * radius)
    depth = min(0.5 * radius, 0.3 * thickness) * u(0.05, 1.0)
    solver, mesh, name = setting(draw, kind != "lump beside", False, 2 if regions else 1)

    def scenario(solver, mesh):
        tissue = (f'young_modulus = "30 kPa"\npoisson_ratio = {ratio:.4f}\nshape = {shape}\n{mesh}\n'
                  + regions)
        return SCENARIO.format(tissue=tissue, finger=f'radius = "{radius:.4g} mm"\n{place}',
                               contact='viscosity = "none"', solver=solver, interval=0.05,
                               depth=depth, rate=depth)

    return {"kind": kind, "setting": name, "files": {}, "ratio": depth / radius,
            "text": scenario(solver, mesh), "reference": scenario("", "")}


def run(program, folder, *settings):
    """The row of findings.csv of press.toml; what palpate says where it has none."""
    words = [word for one in settings for word in ("--set", one)]
    result = subprocess.run([program, "run", "press.toml", "--out", "out", "--force"] + words,
                            cwd=folder, capture_output=True, text=True)
    if result.returncode != 0:
        return None, result.stderr
    with open(os.path.join(folder, "out", "press", "findings.csv"), newline="") as file:
        return next(csv.DictReader(file)), ""


def write(folder, name, text):
    with open(os.path.join(folder, name), "w") as file:
        file.write(text)


def cheaper(program, folder, taken, truth):
    """The models below `taken` that are within the tolerance of the truth."""
    good = []
    ladder = ("hertz", "layer", "coupled_springs", "solid")
    for model in ladder[:ladder.index(taken)]:
        found = None
        for depth in ("neo_hookean", "hertz"):
            found = found or run(program, folder, f"solver.model={model}", f"contact.depth={depth}")[0]
        if found and abs(1e3 * float(found["peak_force_N"]) / truth - 1.0) <= TOLERANCE:
            good.append(model)
    return " ".join(good)


def measure(program, family, number, scene):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in scene["files"].items():
            write(folder, name, text)
        if "truth" in scene:
            truth, error = scene["truth"]
        else:
            write(folder, "truth.toml", scene["reference"])
            found = subprocess.run([program, "reference", "truth.toml", "--out", "out"],
                                   cwd=folder, capture_output=True, text=True)
            if found.returncode != 0:
                raise RuntimeError(f"{family} {number}: {found.stderr}")
            with open(os.path.join(folder, "out", "truth_reference.csv"), newline="") as file:
                last = list(csv.DictReader(file))[-1]
            truth, error = 1e3 * float(last["contact_force_N"]), 1e3 * float(last["error_N"])
        write(folder, "press.toml", scene["text"])
        found, sentence = run(program, folder)
        if found is None:
            raise RuntimeError(f"{family} {number}: {sentence}\n{scene['text']}")
        below = cheaper(program, folder, found["model"], truth) \
            if scene["setting"].startswith("defaults") else ""
        return [number, family, scene["kind"], scene["setting"], found["model"],
                found.get("nodes") or "", f"{scene['ratio']:.4f}",
                f"{1e3 * float(found['peak_force_N']):.6g}", f"{truth:.6g}", f"{error:.3g}",
                f"{float(found['stated_error']):.6f}", TOLERANCE, below]


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
    done = {(row["family"], int(row["scene"])) for row in csv.DictReader(lines[1:])}
    bodies = unseen_bodies()
    wanted = [("unseen", body) for body in sorted(bodies)] + [("blocks", i) for i in range(BLOCKS)]
    failures = 0

    def one(family, number):
        scene = block_scene(number) if family == "blocks" else unseen_scene(number, bodies[number])
        return measure(program, family, number, scene)

    with open(path, "a", newline="") as file, \
            concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        tasks = [pool.submit(one, *key) for key in wanted if key not in done]
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


def deep_cases():
    """Body, kind, shape (mm), moduli (kPa), ratios, radius, depth and neo-Hookean force (mN)."""
    with open(os.path.join(HERE, "..", "cases", "bodies.csv"), newline="") as file:
        for row in csv.DictReader(file):
            if not row["force_neo_hookean_mN"]:
                continue
            youngs, poisson = ([float(value) for value in row[name].split("/")]
                               for name in ("young_modulus_kPa", "poisson_ratio"))
            shape = {"block60x30": {"size": 60.0, "layers": [30.0]},
                     "layers": {"size": 160.0, "layers": [2.0, 8.0, 20.0]},
                     "dome20": {"radius": 20.0, "height": 10.0},
                     "disc30": {"radius": 30.0, "layers": [10.0]}}[row["case"].split("-")[0]]
            kind = "layers" if "size" in shape else row["group"]
            yield row["case"], kind, shape, youngs, poisson, float(row["sphere_radius_mm"]), \
                float(row["travel_mm"]), float(row["force_neo_hookean_mN"])
    # A disc of the block's area, nearly incompressible.
    body = {"body": 0, "kind": "disc", "shape": {"radius": 33.851, "layers": [30.0]},
            "base": "bonded", "youngs": [72.4], "poisson": [0.49], "sphere_radius": 11.0,
            "deepest": 8.0}
    random_bodies.DEPTHS = (0.25, 0.375, 0.625, 1.0)
    for row in random_bodies.rows(body):
        yield "block60x30-nu0.49", "layers", {"size": 60.0, "layers": [30.0]}, [72.4], [0.49], \
            11.0, float(row[7]), float(row[14])


def deep_table(program):
    print("\n## Deep presses\n\nForces by the defaults against an independent neo-Hookean program "
          "([tests/cases/bodies.csv](../tests/cases/bodies.csv), and for nu 0.49\n"
          "[tests/elasticity/axisymmetric.py](../tests/elasticity/axisymmetric.py)). The blocks of "
          "60 x 60 x 30 mm are computed there as discs of their area.\n\n"
          "| body | depth, mm | depth over radius | model | nodes | force, mN | neo-Hookean, mN | "
          "error, % | stated, % |\n|---|---|---|---|---|---|---|---|---|")
    for case, kind, shape, youngs, poisson, radius, depth, truth in deep_cases():
        with tempfile.TemporaryDirectory() as folder:
            if "size" in shape:
                form = f'{{ size = ["{shape["size"]} mm", "{shape["size"]} mm", ' \
                    f'"{sum(shape["layers"])} mm"] }}'
                place = ""
            else:
                write(folder, "body.off", deep_bodies.surface(*deep_bodies.profile(kind, shape)))
                form = '{ kind = "file", file = "body.off", unit = "mm" }'
                place = 'x = "0 mm"\ny = "0 mm"\n'
            tissue = f'young_modulus = "{youngs[0]} kPa"\npoisson_ratio = {poisson[0]}\n' \
                f'shape = {form}\n' + deep_bodies.regions(kind, shape, youngs, poisson)
            write(folder, "press.toml",
                  SCENARIO.format(tissue=tissue, finger=f'radius = "{radius} mm"\n{place}',
                                  contact='viscosity = "none"', solver="", interval=0.05,
                                  depth=depth, rate=depth))
            found, sentence = run(program, folder)
        if found is None:
            sys.exit(f"{case}: {sentence}")
        force = 1e3 * float(found["peak_force_N"])
        print(f"| {case} | {depth:g} | {depth / radius:.2f} | {found['model']} | "
              f"{found.get('nodes') or '-'} | {force:.1f} | {truth:.1f} | "
              f"{100.0 * (force / truth - 1.0):.1f} | {100.0 * float(found['stated_error']):.1f} |")
    print()


def share(rows, holds):
    return f"{100.0 * sum(map(holds, rows)) / len(rows):.0f}"


def summary(title, rows):
    far = max(rows, key=lambda row: abs(row["error"]))
    return f"| {title} | {len(rows)} | {share(rows, lambda r: r['covered'])} | " \
        f"{share(rows, lambda r: r['stated'] < 3.0 * abs(r['error']))} | " \
        f"{share(rows, lambda r: abs(r['error']) <= TOLERANCE)} | " \
        f"{100.0 * far['error']:.1f} ({100.0 * far['stated']:.1f}) |"


def name_of(row):
    return f"{row['family']} {row['scene']}, {row['kind']}"


def report(rows):
    print("## What is stated against what is true\n")
    print(f"{len(rows)} scenes drawn at random, none left out. Each states `stated_error` after its "
          "run; the truth of")
    print(f"{sum(row['family'] == 'unseen' for row in rows)} of them is the neo-Hookean force of an "
          "independent program on bodies to which no formula here was fitted\n"
          "([tests/elasticity](../tests/elasticity/README.md)), that of the others, bodies of no "
          "revolution, `palpate reference`, which shares\nthe factor of a deep press with what it "
          "judges. Depths reach half the finger's radius. Covered: the error is at most what\nis "
          "stated and what the truth leaves open.\n"
          "[tests/accuracy/coverage.py](../tests/accuracy/coverage.py) draws the scenes.\n")
    print("| scenes | number | covered, % | stated below three times the error, % | within 5 %, % | "
          "largest error (stated), % |\n|---|---|---|---|---|---|")
    print(summary("all", rows))
    for key in ("family", "kind", "setting", "model"):
        for value in sorted({row[key] for row in rows}):
            print(summary(f"{key}: {value}", [row for row in rows if row[key] == value]))
    own = [row for row in rows if row["setting"].startswith("defaults")]
    ladder = ("hertz", "layer", "coupled_springs", "solid")
    above = [row for row in own if row["cheaper"]
             and ladder.index(row["model"]) - ladder.index(row["cheaper"].split()[0]) > 1]
    over = [row for row in own if row["cheaper"]]
    missed = [row for row in own if abs(row["error"]) > TOLERANCE]
    warned = sum(row["stated"] > TOLERANCE for row in missed)
    print(f"\nOf the {len(own)} scenes with the defaults, the model that `auto` takes is within its "
          f"tolerance of 5 % in {share(own, lambda r: abs(r['error']) <= TOLERANCE)} %; of the "
          f"{len(missed)} others {warned} state more than 5 %. A\n"
          f"cheaper one would have been in {len(over)}, and is more than one step below in "
          f"{len(above)}"
          + (": " + "; ".join(map(name_of, above)) if above else "") + ".\n")
    print("![Stated against true error](coverage.svg)\n\nA circle is a scene; below the line it "
          "states less than is true.\n")
    misses = sorted((row for row in rows if not row["covered"]),
                    key=lambda row: row["stated"] - abs(row["error"]))
    print("The misses:\n\n| scene | setting | model | depth over radius | error, % | stated, % | "
          "truth's own, % |\n|---|---|---|---|---|---|---|")
    for row in misses:
        print(f"| {name_of(row)} | {row['setting']} | {row['model']} | "
              f"{float(row['depth_over_radius']):.2f} | {100.0 * row['error']:.1f} | "
              f"{100.0 * row['stated']:.1f} | {100.0 * row['doubt']:.1f} |")


def figure(rows, path):
    points = ["%.5g %.5g\n" % (max(100.0 * abs(row["error"]), 0.01), 100.0 * row["stated"])
              for row in rows]
    with open(path, "w") as file:
        file.write("$points << EOD\n" + "".join(points) + "EOD\n"
                   "set terminal svg size 620,520 font 'sans,13' background 'white'\n"
                   "set output 'docs/coverage.svg'\nset logscale xy\n"
                   "set xrange [0.01:100]\nset yrange [0.1:100]\n"
                   "set xlabel 'true error, %'\nset ylabel 'stated error, %'\nset key off\n"
                   "plot $points using 1:2 with points pt 6 lc rgb '#1f77b4', x with lines lc rgb "
                   "'black'\n")


def main():
    program, results, script = (os.path.abspath(word) for word in sys.argv[1:4])
    deep_table(program)
    rows = measured(program, results)
    report(rows)
    figure(rows, script)


if __name__ == "__main__":
    main()
