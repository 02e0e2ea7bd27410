"""The press of tests that call the program with every verb: tests/bench/verb_kills.py, tests/fuzz/command_lines.py."""

PRESS = """title = "Press"
[tissue]
young_modulus = "20 kPa"
poisson_ratio = 0.45
[finger]
material = "rigid"
radius = "5 mm"
[[step]]
kind = "indent"
to = "0.4 mm"
rate = "4 mm/s"
[output]
interval = "10 ms"
"""


def meshed(cells, press=PRESS):
    """The press on springs, with so many cells along x, y and z."""
    mesh = 'mesh = { kind = "kuhn", cells = %s }\n[finger]' % list(cells)
    return press.replace("[finger]", mesh) + '[solver]\nmodel = "mass_spring"\n'


def curve(rows, step):
    """A table of a press by Hertz's law, with so many rows that are `step` mm apart."""
    return "time_s,travel_mm,force_N\n" + "".join(
        "%g,%g,%g\n" % (0.1 * i, step * i, 0.02 * (step * i) ** 1.5 + 1e-5 * (i * 7919 % 13)) for i in range(rows))
