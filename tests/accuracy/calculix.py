#!/usr/bin/env python3
"""Presses drawn at random, by palpate's defaults and by CalculiX on meshes of Gmsh: tables of docs/accuracy.md.

    tests/accuracy/calculix.py PALPATE [--seed N] [--count N] [--kind KIND] [--model MODEL]

Nothing of palpate is in the truth: Gmsh meshes the body with ten-node tetrahedra, about three to a contact radius
under the finger, and CalculiX (C3D10, NLGEOM, the neo-Hookean law of docs/theory.md [solid]) presses a rigid ball into
it, by a penalty that lets through some 0.2 % of the travel. Needs the Debian packages calculix-ccx, gmsh and
python3-gmsh. Every scene takes one to five minutes. Prints Markdown; without --seed, the draw is new each time.
"""
import argparse
import csv
import math
import os
import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile

import gmsh

KINDS = ("block", "edge", "corner", "deep", "stiff lump", "soft lump", "two lumps", "soft on stiff", "stiff on soft",
         "cylinder", "cylinder's end", "ellipsoid")


def draw(kind, rng):
    """One scene, mm and MPa."""
    between = rng.uniform
    radius = between(6, 12)
    scene = {"kind": kind, "radius": radius, "travel": between(0.05, 0.16) * radius, "young": between(5, 60) * 1e-3,
             "nu": between(0.2, 0.46), "lumps": [], "layer": None}
    if kind == "deep":
        scene["travel"] = between(0.3, 0.5) * radius
    contact = math.sqrt(radius * scene["travel"])
    if kind in ("cylinder", "cylinder's end"):
        across, along = between(14, 24), between(50, 80)
        place = between(0.9, 2.0) * contact if kind == "cylinder's end" else between(0.4, 0.6) * along
        scene |= {"body": "cylinder", "size": (across, along), "at": (across, place)}
    elif kind == "ellipsoid":
        size = (between(50, 80), between(50, 80), between(30, 60))
        scene |= {"body": "ellipsoid", "size": size,
                  "at": (size[0] * between(0.4, 0.6), size[1] * between(0.4, 0.6))}
    else:
        size = (between(45, 70), between(45, 70), between(14, 30))
        at = [size[0] * between(0.4, 0.6), size[1] * between(0.4, 0.6)]
        if kind in ("edge", "corner"):
            at[0] = between(0.8, 2.0) * contact
        if kind == "corner":
            at[1] = between(0.8, 2.0) * contact
        scene |= {"body": "cuboid", "size": size, "at": tuple(at)}
    if "lump" in kind:
        for side in ((-1, 1) if kind == "two lumps" else (1,)):
            lump = between(3, 4.5)
            middle = (scene["at"][0] + side * between(2, 8) if kind == "two lumps" else scene["at"][0] + between(-4, 4),
                      scene["at"][1] + between(-4, 4), size[2] - lump - between(1.5, 4))
            if kind == "two lumps":
                middle = (scene["at"][0] + side * (lump + between(0.7, 3)), middle[1], middle[2])
            ratio = between(0.1, 0.5) if kind == "soft lump" else between(3, 15)
            scene["lumps"].append((middle, lump, scene["young"] * ratio))
    if " on " in kind:
        ratio = between(3, 12)
        scene["layer"] = (size[2] - between(2, 7), scene["young"] * (ratio if kind == "soft on stiff" else 1 / ratio))
    return scene


