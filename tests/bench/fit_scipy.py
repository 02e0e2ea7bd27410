#!/usr/bin/env python3
"""Writes curves with noise into a folder and prints what scipy fits to them, to compare with `palpate fit`:
`fit_scipy.py FOLDER [PYRHEO NANITE]`, the last two are checkouts of these programs, whose laws scipy then fits too.
The last lines count the words, apart by blanks, that palpate's command and the shortest script with scipy take."""

import sys
import types
from pathlib import Path

import numpy as np
from scipy.optimize import brentq, curve_fit, least_squares
from scipy.special import gamma


COMMANDS = {
    "spring_pot": "palpate fit spring_pot.csv --model spring_pot",
    "liquid": "palpate fit liquid.csv --model prony --terms 1 --liquid --origin 0",
    "hertz": 'palpate fit hertz.csv --model hertz --radius "5 mm" --poisson 0.5 --baseline offset',
    "jkr": 'palpate fit jkr.csv --model adhesive --radius "2.5 um" --poisson 0.5',
    "yeoh": "palpate fit rubber.csv --model yeoh",
    "ogden": "palpate fit rubber.csv --model ogden",
    "power_law": 'palpate fit power_law.csv --time time --model hertz_power_law --radius "2.5 um" --poisson 0.5',
    "solid": 'palpate fit solid.csv --time time --model hertz_solid --radius "2.5 um" --poisson 0.5',
}
HEAD = "import numpy as np from scipy.optimize import curve_fit x, y = np.loadtxt('FILE', delimiter=',', skiprows=1).T "
TAIL = " p, c = curve_fit(law, x, y, p0=START) print(p, np.sqrt(np.diag(c)))"
SCRIPTS = {
    "spring_pot": "from scipy.special import gamma law = lambda t, c, b: c * t**-b / gamma(1 - b)",
    "liquid": "law = lambda t, y, tau: y * np.exp(-t / tau)",
    "hertz": "law = lambda h, e, c, f: 4 / 3 * e / 0.75 * np.sqrt(5e-3) * np.maximum(h - c, 0) ** 1.5 + f",
    "jkr": """from scipy.optimize import brentq
        def law(h, e, w, c, f):
            s = (np.pi * w * R**2 / 8 / e) ** (1 / 3)
            d = (h - c) * R / s**2
            x = [brentq(lambda x: x * x - 4 * np.sqrt(x) - one, 1, 1e3) if one > -3 else 1 for one in d]
            x = np.array(x)
            return np.where(np.arange(len(h)) < 301, np.pi * w * R / 6 * (x**3 - 6 * x**1.5), 0) + f""",
    "yeoh": """law = lambda s, e, c, d: (s - s**-2) * (e / 3 + 4 * c * (s * s + 2 / s - 3) +
        6 * d * (s * s + 2 / s - 3) ** 2)""",
    "ogden": "law = lambda s, e, a: 2 * e / (3 * a) * (s ** (a - 1) - s ** (-a / 2 - 1))",
    "power_law": """from scipy.special import gamma
        law = lambda t, e, b, c, f: F * e * gamma(1.5) * gamma(1 - b) / gamma(2.5 - b) * np.maximum(t - c, 0) ** (1.5 - b)
        + f""",
    "solid": """angle = np.pi / 2 * (np.arange(2000) + 0.5) / 2000
        def law(t, low, high, tau, contact, offset):
            since = np.maximum(t - contact, 0)[:, None]
            age = since * np.cos(angle) ** 2
            rate = since**1.5 * np.sin(angle) ** 2 * np.cos(angle)
            return F * np.sum((low + (high - low) * np.exp(-age / tau)) * rate, axis=1) + offset""",
}


def words():
    for name, command in COMMANDS.items():
        print(f"{name}: {len(command.split())} words by palpate, {len((HEAD + SCRIPTS[name] + TAIL).split())} by scipy")


def save(path, names, x, y):
    np.savetxt(path, np.c_[x, y], delimiter=",", header=names, comments="", fmt="%.17g")


def say(name, values, errors):
    print(name, *(f"{value:.6g} +- {error:.3g}" for value, error in zip(values, errors, strict=True)))


