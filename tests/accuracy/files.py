#!/usr/bin/env python3
"""Presses bodies from files of many kinds, by the defaults, and counts how many ran.

  tests/accuracy/files.py PALPATE [FILE...]
  tests/accuracy/files.py PALPATE --places

Without files it writes its own: one ball in every format of surfaces, the same with the faults that
scans have, and one block in every format and kind of cells. A file of somebody else is pressed from
above (z, or y for .obj) by a finger of a twenty-fifth of the body's size, in the unit with which
that is between 3 and 70 cm. A line says what happened, processor time, and memory.

With --places one uneven body is pressed from six sides, by `up`, by `towards` and as a turned file,
and another with a lump is moved to four places of its file.
"""
import base64
import csv
import math
import os
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import zlib


def ball(rings=16, around=24):
    """Vertices (mm) and triangles, outwards, of an ellipsoid of 60 x 50 x 40 mm."""
    points = [(30.0, 25.0, 0.0)]
    for i in range(1, rings):
        polar = math.pi * i / rings
        for k in range(around):
            turn = 2 * math.pi * (k + 0.5 * (i % 2)) / around
            points.append((30 + 30 * math.sin(polar) * math.cos(turn),
                           25 + 25 * math.sin(polar) * math.sin(turn), 20 - 20 * math.cos(polar)))
    points.append((30.0, 25.0, 40.0))
    at = lambda i, k: 1 + (i - 1) * around + k % around
    faces = [(0, at(1, k + 1), at(1, k)) for k in range(around)]
    for i in range(1, rings - 1):
        for k in range(around):
            a, b, c, d = at(i, k), at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)
            faces += [(a, b, c), (b, d, c)] if i % 2 == 0 else [(a, b, d), (a, d, c)]
    faces += [(len(points) - 1, at(rings - 1, k), at(rings - 1, k + 1)) for k in range(around)]
    return points, faces


def lines(rows):
    return '\n'.join(' '.join(str(word) for word in row) for row in rows) + '\n'


def stl(points, faces):
    text = 'solid body\n'
    for face in faces:
        text += 'facet normal 0 0 0\nouter loop\n'
        text += ''.join('vertex %.9g %.9g %.9g\n' % points[v] for v in face)
        text += 'endloop\nendfacet\n'
    return (text + 'endsolid body\n').encode()


def binary_stl(points, faces, first):
    body = first.ljust(80).encode() + struct.pack('<I', len(faces))
    for face in faces:
        body += struct.pack('<12fH', 0, 0, 0, *points[face[0]], *points[face[1]], *points[face[2]],
                            0)
    return body


def off(points, faces):
    return ('OFF\n%d %d 0\n' % (len(points), len(faces)) + lines(points) +
            lines((len(f),) + tuple(f) for f in faces)).encode()


def obj(points, faces, negative=False):
    text = 'o body\ng left\n' + lines(('v',) + p for p in points) + 'vn 0 0 1\ng right\n'
    number = (lambda v: v - len(points)) if negative else (lambda v: v + 1)
    return (text + lines(['f'] + ['%d//1' % number(v) for v in f] for f in faces)).encode()


def ply(points, faces, order):
    form = {'': 'ascii', '<': 'binary_little_endian', '>': 'binary_big_endian'}[order]
    head = ('ply\nformat %s 1.0\ncomment a scanner\nelement vertex %d\nproperty float x\n'
            'property float y\nproperty float z\nproperty uchar red\nproperty float quality\n'
            'element face %d\nproperty uchar flag\nproperty list uchar int vertex_indices\n'
            'end_header\n' % (form, len(points), len(faces))).encode()
    if not order:
        return head + (lines(p + (9, 0.5) for p in points) + lines((0, 3) + f for f in faces)).encode()
    return (head + b''.join(struct.pack(order + '3fBf', *p, 9, 0.5) for p in points) +
            b''.join(struct.pack(order + 'BB3i', 0, 3, *f) for f in faces))


def strips(points, faces):
    flat = [v for f in faces for v in f + (-1,)]
    return ('ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n'
            'property float z\nelement tristrips 1\nproperty list int int vertex_indices\n'
            'end_header\n' % len(points) + lines(points) + lines([[len(flat)] + flat])).encode()