def toml(scene):
    def mm(values):
        return "[" + ", ".join(f'"{value!r} mm"' for value in values) + "]"
    body = scene["body"]
    shape = (f'kind = "cylinder", radius = "{scene["size"][0]!r} mm", length = "{scene["size"][1]!r} mm"'
             if body == "cylinder" else f'kind = "{body}", size = {mm(scene["size"])}')
    lines = ["schema = 1", "[tissue]", 'material = "skin"', f'young_modulus = "{1e3 * scene["young"]!r} kPa"',
             f'poisson_ratio = {scene["nu"]!r}', 'viscosity = "none"', f"shape = {{ {shape} }}"]
    for middle, lump, young in scene["lumps"]:
        lines += ["[[region]]", 'kind = "sphere"', f"centre = {mm(middle)}", f'radius = "{lump!r} mm"',
                  'material = "skin"', f'young_modulus = "{1e3 * young!r} kPa"', f'poisson_ratio = {scene["nu"]!r}']
    if scene["layer"]:
        top, young = scene["layer"]
        lines += ["[[region]]", 'kind = "slab"', 'bottom = "0 mm"', f'top = "{top!r} mm"', 'material = "skin"',
                  f'young_modulus = "{1e3 * young!r} kPa"', f'poisson_ratio = {scene["nu"]!r}']
    lines += ["[finger]", 'material = "rigid"', f'radius = "{scene["radius"]!r} mm"', f'x = "{scene["at"][0]!r} mm"',
              f'y = "{scene["at"][1]!r} mm"', "[[step]]", 'kind = "indent"', f'to = "{scene["travel"]!r} mm"',
              'rate = "1 mm/s"', "[output]", "pressure_maps = false", "fits = false", "figures = false",
              "report = false"]
    return "\n".join(lines) + "\n"