def laws_of(pyrheo, nanite):
    """The laws of pyRheo and nanite, without what else these packages import."""
    package = types.ModuleType("pyRheo")
    package.__path__ = [str(Path(pyrheo) / "pyRheo")]
    sys.modules["pyRheo"] = package
    sys.modules["lmfit"] = types.ModuleType("lmfit")
    from pyRheo.rheo_models.relaxation_models import MaxwellModel, SpringPot

    text = (Path(nanite) / "src/nanite/model/model_hertz_paraboloidal.py").read_text()
    names = {"np": np}
    start = text.index("def hertz_paraboloidal")
    exec(text[start : text.index("return aa*bb + baseline") + 23], names)
    return {
        "spring_pot": lambda t, c, b: SpringPot(c, b, t),
        "liquid": lambda t, y, tau: MaxwellModel(y, y * tau, t),
        "hertz": lambda h, e, c, f: names["hertz_paraboloidal"](-h, e * 1e3, 5e-3, 0.5, -c, f),
    }


def press(folder, rng, others):
    def law(h, e, c, f):
        return 4 / 3 * e * 1e3 / 0.75 * np.sqrt(5e-3) * np.maximum(h - c, 0) ** 1.5 + f

    h = np.linspace(1.5e-3, 3e-3, 301)
    y = law(h, 20, 2e-3, 0) + rng.normal(0, 2e-4, len(h))
    save(folder / "hertz.csv", "depth (m),force (N)", h, y)
    for name, one in (("scipy", law), ("nanite", others.get("hertz"))):
        if one:
            values, covariance = curve_fit(one, h, y, p0=(10, 1.9e-3, 0), x_scale=(10, 1e-3, 1e-3), method="trf")
            say(f"hertz {name}", values, np.sqrt(np.diag(covariance)))


def relaxations(folder, rng, others):
    t = np.linspace(0.05, 6, 120)
    curves = {
        "spring_pot": (lambda t, c, b: c * t**-b / gamma(1 - b), (3.0, 0.2), 0.05),
        "liquid": (lambda t, y, tau: y * np.exp(-t / tau), (1.3, 2.0), 0.01),
    }
    for name, (law, truth, noise) in curves.items():
        y = law(t, *truth) + rng.normal(0, noise, len(t))
        save(folder / f"{name}.csv", "time (s),stress (kPa)", t, y)
        values, covariance = curve_fit(law, t, y, p0=(1.0, 0.5))
        say(name, values, np.sqrt(np.diag(covariance)))
        if name in others:
            values, covariance = curve_fit(others[name], t, y, p0=(1.0, 0.5))
            say(f"{name} pyRheo", values, np.sqrt(np.diag(covariance)))


def adhesion(folder, rng):
    radius, modulus, work = 2.5e-6, 1e4, 2e-5
    opening = (np.pi * work * radius**2 / 8 / modulus) ** (1 / 3)
    a = opening * np.linspace(3.5, 1.1, 301)
    h = 1e-6 + a**2 / radius - np.sqrt(2 * np.pi * a * work / modulus)
    force = 4 * modulus * a**3 / (3 * radius) - np.sqrt(8 * np.pi * work * modulus * a**3)
    pull = 1.5 * np.pi * work * radius
    h = np.r_[h, h[-1] - 4e-9 * np.arange(1, 151)]
    force = np.r_[force, np.zeros(150)] + rng.normal(0, 0.02 * pull, 451)
    save(folder / "jkr.csv", "depth (um),force (nN)", h * 1e6, force * 1e9)

    def residuals(q):
        e, w, contact, offset = q * np.array([1e4, 1e-5, 1e-6, 1e-10])
        scale = (np.pi * w * radius**2 / 8 / e) ** (1 / 3)
        out = np.full(len(h), offset)
        for i in range(301):
            d = (h[i] - contact) * radius / scale**2
            x = brentq(lambda x, d=d: x * x - 4 * np.sqrt(x) - d, 1, 1e3) if d > -3 else 1.0
            out[i] += np.pi * w * radius / 6 * (x**3 - 6 * x**1.5)
        return (out - force) / pull

    found = least_squares(residuals, [0.9, 1.8, 1.01, 0.0])
    errors = np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)) * 2 * found.cost / (451 - 4))
    say("jkr (E in kPa, w in mJ/m^2)", found.x[:2] * [7.5, 0.01], errors[:2] * [7.5, 0.01])


