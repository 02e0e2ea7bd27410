#!/usr/bin/env python3
"""Counts what palpate states of fast presses, in which waves bear a part of the force, on scenes that nobody chose.

    fast_presses.py PALPATE RESULTS.csv [--seed N] [--scenes N] [-- KEY=VALUE ...]

Discs and wide cuboids are pressed at a constant rate from rest; the force at the end is compared. The truth is
../elasticity/axisymmetric.py, a program that shares nothing with palpate, with inertia in implicit steps by the method
of Hilber, Hughes and Taylor (1977); a square cuboid is the disc of the same section. Scenes are drawn so that the
radiation of [estimates] adds 5 to 100 % to Hertz's force. Settings after `--` are given to every run. Without --seed
the draw is new; a stopped run goes on. It needs NumPy and SciPy (python3-scipy).
"""
import argparse
import csv
import math
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "elasticity"))
from axisymmetric import POINTS, Solid
from axisymmetric_mesh import disc, quadratic

NAMES = ["scene", "body", "model", "nodes", "inertia", "depth_over_radius", "force_mN", "truth_mN", "doubt_mN", "stated"]

SCENARIO = """schema = 1
[tissue]
material = "skin"
young_modulus = "{youngs:.6g} kPa"
poisson_ratio = {poisson:.4g}
density = "{density:.6g} kg/m^3"
viscosity = "none"
{body}
[finger]
material = "rigid"
radius = "{radius:.6g} mm"
[output]
interval = "{interval:.9g} s"
pressure_maps = false
fits = false
figures = false
report = false
[[step]]
kind = "indent"
to = "{depth:.6g} mm"
rate = "{rate:.9g} mm/s"
"""


def draw(generator):
    """A scene in mm, kPa, kg/m^3 and mm/s."""
    scene = {"youngs": 5.0 * 12.0 ** generator.random(), "poisson": generator.uniform(0.3, 0.47),
             "density": generator.uniform(1000.0, 1200.0), "radius": generator.uniform(5.0, 15.0),
             "height": generator.uniform(12.0, 35.0)}
    scene["depth"] = scene["radius"] * generator.uniform(0.03, 0.18)
    contact = math.sqrt(scene["radius"] * scene["depth"])
    scene["round"] = max(3.0 * contact, scene["height"] * generator.uniform(0.8, 1.6))
    scene["kind"] = generator.choice(["disc", "cuboid"])
    if scene["kind"] == "cuboid":
        scene["round"] = max(scene["round"], 1.3 * scene["height"])
    scene["inertia"] = 0.05 * 20.0 ** generator.random()
    # The rate by inertia = pi a^2 rho c v / F_Hertz, c = 3.4 v_s / (pi (1 - nu)).
    nu = scene["poisson"]
    shear = math.sqrt(1e3 * scene["youngs"] / (2.0 * (1.0 + nu) * scene["density"]))
    hertz = 4.0 / 3.0 * 1e3 * scene["youngs"] / (1.0 - nu ** 2) * 1e-6 * math.sqrt(scene["radius"]) * scene["depth"] ** 1.5
    radiation = math.pi * 1e-6 * contact ** 2 * scene["density"] * 3.4 * shear / (math.pi * (1.0 - nu))
    scene["rate"] = 1e3 * scene["inertia"] * hertz / radiation
    return scene


def masses_of(solid, density):
    """The elements' mass matrices, consistent."""
    masses = np.zeros((len(solid.dofs), 18, 18))
    point = 0
    for along in POINTS:
        for up in POINTS:
            shape = np.outer(quadratic(up)[0], quadratic(along)[0]).ravel()
            part = density * solid.weight[:, point, None, None] * np.outer(shape, shape)
            masses[:, 0::2, 0::2] += part
            masses[:, 1::2, 1::2] += part
            point += 1
    return masses


def press_with_inertia(scene, elements, steps, alpha=-0.1):
    """The force in mN at the end of the press, with `elements` along the contact's radius."""
    contact = math.sqrt(scene["radius"] * scene["depth"])
    mesh = disc(scene["round"], [scene["height"]], 1.3 * contact, elements)
    solid = Solid(mesh, scene["youngs"], scene["poisson"])
    masses = masses_of(solid, 1e-9 * scene["density"])  # kg/mm^3, with forces in mN and times in s
    beta, gamma = 0.25 * (1.0 - alpha) ** 2, 0.5 - alpha
    span = scene["depth"] / scene["rate"] / steps
    u = np.zeros(solid.unknowns)
    speed, acceleration, before = u.copy(), u.copy(), u.copy()
    for step in range(1, steps + 1):
        depth = step * scene["depth"] / steps
        free = u + span * speed + span ** 2 * (0.5 - beta) * acceleration
        for start in (u + span * speed, u):
            new = newton(solid, scene["radius"], depth, start, free, masses, beta * span ** 2, alpha, before)
            if new is not None:
                break
        else:
            raise RuntimeError("no equilibrium in a step")
        touch = solid.touch(new, scene["radius"], depth, "normal")
        now = (new - free) / (beta * span ** 2)
        speed = speed + span * ((1.0 - gamma) * acceleration + gamma * now)
        u, acceleration, before = new, now, solid.tangent(new).force + touch.load
    return touch.force


