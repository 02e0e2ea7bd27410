#!/usr/bin/env python3
"""Writes a body as a scanner leaves it, scan.ply, and the scenario scan.toml: scan.py FOLDER.

A breast-like mound of 140 x 60 x 120 mm on a flat back: y is up, lengths are in metres and in
single precision, the back is at y = 0. There are two holes where the scanner saw nothing, some
triangles are doubled, some face inwards, and one vertex belongs to two sheets.
"""
import math
import os
import shutil
import struct
import sys

around, rings = 96, 34
half_x, half_z, high = 0.070, 0.060, 0.060  # m


def place(turn, out):
    """On the mound: `out` is 0 at the top and 1 at the rim."""
    flat = math.sin(0.5 * math.pi * out)
    rise = math.cos(0.5 * math.pi * out) ** 0.8
    # The sides sag a little, and the skin has a grain of a tenth of a millimetre.
    grain = 0.0001 * math.sin(31 * turn) * math.sin(40 * out)
    return (half_x * flat * math.cos(turn), high * rise + grain * (1 - out),
            half_z * flat * math.sin(turn) + 0.004 * rise)


vertices, triangles = [place(0.0, 0.0)], []
for ring in range(1, rings + 1):
    for k in range(around):
        vertices.append(place(2 * math.pi * (k + 0.5 * (ring % 2)) / around, ring / rings))
at = lambda ring, k: 1 + (ring - 1) * around + k % around
triangles += [(0, at(1, k + 1), at(1, k)) for k in range(around)]
for ring in range(1, rings):
    for k in range(around):
        a, b, c, d = at(ring, k), at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)
        triangles += [(a, b, c), (b, d, c)] if ring % 2 == 0 else [(a, b, d), (a, d, c)]
middle = len(vertices)
vertices.append((0.0, 0.0, 0.0))
triangles += [(middle, at(rings, k), at(rings, k + 1)) for k in range(around)]

# What a scanner does.
centre = lambda t: [sum(vertices[v][axis] for v in t) / 3 for axis in range(3)]
far = lambda t, x, z: math.hypot(centre(t)[0] - x, centre(t)[2] - z)
triangles = [t for t in triangles
             if centre(t)[1] < 0.005 or (far(t, 0.045, 0.02) > 0.006 and far(t, -0.03, -0.03) > 0.004)]
triangles += triangles[900:930]
triangles = [t[::-1] if i % 11 == 0 else t for i, t in enumerate(triangles)]
tip = at(20, 10)
x, y, z = vertices[tip]
first = len(vertices)
vertices += [(x + 0.0007, y + 0.0012, z), (x - 0.0007, y + 0.0012, z), (x, y + 0.0012, z + 0.0007)]
for face in ((tip, first, first + 1), (tip, first + 1, first + 2), (tip, first + 2, first),
             (first, first + 2, first + 1)):
    triangles.append(face)

folder = sys.argv[1]
shutil.copy(os.path.join(os.path.dirname(__file__), 'scan.toml'), folder)
with open(os.path.join(folder, 'scan.ply'), 'wb') as file:
    file.write(('ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\n'
                'property float y\nproperty float z\nelement face %d\n'
                'property list uchar int vertex_indices\nend_header\n'
                % (len(vertices), len(triangles))).encode())
    for vertex in vertices:
        file.write(struct.pack('<3f', *vertex))
    for triangle in triangles:
        file.write(struct.pack('<B3i', 3, *triangle))
