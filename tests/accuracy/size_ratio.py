"""Counts how often a formula with `contact.size = "body"` states at least its true error.

Presses COUNT random bodies of each kind with a rigid finger: blocks, anywhere on their top (`layer`);
ellipsoids and lying cylinders, as in curved_bodies.py, and bodies that stand on part of themselves,
as in standing_bodies.py (`hertz`). Their truth is coupled springs, refined by their own error to 1 %.

    size_ratio.py PALPATE COUNT [FIRST]      prints a table; three seconds a body
"""
import concurrent.futures
import os
import random
import sys
import tempfile

import numpy as np

sys.dont_write_bytecode = True
import curved_bodies
import standing_bodies


def block(number):
    u = random.Random(number).uniform
    radius, nu = u(5, 15), u(0, 0.495)
    size = (u(2, 12) * radius, u(2, 12) * radius, u(1, 6) * radius)
    depth = min(0.5 * radius, 0.3 * size[2]) * u(0.03, 0.8)
    shape = '{ kind = "cuboid", size = ["%.6g mm", "%.6g mm", "%.6g mm"] }' % size
    text = curved_bodies.SCENARIO.format(nu=nu, shape=shape, radius=radius, depth=depth)
    place = 'x = "%.5g mm"\ny = "%.5g mm"\n' % (u(0.2, 0.8) * size[0], u(0.2, 0.8) * size[1])
    return "block", {"press.toml": text.replace("[contact]", place + "[contact]")}


def curved(number):
    body = curved_bodies.draw(number)
    return body["kind"], {"press.toml": body["text"]}


def measure(program, body):
    """The kind; true and stated error of the formula alone and with the factor, and the truth's."""
    kind, files = body
    model = "solver.model=" + ("layer" if kind == "block" else "hertz")
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        # With the factor of a deep press, or without it where the body is too curved for it.
        for depth in ("contact.depth=neo_hookean", "contact.depth=hertz"):
            alone = curved_bodies.findings(program, folder, depth, model)
            if alone:
                break
        body = alone and curved_bodies.findings(program, folder, depth, model, "contact.size=body")
        truth = body and curved_bodies.findings(
            program, folder, depth, "solver.model=coupled_springs", "solver.tolerance=0.02")
    if not truth:
        return kind, None
    return kind, (abs(alone[0] / truth[0] - 1), alone[1], abs(body[0] / truth[0] - 1), body[1],
                  truth[1])


def main():
    program, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    numbers = range(first, first + count)
    bodies = [draw(number) for draw in (block, curved, standing_bodies.draw_body)
              for number in numbers]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = list(pool.map(lambda body: measure(program, body), bodies))
    print("| body | with a factor | without | states up to 5 %: alone, with the factor | true error "
          "of these with it, median and largest, % | covered, of these and of all, % | with the "
          "truth's own error, of all, % |")
    print("|---|---|---|---|---|---|---|")
    for kind in sorted({kind for kind, _ in rows}):
        known = np.array([row for one, row in rows if one == kind and row])
        refused = sum(one == kind and row is None for one, row in rows)
        _, alone, error, stated, own = known.T
        low = stated <= 0.05
        of_low = (f"{100 * np.median(error[low]):.1f}, {100 * error[low].max():.1f}"
                  if low.any() else "")
        low_covered = f"{100 * np.mean((error <= stated)[low]):.0f}, " if low.any() else ""
        print(f"| {kind} | {len(known)} | {refused} | {np.sum(alone <= 0.05)}, {low.sum()} | "
              f"{of_low} | {low_covered}{100 * np.mean(error <= stated):.0f} | "
              f"{100 * np.mean(error <= stated + own):.0f} |")


if __name__ == "__main__":
    main()
