#!/usr/bin/env python3
"""Force and processor time of `solid` and of CalculiX on the same quadratic mesh: a table of docs/accuracy.md.

    tests/accuracy/same_mesh.py PALPATE SEED NUMBER... [--finer F]

Scenes of fresh_scenes.py under rigid fingers. Gmsh meshes the body, about three elements to a contact radius, F times as
many with --finer; palpate reads that mesh as an Abaqus file and CalculiX as its own input (C3D10, NLGEOM, the same law, one
thread). Both run one after the other, and neither uses planes of symmetry. `solid` keeps meshes of several tissues: in a
body of one, every seventh element is a millionth stiffer.
"""
import argparse
import csv
import pathlib
import resource
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True

import calculix
import fresh_scenes


def mesh_text(scene, made):
    """The body as an Abaqus file, with a set of elements for every stiffness."""
    used = sorted({n for _, ten in made["elements"] for n in ten})
    lines = ["*NODE"] + [f"{n}, " + ", ".join(f"{x:.9g}" for x in made["nodes"][n]) for n in used]
    sets = sorted({stiffness for stiffness, _ in made["elements"]}, key=lambda one: one != scene["young"])
    number = 0
    for i, stiffness in enumerate(sets):
        lines.append(f"*ELEMENT, TYPE=C3D10, ELSET=T{i}")
        for own, ten in made["elements"]:
            if own == stiffness:
                number += 1
                lines.append(f"{number}, " + ", ".join(map(str, ten)))
    return "\n".join(lines) + "\n", sets


def scenario(scene, sets):
    """That of the scene, on the mesh."""
    lines = []
    for line in fresh_scenes.text_of(scene).split("[[region]]")[0].splitlines() + ["[finger]"]:
        if line == "[finger]":
            break
        if line.startswith("shape ="):
            line = 'mesh = { kind = "file", file = "body.inp", unit = "mm" }'
        lines.append(line)
    for i, stiffness in enumerate(sets[1:]):
        lines += ["[[region]]", 'kind = "tagged"', f'name = "T{i + 1}"', 'material = "skin"',
                  f'young_modulus = "{1e3 * stiffness!r} kPa"', f'poisson_ratio = {scene["nu"]!r}']
    rest = fresh_scenes.text_of(scene)
    return "\n".join(lines) + "\n" + rest[rest.index("[finger]"):] + '[solver]\nmodel = "solid"\n'


def used():
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("palpate", type=lambda word: str(pathlib.Path(word).resolve()))
    parser.add_argument("seed", type=int)
    parser.add_argument("numbers", type=int, nargs="+")
    parser.add_argument("--finer", type=float, default=1.0)
    arguments = parser.parse_args()
    print("| scene | nodes of the mesh | of palpate's | CalculiX, mN | palpate, mN | difference, % | CalculiX, s | palpate, s |")
    print("|---|---|---|---|---|---|---|---|")
    for number in arguments.numbers:
        scene = fresh_scenes.draw(arguments.seed, number) | {"finger": None, "viscous": None}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            made = calculix.mesh(scene, 3.0, arguments.finer)
            if not scene["lumps"] and not scene["layer"]:
                made["elements"] = [(stiffness if i % 7 else 1.000001 * stiffness, ten)
                                    for i, (stiffness, ten) in enumerate(made["elements"])]
            mesh, sets = mesh_text(scene, made)
            (folder / "body.inp").write_text(mesh, encoding="utf-8")
            (folder / "scene.toml").write_text(scenario(scene, sets), encoding="utf-8")
            start = used()
            subprocess.run([arguments.palpate, "run", "scene.toml", "--out", "out", "--quiet"], cwd=folder, check=True)
            middle = used()
            other = 1e3 * calculix.pressed(scene, made, folder)[-1]
            end = used()
            with open(folder / "out/scene/force_indentation.csv", encoding="utf-8", newline="") as file:
                own = 1e3 * max(float(row["contact_force_N"]) for row in csv.DictReader(file))
            with open(folder / "out/scene/findings.csv", encoding="utf-8", newline="") as file:
                nodes = next(csv.DictReader(file))["nodes"]
        count = len({n for _, ten in made["elements"] for n in ten})
        print(f"| {scene['kind']}, {scene['body']} | {count} | {nodes} | {other:.2f} | {own:.2f} | "
              f"{100 * (own / other - 1):+.2f} | {end - middle:.1f} | {middle - start:.1f} |", flush=True)


if __name__ == "__main__":
    main()
