"""Finite strain over linear elasticity: a formula on wide flat layers, and a bound on other bodies.

With x = h/R, y = h/t the depth over the thickness and q = (1 - 2 nu)/(1 - nu),
    F / F_linear = 1 + sum c_ijm x^(i/2) y^j q^m
is fitted to wide layers (deep_layers.csv) and written to deep_ratio.csv. On the discs of
random_bodies.csv it also meets sides at the distance W; what it is off there, over (a/W)^2 h/W with
the squared contact radius a^2 = R h, is the constant of the sides. On all bodies of that file
    |F / F_linear - 1| <= ((0.1 + 0.3 q) sqrt(h/R_e) + h/t) / 2
with the effective radius R_e of the contact, the thickness t of the body or of its softest layer,
and the smallest nu, is a bound that is counted.
    deep_ratio.py           fits, writes deep_ratio.csv and prints the errors and the count
    deep_ratio.py --cpp     prints the table of src/contact/depth_ratio.cpp
"""
import csv
import json
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
TERMS = ((1, 0), (2, 0), (4, 0), (0, 1), (1, 1), (2, 1), (0, 2), (1, 2), (2, 2), (0, 3), (1, 3),
         (0, 4), (1, 4))  # (i, j)
POWERS = 5  # of q
LEAST_ERROR = 0.004  # the formula on layers and the meshes, each 0.2 %
MOST_SHARE = 0.5  # y; beyond it bonded layers with nu from 0.45 on fold
BASES = ("bonded", "frictionless")


def read(name):
    with open(os.path.join(HERE, name), newline="") as file:
        return list(csv.DictReader(file))


def shift(poisson):
    return (1.0 - 2.0 * poisson) / (1.0 - poisson)


def layer_terms(x, y, q):
    return np.stack([x ** (0.5 * i) * y ** j * q ** m for i, j in TERMS for m in range(POWERS)],
                    -1)


def layers(base):
    """nu, x, y and the ratio of wide layers; without their shallowest depths, where the contact is
    a few elements wide, and without what is not stable."""
    kept = []
    for row in read("deep_layers.csv"):
        poisson, thickness, depth = [float(row[n]) for n in ("poisson", "thickness", "depth")]
        deepest = min(0.8, 0.6 * thickness)
        if row["base"] == base and row["stable"] == "1" and depth > 0.02 * deepest \
                and depth <= MOST_SHARE * thickness:
            kept.append((poisson, depth, depth / thickness, float(row["ratio"])))
    return np.array(kept).T


def fit(matrix, values):
    """Coefficients whose largest relative error is nearly the least: Lawson's weights."""
    weights = np.ones(len(values))
    for _ in range(40):
        root = np.sqrt(weights)
        found = np.linalg.lstsq(matrix * root[:, None], values * root, rcond=None)[0]
        error = np.abs(matrix @ found - values)
        weights *= 1.0 + (error / error.max()) ** 2
        weights /= weights.mean()
    return found, error


def fit_layers(base):
    poisson, x, y, ratio = layers(base)
    found, error = fit(layer_terms(x, y, shift(poisson)) / ratio[:, None], 1.0 - 1.0 / ratio)
    print(f"{base} layers: {len(ratio)} forces, formula off by {np.sqrt((error ** 2).mean()):.4f} "
          f"(rms), {error.max():.4f} (largest)", file=sys.stderr)
    return found


def bodies():
    """The presses of random_bodies.csv with their sizes."""
    for row in read("random_bodies.csv"):
        if not row["neo_hookean"]:
            continue
        shape, youngs, poisson = [json.loads(row[n]) for n in ("shape", "youngs", "poisson")]
        radius = float(row["sphere_radius"])
        thickness = shape.get("height") or shape["layers"][youngs.index(min(youngs))]
        effective = radius
        if row["kind"] == "dome":
            effective = 1.0 / (1.0 / radius + shape["height"] / shape["radius"] ** 2)
        elif row["kind"] == "dish":
            effective = 1.0 / (1.0 / radius - 1.0 / shape["hollow"])
        yield {"kind": row["kind"], "base": row["base"], "poisson": min(poisson),
               "depth": float(row["depth"]), "radius": radius, "effective": effective,
               "thickness": thickness, "width": shape["radius"],
               "ratio": float(row["neo_hookean"]) / float(row["paraboloid"])}


def bound(body):
    return 0.5 * ((0.1 + 0.3 * shift(body["poisson"])) * np.sqrt(body["depth"] / body["effective"])
                  + body["depth"] / body["thickness"])


def print_count(found):
    print("| bodies | presses | within the bound | bound over change, median |\n|---|---|---|---|")
    for kind in sorted({body["kind"] for body in found}):
        chosen = [(abs(b["ratio"] - 1.0), bound(b)) for b in found if b["kind"] == kind]
        over = np.median([limit / max(change, 1e-9) for change, limit in chosen])
        print(f"| {kind} | {len(chosen)} | {sum(c <= b for c, b in chosen)} | {over:.1f} |")


def print_sides(table, found):
    """What the formula is off beside sides, over (a/W)^2 h/W."""
    shares = []
    for b in found:
        x, y = b["depth"] / b["radius"], b["depth"] / b["thickness"]
        if b["kind"] != "disc" or y > MOST_SHARE or x > 0.8:
            continue
        formula = 1.0 + layer_terms(np.array(x), np.array(y), shift(b["poisson"])) @ table[b["base"]]
        error = abs(formula / b["ratio"] - 1.0) - LEAST_ERROR
        shares.append(max(0.0, error) * b["width"] ** 3 / (b["radius"] * b["depth"] ** 2))
    print(f"sides: {len(shares)} presses on discs, error over (a/W)^2 h/W:"
          f" {np.quantile(shares, 0.95):.2f} in 95 of 100, {max(shares):.2f} at most")


def main():
    table = {base: np.array([float(f"{value:.5g}") for value in fit_layers(base)])
             for base in BASES}
    with open(os.path.join(HERE, "deep_ratio.csv"), "w") as file:
        file.write("base,i,j,m,coefficient\n")
        for base in BASES:
            for (i, j), row in zip(TERMS, table[base].reshape(-1, POWERS)):
                file.writelines(f"{base},{i},{j},{m},{value:.5g}\n" for m, value in enumerate(row))
    if "--cpp" in sys.argv:
        for base in BASES:
            print(f"// {base}")
            for (i, j), row in zip(TERMS, table[base].reshape(-1, POWERS)):
                values = ", ".join(f"{value:.5g}" for value in row)
                print(f"    {{.root = {i}, .share = {j}, .by_ratio = {{{values}}}}},")
        return
    found = list(bodies())
    print_count(found)
    print_sides(table, found)


if __name__ == "__main__":
    main()
