"""Scenes drawn at random, as `palpate` reads them and as Gmsh meshes them: for fresh.py and calculix.py.

A scene is a dictionary of lengths in mm and moduli in MPa. Bodies of `files` are made by Gmsh too and written as
surfaces of triangles; all others are palpate's own shapes.
"""
import math
import random

import gmsh

KINDS = ("block", "edge", "corner", "cylinder or ellipsoid", "cylinder's end", "convex file", "concave file",
         "hollow file", "stiff inclusion", "soft inclusion", "two inclusions", "soft on stiff", "stiff on soft", "deep",
         "elastic finger", "several spheres", "viscous hold", "tap")
NOT_FOR_CALCULIX = ("several spheres", "tap")
FACET = 2.2  # mm, edges of the triangles of files


def block(rng, radius, least=1.2, most=3.0):
    size = (rng.uniform(4.5, 7) * radius, rng.uniform(4.5, 7) * radius, rng.uniform(least, most) * radius)
    return {"body": "cuboid", "size": size, "at": tuple(rng.uniform(0.38, 0.62) * s for s in size[:2])}


def rounded(rng, radius):
    if rng.random() < 0.5:
        across, along = rng.uniform(1.6, 3.2) * radius, rng.uniform(5, 8) * radius
        return {"body": "cylinder", "size": (across, along),
                "at": (across * rng.uniform(0.85, 1.15), along * rng.uniform(0.35, 0.65))}
    size = tuple(rng.uniform(*ends) * radius for ends in ((5, 8), (5, 8), (3, 6)))
    return {"body": "ellipsoid", "size": size, "at": tuple(rng.uniform(0.38, 0.62) * s for s in size[:2])}


def convex(rng, radius):
    body = rng.choice(("dome", "wedge", "frustum"))
    u = rng.uniform
    if body == "dome":  # half axes and height
        size = (u(2.5, 4) * radius, u(2.5, 4) * radius, u(1.5, 3) * radius)
        return {"body": body, "size": size, "at": (u(-0.3, 0.3) * size[0], u(-0.3, 0.3) * size[1])}
    if body == "wedge":  # a block whose top rises along x
        size = (u(4.5, 7) * radius, u(4.5, 7) * radius, u(1.5, 3) * radius)
        return {"body": body, "size": size, "slope": u(0.05, 0.22),
                "at": (u(0.4, 0.6) * size[0], u(0.4, 0.6) * size[1])}
    size = (u(3, 4.5) * radius, u(1.2, 2.5) * radius, u(1.2, 2.5) * radius)  # radii below and above, height
    return {"body": body, "size": size, "at": (u(-0.5, 0.5) * size[1], u(-0.2, 0.2) * size[1])}


def concave(rng, radius):
    size = (rng.uniform(5, 7) * radius, rng.uniform(5, 7) * radius, rng.uniform(1.8, 3) * radius)
    body = rng.choice(("groove", "dish"))
    hollow = rng.uniform(1.8, 3.5) * radius  # its radius
    return {"body": body, "size": size, "hollow": hollow, "depth": rng.uniform(0.08, 0.16) * hollow,
            "at": (size[0] / 2 + rng.uniform(-0.2, 0.2) * radius, size[1] / 2 + rng.uniform(-0.2, 0.2) * radius)}


def hollow(rng, radius):
    body = rng.choice(("shell", "table", "arch", "tube"))
    u = rng.uniform
    if body == "shell":  # radius and wall
        size = (u(2, 3.5) * radius, u(0.8, 1.5) * radius)
        return {"body": body, "size": size, "thin": size[1], "at": (u(-0.15, 0.15) * size[0], u(-0.15, 0.15) * size[0])}
    if body == "tube":  # radius, wall and length
        size = (u(2, 3) * radius, u(0.8, 1.5) * radius, u(4, 6) * radius)
        return {"body": body, "size": size, "thin": size[1],
                "at": (u(-0.15, 0.15) * size[0], u(0.35, 0.65) * size[2])}
    size = (u(4.5, 6.5) * radius, u(4, 6) * radius, u(2, 3.2) * radius)
    thin = u(0.8, 1.4) * radius  # what is left above the hollow
    return {"body": body, "size": size, "thin": thin, "at": (u(0.42, 0.58) * size[0], u(0.42, 0.58) * size[1])}


def stack(rng, radius, soft_above):
    made = block(rng, radius, 1.5, 3)
    thick = rng.uniform(0.3, 1.0) * radius if soft_above else rng.uniform(0.15, 0.5) * radius
    ratio = rng.uniform(2.5, 12)
    return made | {"layer": [made["size"][2] - thick, ratio if soft_above else 1 / ratio]}


