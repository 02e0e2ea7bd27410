"""Draws the figures of docs/theory.md: draw.py FOLDER. Curves of whole presses are computed by `palpate`, which has
to be on the path, those of single formulas here, by the equations that the page names."""

import csv
import math
import subprocess
import sys
from pathlib import Path

STYLE = """
.back{fill:#fff} text{fill:#1b1f24;font:14px sans-serif} .axis{stroke:#57606a;fill:none} .grid{stroke:#d8dee4;fill:none}
.line{fill:none;stroke-width:2.2} .soft{fill:#f3d9c9;stroke:none} .thin{stroke:#57606a;fill:none;stroke-width:1} .thin.soft{fill:#f3d9c9} .thin.core{fill:#d9a58a}
.a{stroke:#0b57b7} .b{stroke:#b3261e} .c{stroke:#166a30} .d{stroke:#7a3fd1} .e{stroke:#57606a} .dash{stroke-dasharray:7 5}
text.a,text.b,text.c,text.d,text.e{stroke:none} text.a{fill:#0b57b7} text.b{fill:#b3261e} text.c{fill:#166a30} text.d{fill:#7a3fd1} text.e{fill:#57606a}
.mark{fill:#57606a;stroke:none}
@media (prefers-color-scheme: dark){.back{fill:#14181d} text{fill:#e6edf3} .axis{stroke:#9aa4af} .grid{stroke:#30363d}
.soft,.thin.soft{fill:#4a3529} .thin.core{fill:#7a4a35} .thin{stroke:#9aa4af} .a{stroke:#6cb0ff} .b{stroke:#ff8a80} .c{stroke:#6fdc8c} .d{stroke:#c4a7ff} .e{stroke:#9aa4af}
text.a{fill:#6cb0ff} text.b{fill:#ff8a80} text.c{fill:#6fdc8c} text.d{fill:#c4a7ff} text.e{fill:#9aa4af} .mark{fill:#9aa4af}}
"""
WIDTH, HEIGHT = 760, 380


def number(x):
    return f"{x:.1f}".rstrip("0").rstrip(".")


def text(x, y, words, css="", anchor="start"):
    return f'<text x="{number(x)}" y="{number(y)}" class="{css}" text-anchor="{anchor}">{words}</text>'


def path(points, css):
    return f'<path class="{css}" d="M' + "L".join(f"{number(x)} {number(y)}" for x, y in points) + '"/>'


def save(folder, name, title, parts, height=HEIGHT):
    (folder / f"{name}.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{title}">'
        f"<style>{STYLE}</style>\n" + f'<rect class="back" width="{WIDTH}" height="{height}"/>\n' + "\n".join(parts) + "\n</svg>\n")


class Axes:
    """A frame with ticks: ranges and steps of x and y, their titles, and the room for labels on its right."""

    def __init__(self, x, y, x_title, y_title, room=24):
        self.x, self.y = x, y
        self.left, self.right, self.top, self.bottom = 74, WIDTH - room, 18, HEIGHT - 54
        self.parts = []
        for value in self.steps(x):
            at = self.at(value, y[0])
            self.parts += [path([at, (at[0], self.top)], "grid"), text(at[0], self.bottom + 19, f"{value:.6g}", "", "middle")]
        for value in self.steps(y):
            at = self.at(x[0], value)
            self.parts += [path([at, (self.right, at[1])], "grid"), text(at[0] - 8, at[1] + 5, f"{value:.6g}", "", "end")]
        self.parts.append(path([(self.left, self.top), (self.left, self.bottom), (self.right, self.bottom)], "axis"))
        middle = (self.top + self.bottom) / 2
        self.parts.append(text((self.left + self.right) / 2, HEIGHT - 12, x_title, "", "middle"))
        self.parts.append(f'<text x="18" y="{middle}" text-anchor="middle" transform="rotate(-90 18 {middle})">{y_title}</text>')

    @staticmethod
    def steps(span):
        low, high, step = span
        return [low + step * i for i in range(round((high - low) / step) + 1)]

    def at(self, x, y):
        across = (x - self.x[0]) / (self.x[1] - self.x[0])
        up = (y - self.y[0]) / (self.y[1] - self.y[0])
        return self.left + across * (self.right - self.left), self.bottom - up * (self.bottom - self.top)

    def curve(self, points, css):
        inside = [self.at(x, y) for x, y in points if self.x[0] <= x <= self.x[1] and self.y[0] <= y <= self.y[1]]
        self.parts.append(path(inside, "line " + css))

    def label(self, x, y, words, css, anchor="start"):
        self.parts.append(text(*self.at(x, y), words, css, anchor))


