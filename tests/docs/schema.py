"""The JSON Schema against a public validator: schema.py PALPATE. Scenarios that palpate accepts obey it, and
broken ones do not."""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import jsonschema

TOP = Path(__file__).resolve().parents[2]
BROKEN = {
    "an unknown key": "[tissue]\nyoungs = \"1 kPa\"",
    "an unknown table": "[tisue]",
    "a unit of another dimension": "[finger]\nradius = \"3 kPa\"",
    "a number without its unit": "[finger]\nradius = 3",
    "a negative length": "[finger]\nradius = \"-3 mm\"",
    "an unknown word": "[contact]\ncoupling = \"sideways\"",
    "a number out of range": "[tissue]\npoisson_ratio = 0.7",
    "a fraction for a whole number": "[tissue]\nmesh = { kind = \"tetgen\", nodes = 4.5 }",
    "a key of another kind": "[[step]]\nkind = \"hold\"\nrate = \"1 mm/s\"",
    "an unknown kind": "[[step]]\nkind = \"jump\"",
    "a list that is too short": "[tissue]\nshape = { kind = \"cuboid\", size = [\"1 mm\"] }",
    "a later format": "schema = 2",
    "a swept value without a list": "[sweep]\n\"finger.radius\" = \"3 mm\"",
    "an unknown design": "[sweep]\ndesign = \"dice\"",
}
GOOD = {
    "a micro sign": "[finger]\nradius = \"900 \u00b5m\"",
    "a force for a travel": "[[step]]\nkind = \"indent\"\nto = \"0.5 N\"",
    "a product of units": "[[step]]\nkind = \"indent\"\nto = \"0.5 kg*m/s^2\"",
    "no kind": "[[step]]\nto = \"1e-3 m\"",
    "a word for a number": "[solver]\ntime_step = \"auto\"",
    "nested keys": "[sweep]\ntissue.material = [\"skin\"]",
}


def main():
    program = sys.argv[1]
    schema = json.loads(subprocess.run([program, "schema"], check=True, stdout=subprocess.PIPE).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    faults = []
    texts = {str(path.relative_to(TOP)): path.read_text() for path in TOP.glob("scenarios/**/*.toml")
             if path.parent.name not in ("emulator", "gauges")}
    for kind in schema_kinds(program):
        texts[f"palpate new {kind}"] = subprocess.run([program, "new", kind, "-"], check=True, stdout=subprocess.PIPE,
                                                      text=True).stdout
    for name, text in (texts | GOOD).items():
        for error in validator.iter_errors(tomllib.loads(text)):
            faults.append(f"{name}: {'.'.join(map(str, error.absolute_path))}: {error.message}")
    for name, text in BROKEN.items():
        if validator.is_valid(tomllib.loads(text)):
            faults.append(f"{name} passes")
    print("\n".join(faults) or f"{len(texts)} scenarios pass, {len(BROKEN)} broken ones do not")
    sys.exit(bool(faults))


def schema_kinds(program):
    lines = subprocess.run([program, "complete", "new", ""], check=True, stdout=subprocess.PIPE, text=True).stdout
    return [line.split("\t")[0] for line in lines.splitlines()]


if __name__ == "__main__":
    main()