def newton(solid, radius, depth, u, free, masses, square, alpha, before):
    """The displacements at the end of a step, or None."""
    for _ in range(40):
        state = solid.tangent(u)
        if state.force is None:
            return None
        touch = solid.touch(u, radius, depth, "normal")
        inertia = (masses @ ((u - free) / square)[solid.dofs][:, :, None]).ravel()
        rest = np.bincount(solid.dofs.ravel(), inertia, solid.unknowns) \
            + (1.0 + alpha) * (state.force + touch.load) - alpha * before
        factored = solid.factor((1.0 + alpha) * state.stiffness + masses / square,
                                (1.0 + alpha) * touch.stiffness)
        change = solid.solve(factored, -np.where(solid.held, 0.0, rest))
        u = u + change
        if np.abs(change).max() < 1e-7 * radius:
            return u
    return None


def truth_of(scene):
    """Force and its doubt, mN: two meshes with two steps, and the section of a cuboid."""
    disc_like = dict(scene)
    if scene["kind"] == "cuboid":
        disc_like["round"] = 2.0 * scene["round"] / math.sqrt(math.pi)
    coarse = press_with_inertia(disc_like, 14, 60)
    fine = press_with_inertia(disc_like, 22, 110)
    return fine, abs(fine - coarse) + (0.003 if scene["kind"] == "disc" else 0.01) * fine


def answer_of(palpate, scene, settings):
    """What palpate finds and states: a row of findings.csv."""
    wide = scene["round"]
    body = (f'shape = {{ kind = "disc", radius = "{wide:.6g} mm", height = "{scene["height"]:.6g} mm" }}'
            if scene["kind"] == "disc" else
            f'shape = {{ kind = "cuboid", size = ["{2 * wide:.6g} mm", "{2 * wide:.6g} mm", "{scene["height"]:.6g} mm"] }}')
    with tempfile.TemporaryDirectory() as folder:
        text = SCENARIO.format(body=body, interval=scene["depth"] / scene["rate"] / 40.0, **scene)
        pathlib.Path(folder, "scene.toml").write_text(text, encoding="utf-8")
        words = [palpate, "run", "scene.toml", "--out", "out"]
        for setting in settings:
            words += ["--set", setting]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip().replace("\n", " "))
        with open(pathlib.Path(folder, "out", "scene", "findings.csv"), newline="", encoding="utf-8") as file:
            found = next(csv.DictReader(file))
        curve = sorted(pathlib.Path(folder, "out", "scene").glob("**/force_indentation*.csv"))
        with open(curve[0], newline="", encoding="utf-8") as file:
            last = list(csv.DictReader(file))[-1]
        found["end"] = 1e3 * float(last["contact_force_N"])
        return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate")
    parser.add_argument("results")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10 ** 6))
    parser.add_argument("--scenes", type=int, default=30)
    parser.add_argument("settings", nargs="*")
    given = parser.parse_args()
    palpate = os.path.abspath(given.palpate)
    print(f"seed {given.seed}", file=sys.stderr)
    done = {}
    if os.path.exists(given.results):
        with open(given.results, newline="", encoding="utf-8") as file:
            done = {int(row["scene"]): row for row in csv.DictReader(file)}
    with open(given.results, "a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, NAMES)
        if not done:
            writer.writeheader()
        for number in range(given.scenes):
            if number in done:
                continue
            scene = draw(random.Random(given.seed * 100003 + number))
            try:
                found = answer_of(palpate, scene, given.settings)
                truth, doubt = truth_of(scene)
            except RuntimeError as error:
                print(f"scene {number}: {error}", file=sys.stderr)
                continue
            row = {"scene": number, "body": scene["kind"], "model": found["model"], "nodes": found.get("nodes", ""),
                   "inertia": f'{scene["inertia"]:.4f}', "depth_over_radius": f'{scene["depth"] / scene["radius"]:.4f}',
                   "force_mN": f'{found["end"]:.6g}', "truth_mN": f"{truth:.6g}", "doubt_mN": f"{doubt:.3g}",
                   "stated": found["stated_error"]}
            done[number] = row
            writer.writerow(row)
            file.flush()
    report(given.seed, done.values())


def report(seed, rows):
    errors, covered, shares = [], 0, []
    for row in rows:
        force, truth, doubt = (float(row[name]) for name in ("force_mN", "truth_mN", "doubt_mN"))
        error = abs(force / truth - 1.0)
        errors.append(error)
        covered += abs(force - truth) <= float(row["stated"]) * force + doubt
        shares.append(float(row["stated"]) / max(error, doubt / truth))
    print(f"seed {seed}: {covered} of {len(errors)} within what is stated; error {100 * statistics.median(errors):.1f} % "
          f"in the median, {100 * max(errors):.1f} % at most; stated over true {statistics.median(shares):.1f} in the median")


if __name__ == "__main__":
    main()