def by_palpate(program, scene, folder, settings):
    """Force (N), stated error, model and processor time (s)."""
    path = pathlib.Path(folder) / "scene.toml"
    path.write_text(toml(scene), encoding="utf-8")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "run", str(path), "--out", folder + "/out", *settings], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    files = {one.name: one for one in pathlib.Path(folder).rglob("*.csv")}
    with open(files["force_indentation.csv"], encoding="utf-8") as text:
        force = float(list(csv.DictReader(text))[-1]["contact_force_N"])
    with open(files["findings.csv"], encoding="utf-8") as text:
        findings = next(csv.DictReader(text))
    return (force, float(findings["stated_error"]), findings["model"],
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def height(scene, x, y):
    """Of the top of the body, mm; -inf beside it."""
    size = scene["size"]
    if scene["body"] == "cylinder":
        inside = size[0] ** 2 - (x - size[0]) ** 2
        return size[0] + math.sqrt(inside) if inside >= 0 and 0 <= y <= size[1] else -math.inf
    if scene["body"] == "ellipsoid":
        inside = 1 - (2 * x / size[0] - 1) ** 2 - (2 * y / size[1] - 1) ** 2
        return size[2] / 2 * (1 + math.sqrt(inside)) if inside >= 0 else -math.inf
    return size[2] if 0 <= x <= size[0] and 0 <= y <= size[1] else -math.inf


def first_touch(scene):
    """Place of the body that the ball meets first, and the height of its middle then, mm."""
    radius, at = scene["radius"], scene["at"]
    best, step = (at[0], at[1]), radius / 4

    def middle(x, y):
        inside = radius ** 2 - (x - at[0]) ** 2 - (y - at[1]) ** 2
        return height(scene, x, y) + math.sqrt(inside) if inside >= 0 else -math.inf
    while step > 1e-7:
        around = [(best[0] + i * step, best[1] + j * step) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        higher = max(around, key=lambda place: middle(*place))
        if middle(*higher) > middle(*best):
            best = higher
        else:
            step /= 2
    return (*best, height(scene, *best)), middle(*best)


def mesh(scene, per_radius):
    """Nodes, elements per tissue, faces of body and ball; by Gmsh."""
    gmsh.initialize(["", "-v", "0"])
    occ = gmsh.model.occ
    size = scene["size"]
    touch, ball_height = first_touch(scene)
    tool = []
    if scene["body"] == "cuboid":
        body = occ.addBox(0, 0, 0, *size)
        base = 0.0
        box_top = size[2]
    elif scene["body"] == "cylinder":
        body = occ.addCylinder(size[0], 0, size[0], 0, size[1], 0, size[0])
        base, box_top = 0.2 * size[0], 2 * size[0]
    else:
        body = occ.addSphere(0, 0, 0, 1)
        occ.affineTransform([(3, body)], [size[0] / 2, 0, 0, size[0] / 2, 0, size[1] / 2, 0, size[1] / 2,
                                          0, 0, size[2] / 2, size[2] / 2, 0, 0, 0, 1])
        base, box_top = 0.1 * size[2], size[2]
    if base > 0:  # the skin up to this height is held
        tool.append((3, occ.addBox(-50, -50, -1, 300, 300, 1 + base)))
    for middle, lump, _ in scene["lumps"]:
        tool.append((3, occ.addSphere(*middle, lump)))
    if scene["layer"]:
        tool.append((3, occ.addBox(0, 0, 0, size[0], size[1], scene["layer"][0])))
    if tool:
        parts, whence = occ.fragment([(3, body)], tool)
        inside = {tag for _, tag in whence[0]}
        for _, tag in parts:
            if tag not in inside:
                occ.remove([(3, tag)], recursive=True)
        tags = sorted(inside)
        of_tool = [{tag for _, tag in one} for one in whence[1:]]
    else:
        tags, of_tool = [body], []
    occ.synchronize()
    contact = math.sqrt(scene["radius"] * scene["travel"])
    fine = contact / per_radius
    largest = min(size) / 2.5
    field = gmsh.model.mesh.field
    distance = f"sqrt((x-{touch[0]})^2+(y-{touch[1]})^2+(z-{touch[2]})^2)"
    size_of = f"({fine} + 0.35 * 0.5 * ({distance} - {1.3 * contact} + abs({distance} - {1.3 * contact})))"
    one = field.add("MathEval")
    field.setString(one, "F", size_of)
    fields = [one]
    for middle, lump, _ in scene["lumps"]:
        around = field.add("Ball")
        for name, value in zip(("XCenter", "YCenter", "ZCenter"), middle):
            field.setNumber(around, name, value)
        field.setNumber(around, "Radius", 1.1 * lump)
        field.setNumber(around, "VIn", lump / 3)
        field.setNumber(around, "VOut", largest)
        fields.append(around)
    if scene["layer"]:
        thin = size[2] - scene["layer"][0]
        near = field.add("MathEval")
        field.setString(near, "F",
                        f"{thin / 2} + 0.25 * {distance}")
        fields.append(near)
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", fields)
    field.setAsBackgroundMesh(least)
    for option, value in (("MeshSizeExtendFromBoundary", 0), ("MeshSizeFromPoints", 0), ("MeshSizeMax", largest),
                          ("ElementOrder", 2), ("HighOrderOptimize", 1), ("SecondOrderLinear", 0)):
        gmsh.option.setNumber("Mesh." + option, value)
    gmsh.model.mesh.generate(3)
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    nodes = {int(n): tuple(coordinates[3 * i:3 * i + 3]) for i, n in enumerate(numbers)}
    elements = []
    for tag in tags:
        stiffness = scene["young"]
        offset = 1 if base > 0 else 0
        for i, (_, _, young) in enumerate(scene["lumps"]):
            if tag in of_tool[offset + i]:
                stiffness = young
        if scene["layer"] and tag in of_tool[-1]:
            stiffness = scene["layer"][1]
        kinds, _, connected = gmsh.model.mesh.getElements(3, tag)
        for kind, flat in zip(kinds, connected):
            assert kind == 11
            for i in range(0, len(flat), 10):
                ten = [int(n) for n in flat[i:i + 10]]
                ten[8], ten[9] = ten[9], ten[8]  # Gmsh's order to CalculiX's
                elements.append((stiffness, ten))
    gmsh.finalize()
    # The ball: a cap of its lower side.
    gmsh.initialize(["", "-v", "0"])
    occ = gmsh.model.occ
    middle = (scene["at"][0], scene["at"][1], ball_height)
    ball = occ.addSphere(*middle, scene["radius"])
    reach = min(1.0, 2.2 * contact / scene["radius"])  # how far round the ball the surface may come
    low = ball_height - scene["radius"] * max(0.2, math.sqrt(max(0.0, 1 - reach ** 2)) - 0.1)
    cap, _ = occ.intersect([(3, ball)], [(3, occ.addBox(middle[0] - 50, middle[1] - 50, ball_height - 100, 100, 100,
                                                        100 - (ball_height - low)))])
    occ.synchronize()
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.SecondOrderLinear", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5 * contact)
    gmsh.model.mesh.generate(3)
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    shift = max(nodes)
    ball_nodes = {int(n) + shift: tuple(coordinates[3 * i:3 * i + 3]) for i, n in enumerate(numbers)}
    ball_elements = []
    for _, tag in cap:
        _, _, connected = gmsh.model.mesh.getElements(3, tag)
        for i in range(0, len(connected[0]), 10):
            ten = [int(n) + shift for n in connected[0][i:i + 10]]
            ten[8], ten[9] = ten[9], ten[8]
            ball_elements.append(ten)
    gmsh.finalize()
    return {"nodes": nodes, "elements": elements, "ball_nodes": ball_nodes, "ball": ball_elements, "touch": touch,
            "contact": contact, "base": base, "middle": middle, "box_top": box_top}


SIDES = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))  # corners of CalculiX's faces S1 to S4