def press(folder, name, tissue, model, to, contact="", steps="", interval="20 ms", solver=""):
    """Rows (travel in mm, contact force in N, time in s) of a press of a rigid finger of 11 mm into tissue of 10 kPa."""
    (folder / f"{name}.toml").write_text(
        f'schema = 1\n[tissue]\nyoung_modulus = "10 kPa"\n{tissue}\n[finger]\nmaterial = "rigid"\n[contact]\n{contact}\n'
        f'[solver]\nmodel = "{model}"\n{solver}\n[output]\nfigures = false\ninterval = "{interval}"\n'
        f'[[step]]\nkind = "indent"\nto = "{to} mm"\nrate = "4 mm/s"\n{steps}')
    subprocess.run(["palpate", "run", str(folder / f"{name}.toml"), "--out", str(folder), "--force", "--quiet"], check=True)
    with open(folder / name / "force_indentation.csv", newline="") as file:
        return [(float(row["travel_mm"]), float(row["contact_force_N"]), float(row["time_s"])) for row in csv.DictReader(file)]


def over_hertz(rows, nu, least):
    """Travel in mm, and the force over [hertz]."""
    return [(d, force / (4 / 3 * 0.01 / (1 - nu * nu) * math.sqrt(11) * d**1.5)) for d, force, _ in rows if d >= least]


def sinking(r, a):
    """[half_space]: displacement of the surface at the distance r over that in the middle."""
    r = abs(r)
    if r <= a:
        return 1 - r * r / (2 * a * a)
    return ((2 * a * a - r * r) * math.asin(a / r) + a * math.sqrt(r * r - a * a)) / (math.pi * a * a)


def contact(folder):
    """To scale, for R_1 = 11 mm and h = 3 mm: [contact_radius], [pressure], [half_space]."""
    radius, depth, scale = 11.0, 3.0, 22.0
    a = math.sqrt(radius * depth)
    top, middle = 140.0, WIDTH / 2
    low = top + scale * depth  # the deepest point
    edge = middle + scale * a
    surface = [(middle + scale * r / 10, top + scale * depth * sinking(r / 10, a)) for r in range(-170, 171)]
    ball = [(middle + scale * radius * math.sin(t / 50), low - scale * radius * (1 - math.cos(t / 50))) for t in range(-53, 54)]
    pressure = [(middle + scale * a * math.sin(t / 50), low + 20 + 90 * math.cos(t / 50)) for t in range(-78, 79)]
    beside = middle + 10 * scale
    parts = [path([*surface, (surface[-1][0], 366), (surface[0][0], 366)], "soft"), path(surface, "line c"), path(ball, "line a"),
             path([(middle - 17 * scale, top), (middle + 17 * scale, top)], "thin dash"), path([*pressure, pressure[0]], "line b"),
             path([(middle, low), (beside + 6, low)], "thin dash"), path([(beside, top), (beside, low)], "thin"),
             path([(edge, top + scale * depth / 2), (edge, 350)], "thin dash"), path([(middle, 344), (edge, 344)], "thin"),
             path([(middle, 338), (middle, 350)], "thin"),
             text(middle, 70, "finger, radius R_1", "a", "middle"), text(20, top - 8, "undeformed surface"),
             text(beside + 8, low - 26, "depth h"), text(20, top + 64, "displacement of the surface u(r)", "c"),
             text(middle, low + 50, "pressure P(r), contact force F", "b", "middle"),
             text((middle + edge) / 2, 337, "contact radius a", "", "middle")]
    save(folder, "contact", "A sphere on soft tissue: depth, contact radius, pressure, displacement of the surface", parts)


def layers(folder):
    """The force of the exact layer of 3 mm over that of a half-space."""
    axes = Axes((0, 1.4, 0.2), (0, 9, 1), "√(R h) over the thickness of the layer", "force over Hertz's force", 190)
    for name, css, nu, base in (("nu049", "b", 0.49, "bonded"), ("nu045", "a", 0.45, "bonded"), ("nu03", "c", 0.3, "bonded"), ("slip", "d", 0.45, "frictionless")):
        rows = press(folder, name, f'poisson_ratio = {nu}\nbase = "{base}"\nshape = {{ kind = "cuboid", size = ["400 mm", "400 mm", "3 mm"] }}',
                     "layer", 1.6, 'depth = "hertz"', interval="2 ms")
        points = [(math.sqrt(11 * d) / 3, ratio) for d, ratio in over_hertz(rows, nu, 0.01)]
        axes.curve([(0, 1), *points], css)
        axes.label(1.42, [ratio for x, ratio in points if x <= 1.4][-1] - 0.15, f"nu {nu}, {base}", css)
    axes.curve([(0, 1), (1.4, 1)], "e dash")
    axes.label(1.42, 0.85, "half-space", "e")
    save(folder, "layers", "Force on a layer of finite thickness over the force on a half-space", axes.parts)