def lumps(rng, radius, kind):
    made = block(rng, radius, 2, 3.2)
    made["lumps"] = []
    sides = (-1, 1) if kind == "two inclusions" else (1,)
    for side in sides:
        lump = rng.uniform(0.3, 0.5) * radius
        x = made["at"][0] + (side * (lump + rng.uniform(0.08, 0.4) * radius) if len(sides) > 1
                             else rng.uniform(-0.5, 0.5) * radius)
        middle = (x, made["at"][1] + rng.uniform(-0.4, 0.4) * radius,
                  made["size"][2] - lump - rng.uniform(0.2, 0.6) * radius)
        made["lumps"].append([middle, lump, rng.uniform(0.1, 0.5) if kind == "soft inclusion" else rng.uniform(3, 15)])
    return made


def draw(seed, number):
    """Scene `number` of a seed: kinds take turns."""
    rng = random.Random(f"{seed} {number}")
    kind = KINDS[number % len(KINDS)]
    radius = rng.uniform(6, 12)
    travel = rng.uniform(0.04, 0.16) * radius
    contact = math.sqrt(radius * travel)
    if kind in ("cylinder or ellipsoid", "convex file", "concave file", "hollow file"):
        scene = {"cylinder or ellipsoid": rounded, "convex file": convex, "concave file": concave,
                 "hollow file": hollow}[kind](rng, radius)
    elif kind == "cylinder's end":
        across = rng.uniform(1.6, 3) * radius
        scene = {"body": "cylinder", "size": (across, rng.uniform(5, 8) * radius),
                 "at": (across, rng.uniform(0.7, 2.0) * contact)}
    elif "inclusion" in kind:
        scene = lumps(rng, radius, kind)
    elif " on " in kind:
        scene = stack(rng, radius, kind == "soft on stiff")
    elif kind == "deep":
        travel = rng.uniform(0.25, 0.5) * radius
        scene = rng.choice((lambda: block(rng, radius), lambda: rounded(rng, radius),
                            lambda: stack(rng, radius, True), lambda: stack(rng, radius, False),
                            lambda: convex(rng, radius)))()
    elif kind in ("viscous hold", "tap", "elastic finger"):
        scene = rng.choice((block, rounded))(rng, radius)
        if kind == "elastic finger":  # pressed at the top, so that nothing turns the ball
            size = scene["size"]
            scene["at"] = (size[0], size[1] / 2) if scene["body"] == "cylinder" else (size[0] / 2, size[1] / 2)
    else:
        scene = block(rng, radius, 0.5, 3)
    if kind in ("edge", "corner"):
        axis = rng.randrange(2)
        at = list(scene["at"])
        at[axis] = rng.uniform(0.6, 2.0) * contact
        if kind == "corner":
            at[1 - axis] = rng.uniform(0.6, 2.0) * contact
        scene["at"] = tuple(at)
    scene = {"lumps": [], "layer": None} | scene
    scene |= {"kind": kind, "radius": radius, "travel": travel, "young": rng.uniform(5, 60) * 1e-3,
              "nu": rng.uniform(0.2, 0.47), "finger": None, "spheres": 1, "viscous": None, "time": travel,
              "base": "frictionless" if kind == "block" and rng.random() < 0.3 else "bonded"}
    if kind == "elastic finger":
        scene["finger"] = [scene["young"] * 10 ** rng.uniform(-0.3, 2.5), rng.uniform(0.3, 0.47)]
    if kind == "several spheres":
        scene["spheres"] = rng.randint(2, 4)
    if kind == "viscous hold":  # time constant, instantaneous over relaxed modulus, hold
        scene["time"] = rng.uniform(0.2, 2)
        scene["viscous"] = [scene["time"] * 10 ** rng.uniform(-1, 1), rng.uniform(1.2, 4), rng.uniform(0.3, 2)]
    if kind == "tap":
        scene["time"] = travel / rng.uniform(60, 400)
    return scene


