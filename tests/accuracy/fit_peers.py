#!/usr/bin/env python3
"""Fits the same curves by palpate and by the own searches of nanite and pyRheo, and prints a row of a table for each:
`fit_peers.py PALPATE FOLDER NANITE AFMFORMATS PYRHEO`. FOLDER has the curves of `tests/bench/fit_scipy.py FOLDER`; the last
three are checkouts of these programs. nanite needs lmfit, h5py and scikit-learn; readers of other
formats (igor2, jprops) and pyRheo's Bayesian first guesses (scikit-optimize) are not used, so that empty modules stand in
their places. pyRheo weighs by 1 / y^2. The words are those of palpate's command and of the script in SCRIPTS, apart by
blanks."""

import contextlib
import csv
import io
import subprocess
import sys
import types
import warnings
from pathlib import Path

import numpy as np

COMMANDS = {
    "hertz": 'palpate fit hertz.csv --model hertz --radius "5 mm" --poisson 0.5 --baseline offset',
    "spring_pot": "palpate fit spring_pot.csv --model spring_pot",
    "liquid": "palpate fit liquid.csv --model prony --terms 1 --liquid --origin 0",
}
SCRIPTS = {
    "hertz": """import nanite
        curve = nanite.load_group("hertz.tab")[0]
        curve.apply_preprocessing(["compute_tip_position"])
        parameters = curve.get_initial_fit_parameters(model_key="hertz_para")
        parameters["R"].value = 5e-3
        parameters["E"].value = 1e4
        curve.fit_model(model_key="hertz_para", params_initial=parameters, segment="approach", weight_cp=0)
        print(curve.fit_properties["params_fitted"])""",
    "spring_pot": """import numpy as np
        from pyRheo.relaxation_model import RelaxationModel
        t, y = np.loadtxt("spring_pot.csv", delimiter=",", skiprows=1).T
        model = RelaxationModel(model="SpringPot", initial_guesses="random")
        model.fit(t, y)
        print(model.get_parameters())""",
    "liquid": """import numpy as np
        from pyRheo.relaxation_model import RelaxationModel
        t, y = np.loadtxt("liquid.csv", delimiter=",", skiprows=1).T
        model = RelaxationModel(model="Maxwell", initial_guesses="random")
        model.fit(t, y)
        print(model.get_parameters())""",
}
SHOWN = {"hertz": (("E", "kPa"), ("h_0", "mm")), "spring_pot": (("c", ""), ("beta", "")), "liquid": (("tau_1", "s"),)}


def palpate(program, folder, name):
    words = [word.strip('"') for word in COMMANDS[name].replace('"5 mm"', "5_mm").split()]
    words = [word.replace("5_mm", "5 mm") for word in words]
    done = subprocess.run([program, *words[1:], "--csv"], cwd=folder, capture_output=True, text=True, check=True)
    rows = {row["parameter"]: row for row in csv.DictReader(io.StringIO(done.stdout))}
    return {key: (float(rows[key]["estimate"]), float(rows[key]["std_error"])) for key, _ in SHOWN[name]}


def scipy_fit(folder, name):
    """The same law over the same rows, without a weight: what a least-squares fit gives."""
    from scipy.optimize import curve_fit
    from scipy.special import gamma

    x, y = np.loadtxt(folder / f"{name}.csv", delimiter=",", skiprows=1).T
    if name == "hertz":
        values, covariance = curve_fit(
            lambda h, e, c, f: 4 / 3 * e * 1e3 / 0.75 * np.sqrt(5e-3) * np.maximum(h - c * 1e-3, 0) ** 1.5 + f,
            x, y, p0=(10, 1.9, 0), x_scale=(10, 1, 1e-3), method="trf")
    elif name == "spring_pot":
        values, covariance = curve_fit(lambda t, c, b: c * t**-b / gamma(1 - b), x, y, p0=(1.0, 0.5))
    else:
        values, covariance = curve_fit(lambda t, tau, y0: y0 * np.exp(-t / tau), x, y, p0=(1.0, 0.5))
    errors = np.sqrt(np.diag(covariance))
    return {key: (values[i], errors[i]) for i, (key, _) in enumerate(SHOWN[name])}


