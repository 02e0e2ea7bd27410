"""Solves every scene on three meshes into runs.csv, then writes forces.csv.

Rows that runs.csv holds already are not solved again: delete the file for a fresh start.
"""
import csv
import os
from dataclasses import dataclass, field

import numpy as np

import block_contact

HERE = os.path.dirname(os.path.abspath(__file__))
LEVELS = (8, 12, 16)  # equal elements from the centre to the zone's edge


@dataclass
class Scene:
    name: str
    length: float  # mm, along x
    width: float  # mm, along y
    radius: float  # mm
    layers: list  # (depth of the bottom mm, E kPa, nu) from the top down
    depths: list  # mm
    base: str = "clamped"
    offset: float = 0.0  # mm from the centre along x; the finger stays on the mirror y = 0
    levels: tuple = field(default=LEVELS)


def scenes():
    four = [0.25, 0.5, 0.75, 1.0]
    for height in (30, 10):
        for nu in (0.33, 0.45, 0.49):
            yield Scene(f"block{height}-nu{100 * nu:.0f}", 60, 60, 11, [(height, 72.4, nu)], four)
    for nu in (0.45, 0.40):
        yield Scene(f"small-nu{100 * nu:.0f}", 40, 40, 5, [(15, 72.4, nu)], [0.125, 0.25, 0.5])
    yield Scene("long-soft", 80, 50, 15, [(20, 6.0, 0.33)], [0.5, 1.0, 1.5])
    for nu in (0.25, 0.10):
        yield Scene(f"block30-nu{100 * nu:.0f}", 60, 60, 11, [(30, 72.4, nu)], [0.5, 1.0])
    yield Scene("slippery10-nu45", 60, 60, 11, [(10, 72.4, 0.45)], four, base="frictionless")
    yield Scene("block5-nu45", 60, 60, 11, [(5, 72.4, 0.45)], [0.125, 0.25, 0.5])
    for name, top, below in (("hard-on-soft", 72.4, 20.0), ("soft-on-hard", 20.0, 72.4)):
        yield Scene(name, 60, 60, 11, [(3, top, 0.45), (20, below, 0.45)], [0.5, 1.0])
    # Half a block: one mirror less, so a coarser family of meshes.
    yield Scene("aside15-nu45", 60, 60, 11, [(30, 72.4, 0.45)], [0.5, 1.0], offset=15.0,
                levels=(6, 8, 12))


def axes(scene, zone, level):
    """Element borders, the finger at the origin."""
    half = scene.length / 2
    if scene.offset == 0.0:
        x = block_contact.half_axis(half, zone, level)
    else:
        x = np.concatenate([
            -block_contact.half_axis(half - scene.offset, zone, level)[:0:-1],
            block_contact.half_axis(half + scene.offset, zone, level)])
    y = block_contact.half_axis(scene.width / 2, zone, level)
    return [x, y, block_contact.down_axis([bottom for bottom, _, _ in scene.layers], zone, level)]


def zone_of(scene, depth):
    """Half side of the square of equal elements: 1.3 contact radii of the half-space, or more."""
    thin = scene.layers[-1][0] < 8 or scene.name == "soft-on-hard"
    return (1.45 if thin else 1.3) * np.sqrt(scene.radius * depth)


RUN_COLUMNS = ["scene", "depth_mm", "level", "unknowns", "memory_MB", "vertical_mN", "normal_mN",
               "vertical_radius_mm", "normal_radius_mm"]


def solve_all(path):
    done = {}
    if os.path.exists(path):
        with open(path, newline="") as file:
            done = {(r["scene"], r["depth_mm"], r["level"]) for r in csv.DictReader(file)}
    else:
        with open(path, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerow(RUN_COLUMNS)
    for scene in scenes():
        for depth in scene.depths:
            for level in scene.levels:
                if (scene.name, f"{depth:g}", str(level)) in done:
                    continue
                zone = zone_of(scene, depth)
                surface = block_contact.Surface(axes(scene, zone, level), scene.layers, scene.base,
                                                0.999 * zone)
                (up, up_radius), (along, along_radius) = block_contact.press(
                    surface, scene.radius, depth)
                row = [scene.name, f"{depth:g}", level, surface.unknowns, surface.memory,
                       f"{up:.7g}", f"{along:.7g}", f"{up_radius:.5g}", f"{along_radius:.5g}"]
                with open(path, "a", newline="") as file:
                    csv.writer(file, lineterminator="\n").writerow(row)
                print(*row, flush=True)
        write_forces(path, os.path.join(HERE, "forces.csv"))


def error_of(values):
    """Discretisation error of the last of three values, each from a finer mesh than before.

    The contact's edge falls anywhere between nodes, so the values scatter about their limit: the
    last step; or a third of the two together, which is what halving a second-order error leaves;
    or 1e-4, below which the checks with known answers do not come.
    """
    coarse, middle, fine = values
    return max(abs(fine - middle), abs(fine - coarse) / 3.0, 1e-4 * fine)


FORCE_COLUMNS = ["scene", "length_mm", "width_mm", "height_mm", "radius_mm", "youngs_kPa",
                 "poisson", "base", "top_layer_mm", "top_layer_youngs_kPa", "offset_mm", "depth_mm",
                 "vertical_mN", "vertical_error_mN", "normal_mN", "normal_error_mN",
                 "vertical_radius_mm", "normal_radius_mm"]


def write_forces(runs, path):
    """One row a scene and depth: the finest mesh's values and their discretisation errors."""
    with open(runs, newline="") as file:
        rows = {(r["scene"], r["depth_mm"], int(r["level"])): r for r in csv.DictReader(file)}
    lines = []
    for scene in scenes():
        for depth in scene.depths:
            found = [rows.get((scene.name, f"{depth:g}", level)) for level in scene.levels]
            if None in found:
                continue
            cells = []
            for key in ("vertical_mN", "normal_mN"):
                values = [float(r[key]) for r in found]
                cells += [f"{values[-1]:.6g}", f"{error_of(values):.2g}"]
            bottom, modulus, nu = scene.layers[-1]
            layered = len(scene.layers) > 1
            lines.append([scene.name, scene.length, scene.width, bottom, scene.radius, modulus, nu,
                          scene.base, scene.layers[0][0] if layered else 0,
                          scene.layers[0][1] if layered else 0, f"{scene.offset:g}", f"{depth:g}",
                          *cells, f"{float(found[-1]['vertical_radius_mm']):.3f}",
                          f"{float(found[-1]['normal_radius_mm']):.3f}"])
    with open(path + ".new", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(FORCE_COLUMNS)
        writer.writerows(lines)
    os.replace(path + ".new", path)


if __name__ == "__main__":
    solve_all(os.path.join(HERE, "runs.csv"))