def vtk(points, cells, types, order=''):
    head = '# vtk DataFile Version 3.0\nbody\n%s\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n' % (
        'BINARY' if order else 'ASCII', len(points))
    sizes = 'CELLS %d %d\n' % (len(cells), sum(len(c) + 1 for c in cells))
    kinds = 'CELL_TYPES %d\n' % len(cells)
    if not order:
        return (head + lines(points) + sizes + lines((len(c),) + tuple(c) for c in cells) + kinds +
                lines((t,) for t in types)).encode()
    pack = lambda code, values: struct.pack('>%d%s' % (len(values), code), *values) + b'\n'
    return (head.encode() + pack('d', [x for p in points for x in p]) + sizes.encode() +
            pack('i', [x for c in cells for x in (len(c),) + tuple(c)]) + kinds.encode() +
            pack('i', types))


def vtu(points, cells, types, packed=False):
    """As meshio and pyvista write it: base64, plain or compressed by zlib."""
    def array(name, code, kind, values, parts=1):
        raw = struct.pack('<%d%s' % (len(values), code), *values)
        if packed:
            small = zlib.compress(raw)
            data = (base64.b64encode(struct.pack('<4I', 1, len(raw), len(raw), len(small))) +
                    base64.b64encode(small))
        else:
            data = base64.b64encode(struct.pack('<I', len(raw)) + raw)
        return '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="binary">%s</DataArray>' % (
            kind, name, parts, data.decode())
    ends, total = [], 0
    for cell in cells:
        total += len(cell)
        ends.append(total)
    return ('<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1" '
            'byte_order="LittleEndian" header_type="UInt32"%s><UnstructuredGrid><Piece '
            'NumberOfPoints="%d" NumberOfCells="%d"><Points>%s</Points><Cells>%s%s%s</Cells></Piece>'
            '</UnstructuredGrid></VTKFile>' %
            (' compressor="vtkZLibDataCompressor"' if packed else '', len(points), len(cells),
             array('Points', 'd', 'Float64', [x for p in points for x in p], 3),
             array('connectivity', 'q', 'Int64', [v for c in cells for v in c]),
             array('offsets', 'q', 'Int64', ends),
             array('types', 'B', 'UInt8', types))).encode()


def gmsh(points, cells, types, version, binary=False):
    count = len(points)
    if version == 1:
        text = '$NOD\n%d\n' % count + lines((i + 1,) + p for i, p in enumerate(points))
        text += '$ENDNOD\n$ELM\n%d\n' % len(cells)
        text += lines([i + 1, t, 7, 1, len(c)] + [v + 1 for v in c]
                      for i, (t, c) in enumerate(zip(types, cells)))
        return (text + '$ENDELM\n').encode()
    head = b'$MeshFormat\n%s %d 8\n' % (b'2.2' if version == 2 else b'4.1', binary)
    out = head + (struct.pack('<i', 1) + b'\n' if binary else b'') + b'$EndMeshFormat\n'
    if version == 2:
        out += b'$Nodes\n%d\n' % count
        out += (b''.join(struct.pack('<i3d', i + 1, *p) for i, p in enumerate(points)) + b'\n'
                if binary else lines((i + 1,) + p for i, p in enumerate(points)).encode())
        out += b'$EndNodes\n$Elements\n%d\n' % len(cells)
        for i, (t, c) in enumerate(zip(types, cells)):
            words = [i + 1, 7, 1] + [v + 1 for v in c]
            out += (struct.pack('<3i%di' % len(words), t, 1, 2, *words)
                    if binary else lines([[i + 1, t, 2, 7, 1] + words[3:]]).encode())
        return out + (b'\n' if binary else b'') + b'$EndElements\n'
    kinds = sorted(set(types))
    if binary:
        out += b'$Nodes\n' + struct.pack('<4q', 1, count, 1, count) + struct.pack('<3iq', 3, 1, 0, count)
        out += struct.pack('<%dq' % count, *range(1, count + 1))
        out += b''.join(struct.pack('<3d', *p) for p in points) + b'\n$EndNodes\n$Elements\n'
        out += struct.pack('<4q', len(kinds), len(cells), 1, len(cells))
    else:
        out += ('$Nodes\n1 %d 1 %d\n3 1 0 %d\n' % (count, count, count) +
                lines((i + 1,) for i in range(count)) + lines(points) +
                '$EndNodes\n$Elements\n%d %d 1 %d\n' % (len(kinds), len(cells), len(cells))).encode()
    number = 0
    for kind in kinds:
        own = [c for c, t in zip(cells, types) if t == kind]
        out += struct.pack('<3iq', 3, 1, kind, len(own)) if binary else b'3 1 %d %d\n' % (kind, len(own))
        for cell in own:
            number += 1
            words = [number] + [v + 1 for v in cell]
            out += struct.pack('<%dq' % len(words), *words) if binary else lines([words]).encode()
    return out + (b'\n' if binary else b'') + b'$EndElements\n'