def run_nanite(folder):
    """The approach as a .tab of afmformats, which nanite reads; its tip position falls as the depth grows."""
    h, force = np.loadtxt(folder / "hertz.csv", delimiter=",", skiprows=1).T
    lines = ["# afmformats", "#", "# BEGIN METADATA", "# {", '#   "enum": 0,', '#   "imaging mode": "force-distance",',
             '#   "spring constant": 1e6', "# }", "# END METADATA", "#", "# force\tsegment\ttime\ttip position"]
    for i, (x, y) in enumerate(zip(h, force, strict=True)):
        lines.append(f"{y:.17g}\tFalse\t{0.01 * i:.6g}\t{-x:.17g}")
    lines.append(f"{force[-1]:.17g}\tTrue\t{0.01 * len(h):.6g}\t{-h[-1] + 1e-6:.17g}")
    (folder / "hertz.tab").write_text("\n".join(lines) + "\n")
    import nanite

    curve = nanite.load_group(str(folder / "hertz.tab"))[0]
    curve.apply_preprocessing(["compute_tip_position"])
    parameters = curve.get_initial_fit_parameters(model_key="hertz_para")
    parameters["R"].value = 5e-3
    parameters["E"].value = 1e4
    found = {}
    for name, weight in (("nanite", {}), ("nanite, weight_cp=0", {"weight_cp": 0})):
        curve.fit_properties.reset()
        curve.fit_model(model_key="hertz_para", params_initial=parameters, segment="approach", **weight)
        fitted = curve.fit_properties["params_fitted"]
        found[name] = {"E": (fitted["E"].value / 1e3, (fitted["E"].stderr or np.nan) / 1e3),
                       "h_0": (-fitted["contact_point"].value * 1e3, (fitted["contact_point"].stderr or np.nan) * 1e3)}
    return found


def run_pyrheo(folder, name):
    from pyRheo.relaxation_model import RelaxationModel

    t, y = np.loadtxt(folder / f"{name}.csv", delimiter=",", skiprows=1).T
    np.random.seed(11)
    found = {}
    truth = {"spring_pot": [3.0, 0.2], "liquid": [1.3, 2.6]}[name]
    for peer, guesses, start in (("pyRheo", "random", None), ("pyRheo from the truth", "manual", truth)):
        model = RelaxationModel(model={"spring_pot": "SpringPot", "liquid": "Maxwell"}[name], initial_guesses=guesses)
        with contextlib.redirect_stdout(io.StringIO()):  # it prints its bounds
            model.fit(t, y, start)
        first, second = list(model.get_parameters().values())[:2]
        if name == "liquid":
            found[peer] = {"tau_1": (second / first, np.nan)}
        else:
            found[peer] = {"c": (first, np.nan), "beta": (second, np.nan)}
    return found


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    nanite, afmformats, pyrheo = sys.argv[3:6]
    sys.path[:0] = [f"{nanite}/src", afmformats, pyrheo]
    for name, word in (("skopt", "gp_minimize"), ("skopt.space", "Real"), ("igor2", "binarywave"), ("jprops", "")):
        sys.modules[name] = types.ModuleType(name)
        setattr(sys.modules[name], word, None)
    warnings.simplefilter("ignore")
    print("| curve | parameter | palpate | scipy | nanite or pyRheo | words, palpate and peer |\n|---|---|---|---|---|---|")
    for name in COMMANDS:
        ours, theirs = palpate(program, folder, name), scipy_fit(folder, name)
        try:
            peers = run_nanite(folder) if name == "hertz" else run_pyrheo(folder, name)
        except ImportError as error:
            peers = {f"cannot run: {error}": {}}
        words = f"{len(COMMANDS[name].split())}, {len(SCRIPTS[name].split())}"
        for peer, values in peers.items():
            for key, unit in SHOWN[name]:
                cells = [f"{value:.6g} +- {error:.3g}" for value, error in (ours[key], theirs[key])]
                value, error = values.get(key, (np.nan, np.nan))
                cells.append(f"{value:.6g}" + ("" if np.isnan(error) else f" +- {error:.3g}") + f" ({peer})")
                print("|", " | ".join([f"`{name}.csv`", f"{key}, {unit}" if unit else key, *cells, words]), "|")


if __name__ == "__main__":
    main()