def text_of(scene):
    """The scenario; files are in body.off beside it."""
    def mm(values):
        return "[" + ", ".join(f'"{value!r} mm"' for value in values) + "]"
    body = scene["body"]
    shape = {"cuboid": f'size = {mm(scene["size"])}',
             "cylinder": f'kind = "cylinder", radius = "{scene["size"][0]!r} mm", length = "{scene["size"][1]!r} mm"',
             "ellipsoid": f'kind = "ellipsoid", size = {mm(scene["size"])}'
             }.get(body, 'kind = "file", file = "body.off", unit = "mm"')
    lines = ["schema = 1", "[tissue]", 'material = "skin"', f'young_modulus = "{1e3 * scene["young"]!r} kPa"',
             f'poisson_ratio = {scene["nu"]!r}', f'base = "{scene["base"]}"', f"shape = {{ {shape} }}"]
    if scene["viscous"]:
        lines += ['viscosity = "standard_linear_solid"', f'relaxation_time = "{scene["viscous"][0]!r} s"',
                  f'instantaneous_ratio = {scene["viscous"][1]!r}']
    else:
        lines.append('viscosity = "none"')

    def tissue(ratio):
        return ['material = "skin"', f'young_modulus = "{1e3 * scene["young"] * ratio!r} kPa"',
                f'poisson_ratio = {scene["nu"]!r}']
    for middle, lump, ratio in scene["lumps"]:
        lines += ["[[region]]", 'kind = "sphere"', f"centre = {mm(middle)}", f'radius = "{lump!r} mm"', *tissue(ratio)]
    if scene["layer"]:
        top, ratio = scene["layer"]
        lines += ["[[region]]", 'kind = "slab"', 'bottom = "0 mm"', f'top = "{top!r} mm"', *tissue(ratio)]
    lines += ["[finger]", f'radius = "{scene["radius"]!r} mm"', f'x = "{scene["at"][0]!r} mm"',
              f'y = "{scene["at"][1]!r} mm"']
    if scene["spheres"] > 1:  # by mass, because otherwise they stand for one, and nothing else knows their force
        lines += [f'spheres = {scene["spheres"]}', 'calibration = "mass"']
    if scene["finger"]:
        lines += ['material = "skin"', f'young_modulus = "{1e3 * scene["finger"][0]!r} kPa"',
                  f'poisson_ratio = {scene["finger"][1]!r}']
    else:
        lines.append('material = "rigid"')
    time = scene["time"]
    lines += ["[[step]]", 'kind = "indent"', f'to = "{scene["travel"]!r} mm"', f'rate = "{scene["travel"] / time!r} mm/s"']
    if scene["viscous"]:
        lines += ["[[step]]", 'kind = "hold"', f'time = "{scene["viscous"][2]!r} s"']
        time += scene["viscous"][2]
    lines += ["[output]", f'interval = "{time / 60!r} s"', "pressure_maps = false", "fits = false",
              "figures = false", "report = false"]
    return "\n".join(lines) + "\n"


