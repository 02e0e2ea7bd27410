"""Counts how often two meshes of one random body differ in force by more than both state.

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
mesh = {{ kind = "tetgen", nodes = {nodes} }}
[finger]
material = "rigid"
radius = "{radius:.1f} mm"
[solver]
model = "coupled_springs"
integrator = "quasi_static"
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


def main():
    program, pairs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
    random.seed(7)
    outside = 0
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(pairs):
            radius = random.uniform(6, 14)
            body = dict(shape=random_shape(), ratio=random.uniform(0.2, 0.49), radius=radius,
                        travel=radius * random.uniform(0.03, 0.1))
            nodes = random.randint(200, 500), random.randint(500, 1600)
            (one, error_1), (other, error_2) = (
                force_and_error(program, folder, nodes=count, **body) for count in nodes)
            difference = abs(one - other) / max(one, other)
            if difference > error_1 + error_2:
                outside += 1
                print("%s, %d and %d nodes: %.2f %% apart, %.2f and %.2f %% stated" %
                      (body["shape"], *nodes, 100 * difference, 100 * error_1, 100 * error_2), flush=True)
    print("%d of %d pairs outside" % (outside, pairs))


if __name__ == "__main__":
    main()