def block(nx=10, ny=8, nz=5):
    """Points (mm) and hexahedra of a block of 60 x 50 x 30 mm."""
    at = lambda i, j, k: i + (nx + 1) * (j + (ny + 1) * k)
    points = [(60.0 * i / nx, 50.0 * j / ny, 30.0 * k / nz)
              for k in range(nz + 1) for j in range(ny + 1) for i in range(nx + 1)]
    cells = [[at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
              at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)]
             for k in range(nz) for j in range(ny) for i in range(nx)]
    return points, cells


def prisms(cells):
    return [c for h in cells for c in ([h[0], h[1], h[2], h[4], h[5], h[6]],
                                       [h[0], h[2], h[3], h[4], h[6], h[7]])]


def pyramids(points, cells):
    points, found = list(points), []
    for h in cells:
        points.append(tuple(sum(points[v][x] for v in h) / 8 for x in range(3)))
        tip = len(points) - 1
        for side in ((0, 1, 2, 3), (7, 6, 5, 4), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)):
            found.append([h[v] for v in side] + [tip])
    return points, found


def tetrahedra(cells):
    ways = ((1, 2), (1, 5), (3, 2), (3, 7), (4, 5), (4, 7))
    found = []
    for h in cells:
        for one, two in ways:
            found.append([h[0], h[one], h[two], h[6]])
    return found


def second_order(points, cells):
    points, middle, found = list(points), {}, []
    for cell in cells:
        nodes = list(cell)
        for a, b in ((0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3)):  # the order of Gmsh
            key = tuple(sorted((cell[a], cell[b])))
            if key not in middle:
                middle[key] = len(points)
                points.append(tuple((points[key[0]][x] + points[key[1]][x]) / 2 for x in range(3)))
            nodes.append(middle[key])
        found.append(nodes)
    return points, found


