"""The force of a drawn scene by CalculiX on a mesh of Gmsh: a truth in which nothing is palpate's.

Gmsh meshes the body of fresh_scenes.py with ten-node tetrahedra, 2.5 and 3.5 to a contact radius under the finger, and
CalculiX (C3D10, NLGEOM, the neo-Hookean law of docs/theory.md [solid]) presses a rigid ball into it, by a penalty that
lets through some 0.2 % of the travel; an elastic finger is half a ball, moved at its equator and free to spread there.
A viscous hold is the elastic force of its increments and [viscous]. One mesh of C3D10 is 0.3 to 2 % too stiff, most near
nu 1/2 and on thin legs: two are pressed, and what their elements' squared size leaves is taken off, half of it doubted.
"""
import math
import os
import pathlib
import re
import resource
import subprocess

import gmsh

from fresh_scenes import base_of, height, solid_of

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


def mesh(scene, per_radius, finer=1.0):
    """Nodes, elements per tissue, faces of body and ball; by Gmsh. `finer` divides the size of all elements of the body."""
    gmsh.initialize(["", "-v", "0"])
    occ = gmsh.model.occ
    size = scene["size"]
    touch, ball_height = first_touch(scene)
    tool = []
    body, base = solid_of(scene), base_of(scene)
    if base > 0:  # the skin up to this height is held
        tool.append((3, occ.addBox(-300, -300, -1, 600, 600, 1 + base)))
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
    fine = contact / per_radius / finer
    largest = (scene["thin"] / 1.5 if "thin" in scene else min(size) / 2.5) / finer
    field = gmsh.model.mesh.field
    distance = "sqrt(" + "+".join(f"({axis}-({at:.12f}))^2" for axis, at in zip("xyz", touch)) + ")"
    size_of = f"({fine} + {0.35 / finer} * 0.5 * ({distance} - {1.3 * contact} + abs({distance} - {1.3 * contact})))"
    one = field.add("MathEval")
    field.setString(one, "F", size_of)
    fields = [one]
    for middle, lump, _ in scene["lumps"]:
        around = field.add("Ball")
        for name, value in zip(("XCenter", "YCenter", "ZCenter"), middle):
            field.setNumber(around, name, value)
        field.setNumber(around, "Radius", 1.1 * lump)
        field.setNumber(around, "VIn", lump / 3 / finer)
        field.setNumber(around, "VOut", largest)
        fields.append(around)
    if scene["layer"]:
        thin = size[2] - scene["layer"][0]
        near = field.add("MathEval")
        field.setString(near, "F",
                        f"{thin / 2 / finer} + {0.25 / finer} * {distance}")
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
        for i, (_, _, ratio) in enumerate(scene["lumps"]):
            if tag in of_tool[offset + i]:
                stiffness = scene["young"] * ratio
        if scene["layer"] and tag in of_tool[-1]:
            stiffness = scene["young"] * scene["layer"][1]
        kinds, _, connected = gmsh.model.mesh.getElements(3, tag)
        for kind, flat in zip(kinds, connected):
            assert kind == 11
            for i in range(0, len(flat), 10):
                ten = [int(n) for n in flat[i:i + 10]]
                ten[8], ten[9] = ten[9], ten[8]  # Gmsh's order to CalculiX's
                elements.append((stiffness, ten))
    gmsh.finalize()
    # The ball: a cap of its lower side, or half of it.
    gmsh.initialize(["", "-v", "0"])
    occ = gmsh.model.occ
    middle = (scene["at"][0], scene["at"][1], ball_height)
    ball = occ.addSphere(*middle, scene["radius"])
    reach = min(1.0, 2.2 * contact / scene["radius"])  # how far round the ball the surface may come
    low = ball_height - scene["radius"] * max(0.2, math.sqrt(max(0.0, 1 - reach ** 2)) - 0.1)
    if scene["finger"]:
        low = ball_height
    cap, _ = occ.intersect([(3, ball)], [(3, occ.addBox(middle[0] - 50, middle[1] - 50, ball_height - 100, 100, 100,
                                                        100 - (ball_height - low)))])
    occ.synchronize()
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.SecondOrderLinear", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", scene["radius"] / 3 if scene["finger"] else 0.5 * contact)
    if scene["finger"]:
        field = gmsh.model.mesh.field
        one = field.add("MathEval")
        lowest = ball_height - scene["radius"]
        distance = "sqrt(" + "+".join(f"({axis}-({at:.12f}))^2" for axis, at in zip("xyz", (*middle[:2], lowest))) + ")"
        field.setString(one, "F", f"{fine} + 0.35 * 0.5 * ({distance} - {1.3 * contact} + abs({distance} - {1.3 * contact}))")
        field.setAsBackgroundMesh(one)
        for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
            gmsh.option.setNumber("Mesh." + option, 0)
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
            "contact": contact, "base": base, "middle": middle, "low": low}


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
    ball_used = {n for ten in made["ball"] for n in ten}
    lines.append("*NODE, NSET=BALL")
    for n in sorted(ball_used):
        place = made["ball_nodes"][n]
        lines.append(f"{n}, {place[0]:.9g}, {place[1]:.9g}, {place[2]:.9g}")
    moved = sorted(n for n in ball_used if not scene["finger"] or made["ball_nodes"][n][2] > made["low"] - 1e-6)
    lines += ["*NSET, NSET=FINGER", *(str(n) for n in moved)]
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
    lines.append("*MATERIAL, NAME=RIGID")
    if scene["finger"]:
        modulus, ratio = scene["finger"]
        lines += ["*HYPERELASTIC, NEO HOOKE",
                  f"{modulus / 4 / (1 + ratio):.12g}, {6 * (1 - 2 * ratio) / modulus:.12g}"]
    else:
        lines += ["*ELASTIC", f"{1e3 * scene['young']:.9g}, 0.3"]
    lines += ["*SOLID SECTION, ELSET=BALL, MATERIAL=RIGID"]
    lines.append("*SURFACE, NAME=SKIN, TYPE=ELEMENT")
    held = set()
    edge = {}
    number_of = dict(numbered)

    def below(places, ten):
        """Whether a face looks down, as the inside of a hollow body does."""
        a, b = ([p[axis] - places[0][axis] for axis in range(3)] for p in places[1:])
        inner = [sum(nodes[n][axis] for n in ten[:4]) / 4 - places[0][axis] for axis in range(3)]
        normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        outward = -1 if sum(x * y for x, y in zip(normal, inner)) > 0 else 1
        return outward * normal[2] < -0.1 * math.hypot(*normal)
    for element, side, corners in outer_faces(numbered):
        places = [nodes[n] for n in corners]
        if max(place[2] for place in places) <= made["base"] + 1e-6:
            held.update(corners)
            edge[(element, side)] = corners
        elif min(math.dist(place, made["touch"]) for place in places) < 2.0 * contact and \
                max(place[2] for place in places) > made["touch"][2] - 2.5 * contact and not below(places, number_of[element]):
            lines.append(f"{element}, S{side}")
    middles = ((4, 5, 6), (7, 8, 4), (8, 9, 5), (9, 7, 6))
    for element, side in edge:
        held.update(number_of[element][m] for m in middles[side - 1])
    lines.append("*SURFACE, NAME=INDENTER, TYPE=ELEMENT")
    for element, side, corners in outer_faces(balls):
        if all(abs(math.dist(made["ball_nodes"][n], made["middle"]) - scene["radius"]) < 1e-4 * scene["radius"]
               for n in corners):
            lines.append(f"{element}, S{side}")
    lines.append("*NSET, NSET=BASE")
    lines += [str(n) for n in sorted(held)]
    # What slides is kept from turning and moving as a whole by two nodes.
    pins = []
    if scene["base"] == "frictionless":
        pins += [("BASE, 3, 3, 0.",), *pinned(held, nodes)]
    else:
        pins.append(("BASE, 1, 3, 0.",))
    if scene["finger"]:
        pins += pinned(moved, made["ball_nodes"])
    else:
        pins.append(("FINGER, 1, 2, 0.",))
    stiff = scene["young"] / (1 - scene["nu"] ** 2) / contact * 400
    first = 0.2 if scene["viscous"] else 0.34
    lines += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiff:.9g}",
              "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SKIN, INDENTER",
              "*STEP, NLGEOM, INC=200", "*STATIC", f"{first}, 1., 1e-4, {first}", "*BOUNDARY",
              *(line for pin in pins for line in pin), f"FINGER, 3, 3, {-scene['travel']:.12g}",
              "*NODE PRINT, NSET=BASE, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def pinned(numbers, nodes):
    """Two nodes, in the middle and far along x, that hold a body without straining it."""
    centre = [sum(nodes[n][axis] for n in numbers) / len(numbers) for axis in range(2)]
    middle = min(numbers, key=lambda n: math.dist(nodes[n][:2], centre))
    far = max(numbers, key=lambda n: nodes[n][0] - abs(nodes[n][1] - nodes[middle][1]))
    return [(f"{middle}, 1, 2, 0.",), (f"{far}, 2, 2, 0.",)]