def solid_of(scene):
    """The body in Gmsh's kernel: its volume."""
    occ, body, size = gmsh.model.occ, scene["body"], scene["size"]
    if body == "cuboid":
        return occ.addBox(0, 0, 0, *size)
    if body == "cylinder":
        return occ.addCylinder(size[0], 0, size[0], 0, size[1], 0, size[0])
    if body == "frustum":
        return occ.addCone(0, 0, 0, 0, 0, size[2], size[0], size[1])
    if body in ("ellipsoid", "dome"):
        ball = occ.addSphere(0, 0, 0, 1)
        if body == "dome":
            ball = occ.intersect([(3, ball)], [(3, occ.addBox(-2, -2, 0, 4, 4, 2))])[0][0][1]
            half, middle = size, (0, 0, 0)
        else:
            half = middle = tuple(s / 2 for s in size)
        occ.affineTransform([(3, ball)], [half[0], 0, 0, middle[0], 0, half[1], 0, middle[1],
                                          0, 0, half[2], middle[2], 0, 0, 0, 1])
        return ball
    if body == "wedge":
        rise = scene["slope"] * size[0] / 2
        corners = [(0, 0), (size[0], 0), (size[0], size[2] + rise), (0, size[2] - rise)]
        points = [occ.addPoint(x, 0, z) for x, z in corners]
        edges = [occ.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
        face = occ.addPlaneSurface([occ.addCurveLoop(edges)])
        return next(tag for dim, tag in occ.extrude([(2, face)], 0, size[1], 0) if dim == 3)
    if body in ("shell", "tube"):
        outer, wall = size[:2]
        if body == "shell":  # open below
            parts = [occ.addSphere(0, 0, 0, r, angle1=0) for r in (outer, outer - wall)]
        else:
            parts = [occ.addCylinder(0, 0, outer, 0, size[2], 0, r) for r in (outer, outer - wall)]
        return occ.cut([(3, parts[0])], [(3, parts[1])])[0][0][1]
    box = occ.addBox(0, 0, 0, *size)
    if body == "groove":
        axis = size[2] + scene["hollow"] - scene["depth"]
        tool = [occ.addCylinder(size[0] / 2, -1, axis, 0, size[1] + 2, 0, scene["hollow"])]
    elif body == "dish":
        tool = [occ.addSphere(size[0] / 2, size[1] / 2, size[2] + scene["hollow"] - scene["depth"], scene["hollow"])]
    elif body == "arch":
        tool = [occ.addCylinder(size[0] / 2, -1, 0, 0, size[1] + 2, 0, size[2] - scene["thin"])]
    else:  # a table: four legs of a quarter of its width
        below = size[2] - scene["thin"]
        tool = [occ.addBox(size[0] / 4, -1, -1, size[0] / 2, size[1] + 2, below + 1),
                occ.addBox(-1, size[1] / 4, -1, size[0] + 2, size[1] / 2, below + 1)]
    return occ.cut([(3, box)], [(3, one) for one in tool])[0][0][1]


def height(scene, x, y):
    """Of the top of the body, mm; -inf beside it."""
    size, body = scene["size"], scene["body"]
    if body in ("cylinder", "tube"):
        middle, length = (size[0], size[1]) if body == "cylinder" else (0, size[2])
        inside = size[0] ** 2 - (x - middle) ** 2
        return size[0] + math.sqrt(inside) if inside >= 0 and 0 <= y <= length else -math.inf
    if body == "ellipsoid":
        inside = 1 - (2 * x / size[0] - 1) ** 2 - (2 * y / size[1] - 1) ** 2
        return size[2] / 2 * (1 + math.sqrt(inside)) if inside >= 0 else -math.inf
    if body == "dome":
        inside = 1 - (x / size[0]) ** 2 - (y / size[1]) ** 2
        return size[2] * math.sqrt(inside) if inside >= 0 else -math.inf
    if body == "shell":
        inside = size[0] ** 2 - x * x - y * y
        return math.sqrt(inside) if inside >= 0 else -math.inf
    if body == "frustum":
        away = math.hypot(x, y)
        if away > size[0]:
            return -math.inf
        return size[2] * min(1.0, (size[0] - away) / (size[0] - size[1]))
    if not (0 <= x <= size[0] and 0 <= y <= size[1]):
        return -math.inf
    if body == "wedge":
        return size[2] + scene["slope"] * (x - size[0] / 2)
    if body in ("groove", "dish"):
        away = math.hypot(x - size[0] / 2, y - size[1] / 2 if body == "dish" else 0)
        if away < scene["hollow"]:
            return min(size[2], size[2] + scene["hollow"] - scene["depth"] - math.sqrt(scene["hollow"] ** 2 - away ** 2))
    return size[2]


def base_of(scene):
    """The skin up to this height (mm) is held: a flat underside, or the lowest tenth."""
    tall = {"cylinder": 2 * scene["size"][0], "tube": 2 * scene["size"][0],
            "ellipsoid": scene["size"][-1]}
    return 0.1 * tall.get(scene["body"], 0.0)


def is_file(scene):
    return scene["body"] not in ("cuboid", "cylinder", "ellipsoid")


def write(scene, folder):
    """scene.toml, and body.off where the body is a file."""
    (folder / "scene.toml").write_text(text_of(scene), encoding="utf-8")
    if not is_file(scene):
        return
    gmsh.initialize(["", "-v", "0"])
    body = solid_of(scene)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", FACET)
    gmsh.option.setNumber("Mesh.MeshSizeMin", FACET)
    gmsh.model.mesh.generate(2)
    places, triangles = {}, []
    for dim, signed in gmsh.model.getBoundary([(3, body)], oriented=True):
        _, _, nodes = gmsh.model.mesh.getElements(dim, abs(signed))
        flat = [int(n) for n in nodes[0]]
        for i in range(0, len(flat), 3):
            triangles.append(flat[i:i + 3] if signed > 0 else flat[i:i + 3][::-1])
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    every = {int(n): coordinates[3 * i:3 * i + 3] for i, n in enumerate(numbers)}
    for triangle in triangles:
        for n in triangle:
            places.setdefault(n, len(places))
    gmsh.finalize()
    with open(folder / "body.off", "w", encoding="utf-8") as file:
        file.write(f"OFF\n{len(places)} {len(triangles)} 0\n")
        for n in places:
            file.write("%.9g %.9g %.9g\n" % tuple(every[n]))
        for triangle in triangles:
            file.write("3 %d %d %d\n" % tuple(places[n] for n in triangle))