def write_own(folder):
    p, f = ball()
    save = {}
    save['ascii.stl'] = stl(p, f)
    save['binary.stl'] = binary_stl(p, f, 'exported')
    save['binary_called_solid.stl'] = binary_stl(p, f, 'solid exported')
    save['plain.off'] = off(p, f)
    save['groups.obj'] = obj(p, f)
    save['negative.obj'] = obj(p, f, True)
    for name, order in (('ascii', ''), ('little', '<'), ('big', '>')):
        save[name + '.ply'] = ply(p, f, order)
    save['strips.ply'] = strips(p, f)
    save['triangles.vtk'] = vtk(p, f, [5] * len(f))
    save['triangles.vtu'] = vtu(p, f, [5] * len(f))
    # What scans have.
    hole = [t for t in f if not (min(p[v][0] for v in t) > 57)]
    save['holes.off'] = off(p, hole)
    save['doubled_triangles.off'] = off(p, f + f[40:60])
    save['turned_triangles.off'] = off(p, [t[::-1] if i % 7 == 0 else t for i, t in enumerate(f)])
    save['inside_out.off'] = off(p, [t[::-1] for t in f])
    save['unjoined.off'] = off([tuple(p[v]) for t in f for v in t],
                               [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(f))])
    near = [tuple(x + 1e-6 * ((7 * i + 3 * k) % 5 - 2) for k, x in enumerate(p[v]))
            for i, v in enumerate(v for t in f for v in t)]
    save['nearly_joined.off'] = off(near, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(f))])
    top = len(p) - 1  # a small tetrahedron stands on the highest vertex with its tip
    more = p + [(29.0, 24.0, 42.0), (31.0, 24.0, 42.0), (30.0, 26.0, 42.0)]
    n = len(p)
    save['shared_vertex.off'] = off(more, f + [(top, n + 1, n), (top, n + 2, n + 1), (top, n, n + 2),
                                               (n, n + 1, n + 2)])
    dent = list(p)
    dent[200] = tuple(x + 0.35 * (y - x) for x, y in zip(p[200], (30, 25, 20)))
    dent[201] = tuple(x + 0.2 * (y - x) for x, y in zip(p[202], (30, 25, 20)))
    save['crossing.off'] = off(dent, f)
    save['two_parts.off'] = off(p + [(x / 5 + 80, y / 5, z / 5) for x, y, z in p],
                                f + [tuple(v + n for v in t) for t in f])
    quads = []
    for i in range(1, 15):
        for k in range(24):
            a, b = 1 + (i - 1) * 24 + k, 1 + (i - 1) * 24 + (k + 1) % 24
            quads.append((a, b, b + 24, a + 24))
    caps = [t for t in f if 0 in t or top in t]
    q, _ = ball()
    q = [q[0]] + [(30 + 30 * math.sin(math.pi * i / 16) * math.cos(2 * math.pi * k / 24),
                   25 + 25 * math.sin(math.pi * i / 16) * math.sin(2 * math.pi * k / 24),
                   20 - 20 * math.cos(math.pi * i / 16))
                  for i in range(1, 16) for k in range(24)] + [q[-1]]
    save['quadrangles.obj'] = obj(q, quads + caps)
    # Solids.
    b, hexahedra = block()
    tets = tetrahedra(hexahedra)
    wide, ten = second_order(b, tets)
    for version in (1, 2, 4):
        save['tets_%d.msh' % version] = gmsh(b, tets, [4] * len(tets), version)
    for version in (2, 4):
        save['tets_binary_%d.msh' % version] = gmsh(b, tets, [4] * len(tets), version, True)
        save['second_order_%d.msh' % version] = gmsh(wide, ten, [11] * len(ten), version, version == 4)
    save['hexahedra.msh'] = gmsh(b, hexahedra, [5] * len(hexahedra), 2)
    half = len(hexahedra) // 2
    mixed = hexahedra[:half] + prisms(hexahedra[half:])
    save['mixed.vtk'] = vtk(b, mixed, [12] * half + [13] * (len(mixed) - half), 'b')
    save['prisms.vtu'] = vtu(b, prisms(hexahedra), [13] * 2 * len(hexahedra))
    tips, five = pyramids(b, hexahedra)
    save['pyramids.vtu'] = vtu(tips, five, [14] * len(five), True)
    save['tets.vtk'] = vtk(b, tets, [10] * len(tets))
    save['tets.mesh'] = ('MeshVersionFormatted 2\nDimension 3\nVertices\n%d\n' % len(b) +
                         lines(x + (0,) for x in b) + 'Tetrahedra\n%d\n' % len(tets) +
                         lines([v + 1 for v in t] + [3] for t in tets) + 'End\n').encode()
    save['tets.inp'] = ('*HEADING\nbody\n*NODE\n' + ''.join(
        '%d, %.9g, %.9g, %.9g\n' % ((i + 1,) + x) for i, x in enumerate(b)) +
        '*ELEMENT, TYPE=C3D4, ELSET=SOFT\n' + ''.join(
            ', '.join(str(v) for v in [i + 1] + [n + 1 for n in t]) + '\n'
            for i, t in enumerate(tets))).encode()
    save['tets.node'] = ('%d 3 0 0\n' % len(b) + lines((i,) + x for i, x in enumerate(b))).encode()
    save['tets.ele'] = ('%d 4 0\n' % len(tets) + lines([i] + t for i, t in enumerate(tets))).encode()
    paths = []
    for name, content in save.items():
        path = os.path.join(folder, name)
        with open(path, 'wb') as file:
            file.write(content)
        if not name.endswith('.ele'):
            paths.append(path)
    return paths