# Treloar's simple tension of vulcanised rubber (1944), stretches and nominal stresses in MPa, as Steinmann, Hossain and
# Possart print them (Arch. Appl. Mech. 82, 2012).
STRETCH = """1 1.01 1.12 1.24 1.39 1.61 1.89 2.17 2.42 3.01 3.58 4.03 4.76 5.36 5.76 6.16 6.4 6.62 6.87 7.05 7.16 7.27 7.43
    7.5 7.61"""
STRESS = """0 0.03 0.14 0.23 0.32 0.41 0.5 0.58 0.67 0.85 1.04 1.21 1.58 1.94 2.29 2.67 3.02 3.39 3.75 4.12 4.47 4.85 5.21
    5.57 6.3"""


def large_strains(folder):
    stretch, stress = np.array(STRETCH.split(), float), 1e3 * np.array(STRESS.split(), float)
    save(folder / "rubber.csv", "stretch,stress (kPa)", stretch, stress)

    def yeoh(s, e, c2, c3):
        over = s * s + 2 / s - 3
        return (s - s**-2) * (e / 3 + 4 * c2 * over + 6 * c3 * over**2)

    def ogden(s, e, alpha):
        return 2 * e / (3 * alpha) * (s ** (alpha - 1) - s ** (-alpha / 2 - 1))

    for name, law, start in (("yeoh", yeoh, (1e3, 1, 0.1)), ("ogden", ogden, (150, -7.0))):
        values, covariance = curve_fit(law, stretch, stress, p0=start, xtol=1e-12, ftol=1e-12)
        say(name, values, np.sqrt(np.diag(covariance)))


def viscous(folder, rng):
    """Approaches at 1 um/s by a ball of 2.5 um, with contact at 0.2 um."""
    t = np.linspace(0, 1, 401)
    factor = 4 / 3 * np.sqrt(2.5e-6) / 0.75 * 1e-6**1.5

    def power(t, e, beta, contact, offset):
        since = np.maximum(t - contact, 0)
        law = 1.5 * gamma(1.5) * gamma(1 - beta) / gamma(2.5 - beta) * since ** (1.5 - beta)
        return factor * 1e12 * e * law + offset

    def solid(t, low, high, tau, contact, offset):  # the time s in the place of contact is s = since * sin(angle)^2
        angle = np.pi / 2 * (np.arange(2000) + 0.5) / 2000
        since = np.maximum(t - contact, 0)[:, None]
        age = since * np.cos(angle) ** 2
        rate = 1.5 * since**1.5 * np.sin(angle) * 2 * np.sin(angle) * np.cos(angle)
        law = np.sum((low + (high - low) * np.exp(-age / tau)) * rate, axis=1) * np.pi / 2 / 2000
        return factor * 1e12 * law + offset

    for name, law, truth in (("power_law", power, (1.0, 0.25, 0.2, 0.0)), ("solid", solid, (0.5, 1.5, 0.15, 0.2, 0.0))):
        y = law(t, *truth)
        y += rng.normal(0, 0.01 * y[-1], len(t))
        np.savetxt(folder / f"{name}.csv", np.c_[t, t, y], delimiter=",", fmt="%.17g", comments="",
                   header="time (s),depth (um),force (nN)")
        values, covariance = curve_fit(law, t, y, p0=np.array(truth) * 0.9)
        say(name, values, np.sqrt(np.diag(covariance)))


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    rng = np.random.default_rng(11)
    others = laws_of(*sys.argv[2:4]) if len(sys.argv) > 3 else {}
    relaxations(folder, rng, others)
    adhesion(folder, rng)
    press(folder, rng, others)
    large_strains(folder)
    viscous(folder, rng)
    words()


if __name__ == "__main__":
    main()
