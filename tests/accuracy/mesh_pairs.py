"""Counts how often two meshes of one random body differ in force by more than both state.

First of bodies on two tetrahedral meshes, then of blocks 0.5 to 3 R thick and 3 to 10 times as wide,
on a mesh of 2000 to 4000 nodes and on each of: the 140 nodes from which refining starts, and meshes
refined for tolerances of 5 and 1 %.

Usage: python3 tests/accuracy/mesh_pairs.py PALPATE [PAIRS]     (200 pairs take seven minutes at -O1)
"""
import csv
import random
import subprocess
import sys
import tempfile

SCENARIO = """schema = 1
[tissue]
material = "skin"
poisson_ratio = {ratio:.3f}
shape = {shape}
{mesh}
[finger]
material = "rigid"
radius = "{radius:.1f} mm"
[solver]
model = "coupled_springs"
integrator = "quasi_static"
tolerance = {tolerance}
[output]
interval = "1 s"
pressure_maps = false
fits = false
figures = false
[[step]]
kind = "indent"
to = "{travel:.3f} mm"
rate = "{travel:.3f} mm/s"
"""


def random_shape():
    kind = random.choice(["cuboid", "ellipsoid", "cylinder", "cuboid"])
    u = random.uniform
    if kind == "cuboid":
        return '{ kind = "cuboid", size = ["%.1f mm", "%.1f mm", "%.1f mm"] }' % (u(40, 80), u(40, 80), u(8, 40))
    if kind == "ellipsoid":
        return '{ kind = "ellipsoid", size = ["%.1f mm", "%.1f mm", "%.1f mm"] }' % (u(40, 90), u(40, 90), u(20, 50))
    return '{ kind = "cylinder", radius = "%.1f mm", length = "%.1f mm" }' % (u(14, 40), u(60, 120))


def force_and_error(program, folder, **values):
    with open(folder + "/pair.toml", "w") as file:
        file.write(SCENARIO.format(**values))
    subprocess.run([program, "run", "pair.toml", "--force", "--quiet"], cwd=folder, check=True)
    with open(folder + "/out/pair/findings.csv") as file:
        row = next(csv.DictReader(file))
    return float(row["peak_force_N"]), float(row["mesh_error"])


TETGEN = 'mesh = {{ kind = "tetgen", nodes = {} }}'
START = "mesh = { kind = \"mirrored\", cells = [3, 4, 6] }"


def report(name, outside, pairs):
    print("%s: %d of %d pairs outside" % (name, outside, pairs), flush=True)


def apart(program, folder, one, other):
    """Whether two presses differ by more than both state; if so, they are printed."""
    (force, error), (force_2, error_2) = (force_and_error(program, folder, **press) for press in (one, other))
    difference = abs(force - force_2) / max(force, force_2)
    if difference <= error + error_2:
        return False
    print("%s, %s and %s, tolerance %g: %.2f %% apart, %.2f and %.2f %% stated" %
          (one["shape"], one["mesh"], other["mesh"], other["tolerance"], 100 * difference, 100 * error,
           100 * error_2), flush=True)
    return True


def main():
    program, pairs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
    random.seed(7)
    with tempfile.TemporaryDirectory() as folder:
        outside = 0
        for _ in range(pairs):
            radius = random.uniform(6, 14)
            body = dict(shape=random_shape(), ratio=random.uniform(0.2, 0.49), radius=radius,
                        travel=radius * random.uniform(0.03, 0.1), tolerance=0.05)
            nodes = random.randint(200, 500), random.randint(500, 1600)
            outside += apart(program, folder, *(dict(body, mesh=TETGEN.format(count)) for count in nodes))
        report("bodies", outside, pairs)
        counts = dict.fromkeys(((START, 0.05), ("", 0.05), ("", 0.01)), 0)
        for _ in range(pairs // 5):
            radius = random.uniform(5, 15)
            thickness = random.uniform(0.5, 3) * radius
            width = random.uniform(3, 10) * max(thickness, 0.7 * radius)
            body = dict(shape='{ kind = "cuboid", size = ["%.2f mm", "%.2f mm", "%.2f mm"] }' %
                        (width, width, thickness), ratio=random.uniform(0, 0.49), radius=radius,
                        travel=min(radius, thickness) * random.uniform(0.02, 0.15))
            for mesh, tolerance in counts:
                counts[mesh, tolerance] += apart(program, folder, dict(body, mesh="", tolerance=0.002),
                                                 dict(body, mesh=mesh, tolerance=tolerance))
        for (mesh, tolerance), outside in counts.items():
            report("thin blocks, " + (mesh or "refined for %g" % tolerance), outside, pairs // 5)


if __name__ == "__main__":
    main()