def measured(command, seconds):
    """Exit code, output, processor seconds and peak memory (MB) with all children."""
    script = ('import resource, subprocess, sys\n'
              'done = subprocess.run(sys.argv[1:], capture_output=True, text=True)\n'
              'use = resource.getrusage(resource.RUSAGE_CHILDREN)\n'
              'sys.stdout.write(done.stdout)\nsys.stderr.write(done.stderr)\n'
              'print("%d %f %d" % (done.returncode, use.ru_utime + use.ru_stime, use.ru_maxrss))\n')
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    child = subprocess.Popen([sys.executable, '-c', script] + command, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, preexec_fn=limit,
                             start_new_session=True)
    try:
        out, err = child.communicate(timeout=4 * seconds)
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.communicate()
        return -9, '', 'took more than %d s' % (4 * seconds), float(seconds), 0.0
    lines_out = out.strip().split('\n')
    try:
        code, time, memory = lines_out[-1].split()
    except ValueError:
        return -9, '', err, float(seconds), 0.0
    return int(code), '\n'.join(lines_out[:-1]), err, float(time), float(memory) / 1024


def size_of(palpate, path):
    """The largest extent in the file's unit, from palpate's own box; None if it cannot be read."""
    solid = not re.search(r'\.(stl|obj|off|ply|vtp)$', path.lower())
    code, out, err, _, _ = measured([palpate, 'convert', path, '--unit', 'mm', '--csv'], 200)
    found = [float(x) for x in re.findall(r'(?:lowest|highest)_._mm,([-0-9.e+]+)', out)]
    if len(found) == 6:
        return max(found[2 * i + 1] - found[2 * i] for i in range(3))
    if solid and not found:
        return None
    numbers = []
    with open(path, 'rb') as file:
        for line in file.read().decode('latin1').split('\n'):
            words = line.split()
            if words[:1] in (['v'], ['vertex']):
                words = words[1:]
            elif not path.endswith('.off') or len(words) != 3:
                continue
            try:
                numbers.append([float(x) for x in words[:3]])
            except ValueError:
                pass
    if not numbers:
        return None
    return max(max(n[i] for n in numbers) - min(n[i] for n in numbers) for i in range(3))


def scenario(path, unit, size, up, faces=False):
    surface = (faces or re.search(r'\.(stl|obj|off|ply|vtp)$', path.lower())
               or 'triangles' in os.path.basename(path))
    radius = 40.0 * size
    shape = ('shape = { file = "%s", unit = "%s", up = "%s" }' % (path, unit, up) if surface else
             'shape = { kind = "as_meshed", up = "%s" }\nmesh = { file = "%s", unit = "%s" }' %
             (up, path, unit))
    return ('schema = 1\n[tissue]\nmaterial = "muscle"\nyoung_modulus = "5 kPa"\n%s\n[finger]\n'
            'radius = "%.4g mm"\n[[step]]\nkind = "indent"\nto = "%.4g mm"\nrate = "5 mm/s"\n'
            '[output]\ninterval = "50 ms"\n' % (shape, radius, 0.1 * radius))


def findings_of(result):
    with open(os.path.join(result, 'asked', 'findings.csv')) as file:
        heads, values = list(csv.reader(file))[:2]
    return dict(zip(heads, values))


def bulging(points, at=(48.0, 35.0, 30.0), by=0.25):
    """The ball with a bulge, so that no two sides are alike."""
    centre = (30.0, 25.0, 20.0)
    grown = lambda p: 1 + by * math.exp(-sum((x - y) ** 2 for x, y in zip(p, at)) / 150)
    return [tuple(c + (x - c) * grown(p) for x, c in zip(p, centre)) for p in points]