def coupling(folder):
    """The split of a bonded layer, H = 10 mm, nu = 0.45, a = 3 mm: [half_space] + rest = body, by [layer_surface]."""
    thickness, nu, a = 10.0, 0.45, 3.0
    k = 3 - 4 * nu

    def missing(u):  # M(u) = 1 - L(u) of [layer_waves]
        if u > 20:
            return 0.0
        return 1 - (2 * k * math.sinh(2 * u) - 4 * u) / (2 * k * math.cosh(2 * u) + 1 + k * k + 4 * u * u)

    def bessel(x, n=48):
        return sum(math.cos(x * math.sin(math.pi * (i + 0.5) / n)) for i in range(n)) / n

    waves = [(i + 0.5) * 0.05 for i in range(300)]
    weights = [missing(u) * 0.05 for u in waves]

    def rest(r):
        return -sum(w * bessel(u * r / thickness) for u, w in zip(waves, weights)) / thickness

    axes = Axes((-20, 20, 5), (-0.4, 1, 0.2), "distance from the middle of the contact, mm", "displacement over that of U in the middle")
    unit = 3 * math.pi / (4 * a)
    spots = [i / 10 for i in range(-200, 201)]
    small = {r: rest(r) / unit for r in spots}
    axes.curve([(r, sinking(r, a)) for r in spots], "a")
    axes.curve([(r, small[r]) for r in spots], "b")
    axes.curve([(r, sinking(r, a) + small[r]) for r in spots], "c")
    axes.curve([(-20, 0), (20, 0)], "e")
    for r in range(-20, 21, 5):
        x, y = axes.at(r, small[r])
        axes.parts.append(f'<circle class="mark" cx="{number(x)}" cy="{number(y)}" r="4"/>')
    axes.label(3, 0.72, "U: half-space, a closed form", "a")
    axes.label(5.5, -0.31, "w: the rest; dots: nodes of a mesh", "b")
    axes.label(-4.6, 0.42, "U + w: the body", "c", "end")
    save(folder, "coupling", "The displacement of a layer's surface is that of a half-space plus a smooth rest", axes.parts)


def solid(folder):
    """Large strains, on two meshes, beside small ones. `solid` computes presses from a quarter of the deepest on."""
    axes = Axes((0, 0.8, 0.1), (0.7, 1.3, 0.1), "depth over radius of the finger, h / R", "force over Hertz's force on a flat")
    for name, shape in (("block", 'kind = "cuboid", size = ["80 mm", "80 mm", "40 mm"]'), ("ball", 'kind = "ellipsoid", size = ["80 mm", "80 mm", "80 mm"]')):
        tissue = f"poisson_ratio = 0.45\nshape = {{ {shape} }}"
        large = over_hertz(press(folder, name + "_solid", tissue, "solid", 8.8, solver="tolerance = 0.01"), 0.45, 2.2)
        small = over_hertz(press(folder, name + "_springs", tissue, "coupled_springs", 8.8, 'depth = "hertz"'), 0.45, 0.4)
        axes.curve([(d / 11, ratio) for d, ratio in large], "a")
        axes.curve([(d / 11, ratio) for d, ratio in small], "b dash")
    axes.label(0.52, 1.23, "small strains", "b", "end")
    axes.label(0.78, 1.13, "large strains: block of 80 x 80 x 40 mm", "a", "end")
    axes.label(0.52, 0.835, "small strains", "b", "end")
    axes.label(0.56, 0.735, "large strains: ball of 80 mm", "a", "end")
    save(folder, "solid", "Force by large and by small strains against depth", axes.parts)


