"""palpate's linear answers on the random bodies: fills deep_bodies.csv.

The forces of `coupled_springs` with `contact.depth = "hertz"` on surface files of the bodies in
random_bodies.csv (layered ones: cuboids), at the same depths; deep_ratio.py compares them.
    deep_bodies.py PALPATE      the program's path
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
NAMES = ["body", "depth", "force", "nodes"]
NODES = 1500  # that the surface's triangles suit

SCENARIO = """schema = 1
[tissue]
material = "skin"
young_modulus = "{youngs} kPa"
poisson_ratio = {poisson}
base = "{base}"
shape = {shape}
{regions}
[finger]
material = "rigid"
radius = "{radius} mm"
{place}
[contact]
depth = "hertz"
viscosity = "none"
[solver]
model = "coupled_springs"
integrator = "quasi_static"
[output]
interval = "50 ms"
pressure_maps = false
fits = false
figures = false
[[step]]
kind = "indent"
to = "{deepest} mm"
rate = "{rate} mm/s"
"""


def line(start, end, spacing):
    """Points from `start` up to, without, `end`."""
    count = max(1, int(np.ceil(np.hypot(end[0] - start[0], end[1] - start[1]) / spacing - 1e-9)))
    return [(start[0] + k / count * (end[0] - start[0]), start[1] + k / count * (end[1] - start[1]))
            for k in range(count)]


def profile(kind, shape):
    """Radius and height from the apex to the middle of the base, and the spacing of the points."""
    radius = shape["radius"]
    height = shape.get("height") or sum(shape["layers"])
    volume = np.pi * radius ** 2 * height * (2.0 / 3.0 if kind == "dome" else 1.0)
    spacing = 1.15 * (volume / NODES) ** (1.0 / 3.0)
    if kind == "dome":
        count = int(np.ceil(0.45 * np.pi * max(radius, height) / spacing))
        angles = 0.5 * np.pi * np.arange(count) / count
        points = [(radius * np.sin(a), height * np.cos(a)) for a in angles]
    elif kind == "dish":
        across = np.linspace(0.0, radius, int(np.ceil(radius / spacing)) + 1)
        rise = shape["hollow"] - np.sqrt(shape["hollow"] ** 2 - across ** 2)
        points = list(zip(across[:-1], height + rise[:-1])) \
            + line((radius, height + rise[-1]), (radius, 0.0), spacing)
    else:
        points = line((0.0, height), (radius, height), spacing) \
            + line((radius, height), (radius, 0.0), spacing)
    return points + line((radius, 0.0), (0.0, 0.0), spacing) + [(0.0, 0.0)], spacing


def surface(points, spacing):
    """The text of an OFF file: rings of points, joined by triangles."""
    places, faces, rings = [], [], []
    for radius, height in points:
        count = max(6, round(2.0 * np.pi * radius / spacing)) if radius > 1e-9 else 1
        shift = 0.5 * ((len(rings) + 1) % 2)
        rings.append((len(places), count, shift))
        angles = 2.0 * np.pi * (np.arange(count) + shift) / count
        places += [(radius * np.cos(a), radius * np.sin(a), height) for a in angles]
    for (first, count, shift), (below, below_count, below_shift) in zip(rings, rings[1:]):
        left, right = count if count > 1 else 0, below_count if below_count > 1 else 0
        i = j = 0
        while i < left or j < right:
            upper_next = (i + 1 + shift) / count <= (j + 1 + below_shift) / below_count
            corner = (first + i % count, below + j % below_count)
            if j >= right or (i < left and upper_next):
                i += 1
                faces.append(corner + (first + i % count,))
            else:
                j += 1
                faces.append(corner + (below + j % below_count,))
    text = [f"OFF\n{len(places)} {len(faces)} 0"]
    text += ["%.9g %.9g %.9g" % place for place in places]
    text += ["3 %d %d %d" % face for face in faces]
    return "\n".join(text) + "\n"


def regions(kind, shape, youngs, poisson):
    """The tables of the layers below the first, or of the ball."""
    made, text = [], ""
    if kind == "layers":
        top = sum(shape["layers"])
        for thickness, modulus, ratio in list(zip(shape["layers"], youngs, poisson)):
            place = f'bottom = "{top - thickness:.6g} mm"\ntop = "{top:.6g} mm"'
            made.append((f'kind = "slab"\n{place}', modulus, ratio))
            top = abs(round(top - thickness, 6))
        made = made[1:]
    elif kind == "ball":
        centre = shape["height"] - shape["centre"]
        made = [(f'kind = "sphere"\ncentre = ["0 mm", "0 mm", "{centre:.6g} mm"]\n'
                 f'radius = "{shape["ball"]} mm"', youngs[1], poisson[1])]
    for place, modulus, ratio in made:
        text += (f'[[region]]\n{place}\nmaterial = "skin"\nyoung_modulus = "{modulus} kPa"\n'
                 f'poisson_ratio = {ratio}\n')
    return text


def answers(program, rows):
    """palpate's forces in mN at the rows' depths and its nodes; None where it has no answer."""
    row = rows[0]
    shape, youngs, poisson = (json.loads(row[name]) for name in ("shape", "youngs", "poisson"))
    depths = [float(r["depth"]) for r in rows]
    with tempfile.TemporaryDirectory() as folder:
        if row["kind"] == "layers":  # a square: the sides are five radii of the sphere away
            sides = f'"{2.0 * shape["radius"]:g} mm"'
            form = f'{{ size = [{sides}, {sides}, "{sum(shape["layers"]):g} mm"] }}'
            place = ""
        else:
            form = '{ kind = "file", file = "body.off", unit = "mm" }'
            place = 'x = "0 mm"\ny = "0 mm"'
            with open(os.path.join(folder, "body.off"), "w") as file:
                file.write(surface(*profile(row["kind"], shape)))
        with open(os.path.join(folder, "press.toml"), "w") as file:
            file.write(SCENARIO.format(
                youngs=youngs[0], poisson=poisson[0], shape=form, place=place,
                base=row["base"],
                regions=regions(row["kind"], shape, youngs, poisson), radius=row["sphere_radius"],
                deepest=f"{depths[-1]:g}",
                rate=f"{depths[-1]:g}"))
        result = subprocess.run([program, "run", os.path.join(folder, "press.toml"), "--out",
                                 os.path.join(folder, "out")], capture_output=True, text=True)
        folder = os.path.join(folder, "out", "press")
        if result.returncode != 0 or not os.path.exists(os.path.join(folder, "findings.csv")):
            return None, result.stderr
        with open(os.path.join(folder, "force_indentation.csv"), newline="") as file:
            curve = [(float(r["travel_mm"]), 1e3 * float(r["contact_force_N"]))
                     for r in csv.DictReader(file)]
        with open(os.path.join(folder, "findings.csv"), newline="") as file:
            nodes = next(csv.DictReader(file))["nodes"]
    # Rows stand at twentieths of the deepest travel, where the depths are, but for their rounding.
    found = [min(curve, key=lambda point: abs(point[0] - depth)) for depth in depths]
    return [force * (depth / travel) ** 1.5
            for (travel, force), depth in zip(found, depths)], nodes


def main():
    program = os.path.abspath(sys.argv[1])
    bodies = {}
    with open(os.path.join(HERE, "random_bodies.csv"), newline="") as file:
        for row in csv.DictReader(file):
            bodies.setdefault(row["body"], []).append(row)
    path = os.path.join(HERE, "deep_bodies.csv")
    done = set()
    if os.path.exists(path):
        with open(path, newline="") as file:
            done = {row["body"] for row in csv.DictReader(file)}
    else:
        with open(path, "w") as file:
            file.write(",".join(NAMES) + "\n")
    for number, rows in bodies.items():
        if number in done:
            continue
        found, more = answers(program, rows)
        if found is None:
            print(number, rows[0]["kind"], "has no answer:", more[-600:], file=sys.stderr)
            continue
        with open(path, "a") as file:
            file.writelines(f"{number},{row['depth']},{force:.6g},{more}\n"
                            for row, force in zip(rows, found))
        share = [f"{force / float(row['paraboloid']):.3f}" for row, force in zip(rows, found)]
        print(number, rows[0]["kind"], "over the linear reference:", *share, more, "nodes",
              file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