def places(palpate):
    points, faces = ball()
    points = bulging(points)
    with tempfile.TemporaryDirectory() as folder:
        def force(points, shape='', finger='', rest=''):
            with open(os.path.join(folder, 'body.off'), 'wb') as file:
                file.write(off(points, faces))
            with open(os.path.join(folder, 'asked.toml'), 'w') as file:
                file.write('schema = 1\n[tissue]\nyoung_modulus = "10 kPa"\npoisson_ratio = 0.4\n'
                           'viscosity = "none"\nshape = { file = "body.off", unit = "mm"%s }\n'
                           '[finger]\nradius = "4 mm"\n%s\n[[step]]\nkind = "indent"\nto = "1 mm"\n'
                           '%s' % (shape, finger, rest))
            result = os.path.join(folder, 'result')
            subprocess.run([palpate, 'run', os.path.join(folder, 'asked.toml'), '--out', result,
                            '--force', '--quiet'], check=True, capture_output=True)
            row = findings_of(result)
            return '%.3f (%.1f)' % (1e3 * float(row['peak_force_N']),
                                    100 * float(row['stated_error']))
        print('| pressed side | by `up`, mN (stated, %) | by `towards` and `base_side` | turned file |')
        print('|---|---|---|---|')
        for side, turn in (('x', lambda p: (-p[2], p[1], p[0])), ('-x', lambda p: (p[2], p[1], -p[0])),
                           ('y', lambda p: (p[0], -p[2], p[1])), ('-y', lambda p: (p[0], p[2], -p[1])),
                           ('z', lambda p: p), ('-z', lambda p: (p[0], -p[1], -p[2]))):
            other = side[1:] if side[0] == '-' else '-' + side
            print('| %s | %s | %s | %s |' % (
                side, force(points, ', up = "%s"' % side),
                force(points, ' }\nbase_side = "%s" #' % other, 'towards = "%s"' % other),
                force([turn(p) for p in points])), flush=True)
        print('\n| body with a lump | mN (stated, %) |\n|---|---|')
        for name, shift in (('from the corner of its box', (0, 0, 0)), ('about its middle', (-30, -25, -20)),
                            ('far away', (1000, -500, 200))):
            lump = ('[[region]]\nkind = "sphere"\ncentre = ["%g mm", "%g mm", "%g mm"]\nradius = "6 mm"\n'
                    'young_modulus = "100 kPa"\n' % (30 + shift[0], 25 + shift[1], 30 + shift[2]))
            print('| %s | %s |' % (name, force([tuple(x + s for x, s in zip(p, shift)) for p in points],
                                               rest=lump)), flush=True)


def main():
    palpate = os.path.abspath(sys.argv[1])
    if sys.argv[2:] == ['--places']:
        places(palpate)
        return
    given = [os.path.abspath(path) for path in sys.argv[2:]]
    with tempfile.TemporaryDirectory() as folder:
        paths = given or write_own(folder)
        ran = mended = 0
        print('| file | outcome | force (mN) | stated error (%) | processor time (s) | memory (MB) |')
        print('|---|---|---|---|---|---|')
        for path in paths:
            name = os.path.basename(path)
            unit, size, up = 'mm', 0.06, 'z'
            if given:
                own = size_of(palpate, path)
                unit, factor = next(((u, x) for u, x in (('um', 1e-6), ('mm', 1e-3), ('cm', 1e-2), ('m', 1.0))
                                     if own and 0.03 <= own * x <= 0.7), ('mm', 1e-3))
                size = (own or 100.0) * factor
                up = 'y' if name.endswith('.obj') else 'z'
            asked = os.path.join(folder, 'asked.toml')
            with open(asked, 'w') as file:
                file.write(scenario(path, unit, size, up))
            result = os.path.join(folder, 'result')
            command = [palpate, 'run', asked, '--out', result, '--force']
            code, out, err, time, memory = measured(command, 300)
            if 'holds faces alone' in err:  # a .vtk, .vtu or .msh of triangles
                with open(asked, 'w') as file:
                    file.write(scenario(path, unit, size, up, True))
                code, out, err, time, memory = measured(command, 300)
            force = error = ''
            if code == 0:
                ran += 1
                row = findings_of(result)
                force = '%.4g' % (1e3 * float(row['peak_force_N']))
                error = '%.1f' % (100 * float(row['stated_error'])) if row.get('stated_error') else ''
                with open(os.path.join(result, 'asked', 'report.html')) as file:
                    was = 'was mended' in file.read()
                mended += was
                outcome = 'ran, mended' if was else 'ran'
            else:
                said = [line for line in err.strip().split('\n') if 'equilibrium' in line or 'gives way' in line
                        or 'snaps away' in line] or err.strip().split('\n') or ['']
                outcome = 'exit %d: %s' % (code, said[-1])
            outcome = outcome.replace(os.path.dirname(path) + '/', '').replace(folder + '/', '').replace('|', '/')
            print('| %s | %s | %s | %s | %.1f | %.0f |' % (name, outcome, force, error, time, memory),
                  flush=True)
        print('\n%d of %d ran, %d of them mended.' % (ran, len(paths), mended))


if __name__ == '__main__':
    main()