def relaxing(scene, forces):
    """Elastic forces at shares of the travel as those of docs/theory.md [viscous]: at the end of the ramp and of the hold."""
    constant, ratio, hold = scene["viscous"]
    ramp, steps = scene["time"], 2000

    def elastic(share):  # times a power of 3/2, between the increments
        for (low, small), (high, large) in zip(forces, forces[1:]):
            if share <= high:
                break
        ends = [force / at ** 1.5 if at > 0 else large / high ** 1.5 for at, force in ((low, small), (high, large))]
        return share ** 1.5 * (ends[0] + (share - low) / (high - low) * (ends[1] - ends[0]))
    found = []
    for end in (ramp, ramp + hold):
        total = before = 0.0
        for k in range(1, steps + 1):
            now = elastic(k / steps)
            ago = end - ramp * (k - 0.5) / steps
            total += (1 + (ratio - 1) * math.exp(-ago / constant)) * (now - before)
            before = now
        found.append(total)
    return found


def by_calculix(scene, folder, per_radius=2.5):
    """(force, its error) in N at the ends of ramp and hold; RuntimeError where CalculiX finds none."""
    penalty = 0.002  # a fraction of the force: what lets the surface through
    finer = 1.4
    coarse, fine = (pressed(scene, mesh(scene, per_radius, size), folder) for size in (1.0, finer))
    left = 1 / (finer ** 2 - 1)
    return [(f - left * (c - f), penalty * f + 0.5 * left * abs(c - f)) for c, f in zip(coarse, fine)]


def pressed(scene, made, folder, seconds=900):
    """Those on a mesh that mesh() has made."""
    pathlib.Path(folder, "press.inp").write_text(deck(scene, made), encoding="utf-8")
    with open(folder / "ccx.log", "w", encoding="utf-8") as log:
        done = subprocess.run(["ccx", "-i", "press"], cwd=folder, stdout=log, stderr=log, check=False,
                              env={**os.environ, "OMP_NUM_THREADS": "1"},
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds)))
    if done.returncode < 0:
        raise RuntimeError("too long")
    text = pathlib.Path(folder, "press.dat").read_text(encoding="utf-8")
    totals = re.findall(r"total force.*?and time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", text, re.DOTALL)
    forces = [(0.0, 0.0)] + [(float(one[0]), abs(float(one[3]))) for one in totals]
    if forces[-1][0] < 0.999:
        raise RuntimeError("CalculiX did not reach the end")
    return relaxing(scene, forces) if scene["viscous"] else [forces[-1][1]]