def outer_faces(elements):
    """(element number, side, corners) of faces that one element has."""
    seen = {}
    for number, ten in elements:
        for side, corners in enumerate(SIDES):
            key = tuple(sorted(ten[c] for c in corners))
            seen[key] = None if key in seen else (number, side + 1, [ten[c] for c in corners])
    return [one for one in seen.values() if one]


def deck(scene, made):
    """The input of CalculiX."""
    nodes, contact = made["nodes"], made["contact"]
    used = {n for _, ten in made["elements"] for n in ten}
    lines = ["*NODE, NSET=ALL"]
    for n in sorted(used):
        lines.append(f"{n}, {nodes[n][0]:.9g}, {nodes[n][1]:.9g}, {nodes[n][2]:.9g}")
    lines.append("*NODE, NSET=FINGER")
    ball_used = {n for ten in made["ball"] for n in ten}
    for n in sorted(ball_used):
        place = made["ball_nodes"][n]
        lines.append(f"{n}, {place[0]:.9g}, {place[1]:.9g}, {place[2]:.9g}")
    numbered, number = [], 0
    for i, stiffness in enumerate(sorted({s for s, _ in made["elements"]})):
        lines.append(f"*ELEMENT, TYPE=C3D10, ELSET=T{i}")
        for s, ten in made["elements"]:
            if s == stiffness:
                number += 1
                numbered.append((number, ten))
                lines.append(f"{number}, " + ", ".join(map(str, ten)))
        shear = stiffness / 2 / (1 + scene["nu"])
        bulk = stiffness / 3 / (1 - 2 * scene["nu"])
        lines += [f"*MATERIAL, NAME=M{i}", "*HYPERELASTIC, NEO HOOKE", f"{shear / 2:.12g}, {2 / bulk:.12g}",
                  f"*SOLID SECTION, ELSET=T{i}, MATERIAL=M{i}"]
    lines.append("*ELEMENT, TYPE=C3D10, ELSET=BALL")
    balls = []
    for ten in made["ball"]:
        number += 1
        balls.append((number, ten))
        lines.append(f"{number}, " + ", ".join(map(str, ten)))
    lines += ["*MATERIAL, NAME=RIGID", "*ELASTIC", f"{1e3 * scene['young']:.9g}, 0.3",
              "*SOLID SECTION, ELSET=BALL, MATERIAL=RIGID"]
    lines.append("*SURFACE, NAME=SKIN, TYPE=ELEMENT")
    held = set()
    edge = {}
    for element, side, corners in outer_faces(numbered):
        places = [nodes[n] for n in corners]
        if max(place[2] for place in places) <= made["base"] + 1e-6:
            held.update(corners)
            edge[(element, side)] = corners
        elif min(math.dist(place, made["touch"]) for place in places) < 2.0 * contact and \
                max(place[2] for place in places) > made["touch"][2] - 2.5 * contact:
            lines.append(f"{element}, S{side}")
    tens = dict(numbered)
    middles = ((4, 5, 6), (7, 8, 4), (8, 9, 5), (9, 7, 6))
    for element, side in edge:
        held.update(tens[element][m] for m in middles[side - 1])
    lines.append("*SURFACE, NAME=INDENTER, TYPE=ELEMENT")
    for element, side, corners in outer_faces(balls):
        if all(abs(math.dist(made["ball_nodes"][n], made["middle"]) - scene["radius"]) < 1e-4 * scene["radius"]
               for n in corners):
            lines.append(f"{element}, S{side}")
    lines.append("*NSET, NSET=BASE")
    lines += [str(n) for n in sorted(held)]
    stiff = scene["young"] / (1 - scene["nu"] ** 2) / contact * 400
    lines += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiff:.9g}",
              "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SKIN, INDENTER",
              "*STEP, NLGEOM, INC=200", "*STATIC", "0.34, 1., 1e-4, 0.34", "*BOUNDARY", "BASE, 1, 3, 0.",
              "FINGER, 1, 2, 0.", f"FINGER, 3, 3, {-scene['travel']:.12g}",
              "*NODE PRINT, NSET=BASE, TOTALS=ONLY, FREQUENCY=1000", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def by_calculix(scene, folder, per_radius):
    """Force (N), nodes of the body and processor time (s)."""
    made = mesh(scene, per_radius)
    pathlib.Path(folder, "press.inp").write_text(deck(scene, made), encoding="utf-8")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(folder + "/ccx.log", "w", encoding="utf-8") as log:
        subprocess.run(["ccx", "-i", "press"], cwd=folder, stdout=log, stderr=log, timeout=1500, check=False,
                       env={**os.environ, "OMP_NUM_THREADS": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    text = pathlib.Path(folder, "press.dat").read_text(encoding="utf-8")
    totals = re.findall(r"total force.*?and time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", text, re.DOTALL)
    if not totals or float(totals[-1][0]) < 0.999:
        raise RuntimeError("CalculiX did not reach the end")
    return (abs(float(totals[-1][3])), len(made["nodes"]),
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate")
    parser.add_argument("--seed", type=int, default=None)
    parser.add_argument("--count", type=int, default=len(KINDS))
    parser.add_argument("--kind", choices=KINDS)
    parser.add_argument("--model", default="auto")
    parser.add_argument("--per-radius", type=float, default=3.0)
    parser.add_argument("--keep", help="a folder for the inputs")
    arguments = parser.parse_args()
    seed = arguments.seed if arguments.seed is not None else random.SystemRandom().randrange(1, 10 ** 6)
    rng = random.Random(seed)
    print(f"Seed {seed}.\n\n| scene | CalculiX, mN | palpate, mN | error, % | stated, % | model | nodes of CalculiX | its time, s "
          "| palpate's, s |\n|---|---|---|---|---|---|---|---|---|", flush=True)
    covered = close = count = 0
    for i in range(arguments.count):
        scene = draw(arguments.kind or KINDS[i % len(KINDS)], rng)
        with tempfile.TemporaryDirectory() as folder:
            if arguments.keep:
                folder = os.path.join(arguments.keep, str(i))
                os.makedirs(folder, exist_ok=True)
            try:
                truth, nodes, seconds = by_calculix(scene, folder, arguments.per_radius)
                force, stated, model, own = by_palpate(arguments.palpate, scene, folder,
                                                       ["--set", f"solver.model={arguments.model}"])
            except (RuntimeError, OSError, subprocess.SubprocessError) as error:
                print(f"| {scene['kind']} | none: {error} |", file=sys.stderr, flush=True)
                continue
        error = force / truth - 1
        count, covered, close = count + 1, covered + (abs(error) <= stated + 0.003), close + (abs(error) <= 0.03)
        print(f"| {scene['kind']} | {1e3 * truth:.2f} | {1e3 * force:.2f} | {100 * error:+.2f} | {100 * stated:.1f} | {model} "
              f"| {nodes} | {seconds:.0f} | {own:.1f} |", flush=True)
    print(f"\nOf {count}: {covered} within what is stated and the 0.3 % of CalculiX's own error, {close} within 3 %.")


if __name__ == "__main__":
    main()