def mesh(folder):
    """The section of a solid's mesh through the finger and an inclusion: the triangles on its plane of symmetry."""
    scene = folder / "mesh.toml"
    scene.write_text(
        'schema = 1\n[tissue]\nmaterial = "muscle"\nshape = { size = ["60 mm", "40 mm", "26 mm"] }\n'
        '[[region]]\nkind = "sphere"\ncentre = ["38 mm", "20 mm", "16 mm"]\nradius = "5 mm"\nmaterial = "ligament"\n'
        '[finger]\nmaterial = "rigid"\nradius = "8 mm"\n[solver]\nmodel = "solid"\n'
        '[[step]]\nkind = "indent"\nto = "2 mm"\nrate = "2 mm/s"\n')
    node = folder / "mesh.node"
    subprocess.run(["palpate", "convert", scene, "--out", node, "--force"], check=True, capture_output=True)
    rows = [line.split() for line in node.read_text().splitlines()[1:] if line and line[0] != "#"]
    places = {row[0]: [1e3 * float(x) for x in row[1:4]] for row in rows if len(row) > 3}
    cells = [line.split() for line in node.with_suffix(".ele").read_text().splitlines()[1:] if line and line[0] != "#"]
    scale, left, floor = 10.0, 80, 350

    def at(x, z):
        return left + scale * x, floor - scale * z

    parts = []
    for row in cells:
        corners = [places[name] for name in row[1:5]]
        flat = [corner for corner in corners if abs(corner[1] - 20.0) < 1e-6]
        if len(flat) != 3:
            continue
        inside = all(math.dist(corner, (38, 20, 16)) < 5.01 for corner in flat)
        points = [at(corner[0], corner[2]) for corner in flat]
        parts.append(path(points + points[:1], "thin core" if inside else "thin soft"))
    ball = [at(30 + 8 * math.sin(i / 40), 34 - 8 * math.cos(i / 40)) for i in range(-50, 51)]
    parts.append(path(ball, "line a"))
    parts += [text(*at(39, 29), "finger, radius 8 mm", "a"), text(*at(0, -2.2), "muscle, 60 x 40 x 26 mm, and a ball of ligament")]
    save(folder, "mesh", "Section of a mesh of the solid under the finger", parts)


def viscosity(folder):
    """A press, hold and retract on a half-space with E_0 = 2 E_inf and tau = 0.3 s."""
    steps = '[[step]]\nkind = "hold"\ntime = "1 s"\n[[step]]\nkind = "retract"\nrate = "4 mm/s"'
    tissue = 'poisson_ratio = 0.45\nshape = { kind = "half_space" }\n'
    law = 'viscosity = "standard_linear_solid"\nrelaxation_time = "0.3 s"\ninstantaneous_ratio = 2'
    elastic = press(folder, "elastic", tissue, "hertz", 2, 'depth = "hertz"', steps, "5 ms")
    viscous = press(folder, "viscous", tissue + law, "hertz", 2, 'viscosity = "tissue"\ndepth = "hertz"', steps, "5 ms")
    axes = Axes((0, 2, 0.25), (0, 0.35, 0.05), "time, s", "force, N")
    axes.curve([(t, 2 * force) for _, force, t in elastic], "e dash")
    axes.curve([(t, force) for _, force, t in elastic], "c dash")
    axes.curve([(t, force) for _, force, t in viscous], "a")
    axes.label(1, 0.322, "elastic, E_0", "e", "middle")
    axes.label(1, 0.138, "elastic, E_inf", "c", "middle")
    axes.label(0.72, 0.21, "relaxing tissue", "a")
    axes.label(1.78, 0.012, "contact ends", "a", "end")
    save(folder, "viscosity", "Force of a press, hold and retract on tissue that relaxes", axes.parts)


def time(folder):
    """What one step makes of the amplitude of an undamped mode: [explicit_limit], [implicit], [modes], [tr_bdf2]."""
    gamma = 2 - math.sqrt(2)
    a = gamma / 2

    def tr_bdf2(x):
        z = complex(0, x)
        return abs((1 + math.sqrt(2) * a * z) / (1 - a * z) ** 2)

    def central(x):
        half = 1 - x * x / 2
        return 1.0 if x <= 2 else -half + math.sqrt(half * half - 1)

    axes = Axes((0, 5, 1), (0, 1.4, 0.2), "time step times circular frequency, ω dt", "amplitude after a step over that before")
    grid = [i * 0.01 for i in range(0, 501)]
    axes.curve([(x, central(x)) for x in grid], "b")
    axes.curve([(x, 1.0) for x in grid], "d dash")
    axes.curve([(x, tr_bdf2(x)) for x in grid], "a")
    axes.curve([(x, 1 / math.sqrt(1 + x * x)) for x in grid], "c")
    axes.label(2.1, 1.28, "central differences: unstable beyond 2", "b")
    axes.label(4.95, 1.05, "modal steps: exact", "d", "end")
    axes.label(3.0, 0.83, "TR-BDF2: second order", "a", "end")
    axes.label(4.95, 0.34, "backward differences: first order", "c", "end")
    save(folder, "time", "Amplification of a mode by one step of each method", axes.parts)


if __name__ == "__main__":
    out = Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    for draw in (contact, layers, coupling, mesh, solid, viscosity, time):
        draw(out)
