"""Rigid frictionless sphere on a clamped block in linear elasticity, by GetFEM: the pieces.

Hexahedra with 27 nodes, graded towards the contact. MUMPS eliminates everything but the surface
nodes that may touch, once a mesh; what is left is a small dense problem for every depth and
radius. Lengths in mm, stiffness in kPa, so forces in mN.
"""
import ctypes
import os
import subprocess
import tempfile

import getfem
import numpy as np
import scipy.linalg
import scipy.sparse


# ---- meshes ------------------------------------------------------------------------------------

def growing(start, length, first, count):
    """Borders of `count` elements from start to start + length, in geometric growth from first."""
    powers = np.arange(count)
    low, high = 0.1, 100.0
    for _ in range(100):  # bisection for the ratio of neighbours
        ratio = np.sqrt(low * high)
        low, high = (ratio, high) if first * np.sum(ratio ** powers) < length else (low, ratio)
    sizes = np.cumsum(ratio ** powers)
    return start + length * np.concatenate([[0.0], sizes / sizes[-1]])


def elements_to(length, first, ratio):
    """How many elements reach length when each is `ratio` times its neighbour."""
    return np.log(1.0 + length * (ratio - 1.0) / first) / np.log(ratio)


def half_axis(length, zone, level, ratio=1.45):
    """`level` equal elements from 0 to zone, then growing ones to length.

    The growth is `ratio` at level 16; fewer elements grow faster, so that all meshes of a family
    are the same map of a finer or coarser grid.
    """
    finest = elements_to(length - zone, zone / 16.0 * ratio, ratio)
    outer = max(1, round(finest * level / 16.0))
    size = zone / level
    return np.concatenate([np.linspace(0.0, zone, level + 1)[:-1],
                           growing(zone - size, length - zone + size, size, outer + 1)[1:]])


def down_axis(bounds, zone, level, ratio=1.3):
    """Borders along z from the bottom up to 0; bounds: depths of the layers' bottoms."""
    borders = np.array([0.0])
    for bottom in bounds:
        size = borders[-1] - borders[-2] if len(borders) > 1 else zone / level
        finest = elements_to(bottom - borders[-1], size * level / 16.0, ratio)
        count = max(2, round(finest * level / 16.0))
        part = growing(borders[-1], bottom - borders[-1], size, count)
        borders = np.concatenate([borders, part[1:]])
    return -borders[::-1]


def places(axis):
    """Places of the nodes of a quadratic line."""
    result = np.empty(2 * len(axis) - 1)
    result[::2] = axis
    result[1::2] = 0.5 * (axis[1:] + axis[:-1])
    return result


def loads(axis):
    """Load of each node of a quadratic line under a unit pressure: 1/6, 4/6, 1/6 of an element."""
    result = np.zeros(2 * len(axis) - 1)
    for i, size in enumerate(np.diff(axis)):
        result[2 * i:2 * i + 3] += size * np.array([1.0, 4.0, 1.0]) / 6.0
    return result


# ---- stiffness ---------------------------------------------------------------------------------

def stiffness(axes, layers, base):
    """Stiffness matrix, places (3 x unknowns) and free unknowns of a block.

    axes: element borders along x, y, z; z = 0 is the pressed top. layers: (depth of the bottom,
    E, nu) from the top down. base: "clamped" or "frictionless". x = 0 and y = 0 are mirrors where
    the block ends there; the other sides are free. The volume change acts by its projection on
    1, x, y, z in each element (the Q2/P1 pair), so nothing locks as nu comes near 1/2.
    """
    mesh = getfem.Mesh("cartesian", *axes)
    displacement, pressure, constant = (getfem.MeshFem(mesh, size) for size in (3, 1, 1))
    displacement.set_fem(getfem.Fem("FEM_QK(3,2)"))
    pressure.set_fem(getfem.Fem("FEM_QK_DISCONTINUOUS(3,1)"))
    constant.set_fem(getfem.Fem("FEM_QK(3,0)"))
    integration = getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(3,5)"))
    depth = -constant.basic_dof_nodes()[2]
    lame, shear = np.empty_like(depth), np.empty_like(depth)
    for bottom, modulus, nu in reversed(layers):
        lame[depth < bottom] = modulus * nu / ((1 + nu) * (1 - 2 * nu))
        shear[depth < bottom] = modulus / (2 * (1 + nu))
    matrix = to_scipy(getfem.asm_linear_elasticity(integration, displacement, constant,
                                                   np.zeros_like(lame), shear))
    # Eight corner values of the pressure in each element; a linear function is given by them.
    corners = pressure.basic_dof_from_cvid()[0].reshape(-1, 8)
    at = pressure.basic_dof_nodes()[:, corners]
    span = np.ptp(at, axis=2)
    local = 2.0 * (at - at.mean(axis=2, keepdims=True)) / span[:, :, None]  # -1 and 1
    linear = np.concatenate([np.ones((1, *corners.shape)), local]).transpose(1, 0, 2)
    elements = len(corners)
    pick = scipy.sparse.csr_matrix(
        (linear.ravel(), (np.repeat(np.arange(4 * elements), 8),
                          np.repeat(corners[:, None, :], 4, axis=1).ravel())))
    coupling = getfem.asm_generic(
        integration, 2, "p*Div_u", -1, "u", 1, displacement, np.zeros(displacement.nbdof()),
        "p", 1, pressure, np.zeros(pressure.nbdof()), "select_output", "p", "u")
    divergence = pick @ to_scipy(coupling)
    # int 1 = V and int xi^2 = V/3 over the element, the products of two different ones vanish.
    first = constant.basic_dof_from_cvid()[0]
    size = (lame[first] / np.prod(span, axis=0))[:, None] * np.array([1.0, 3.0, 3.0, 3.0])
    matrix = matrix + divergence.T @ scipy.sparse.diags(size.ravel()) @ divergence
    where = displacement.basic_dof_nodes()
    direction = np.arange(where.shape[1]) % 3  # three directions of a node in a row
    tiny = 1e-7
    fixed = (direction == 2) & (where[2] < axes[2][0] + tiny)
    if base == "clamped":
        fixed |= where[2] < axes[2][0] + tiny
    for side in (0, 1):
        if axes[side][0] == 0.0:
            fixed |= (direction == side) & (where[side] < tiny)
    return matrix.tocsc(), where, np.flatnonzero(~fixed)


def to_scipy(matrix):
    """The same matrix as SciPy keeps it."""
    starts, rows = matrix.csc_ind()
    return scipy.sparse.csc_matrix((matrix.csc_val(), rows, starts), shape=matrix.size())


def dissection(index):
    """Nested dissection: an order of elimination of the nodes of a box of quadratic elements.

    index: 3 x nodes, whole numbers, even on element borders. The longest side is halved at a plane
    of element borders, and that plane comes after both halves.
    """
    def cut(members):
        at = index[:, members]
        low, high = at.min(axis=1), at.max(axis=1)
        side = np.argmax(high - low)
        middle = (low[side] + high[side]) // 4 * 2
        if middle <= low[side] or middle >= high[side] or len(members) < 60:
            return [members]
        along = at[side]
        return (cut(members[along < middle]) + cut(members[along > middle])
                + [members[along == middle]])
    return np.concatenate(cut(np.arange(index.shape[1])))


_compiled = []


def _library():
    if not _compiled:
        source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "condense.c")
        target = os.path.join(tempfile.mkdtemp(), "condense.so")
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-I/usr/include/mumps_seq", source,
                        "-o", target, "-ldmumps_seq"], check=True)
        _compiled.append(ctypes.CDLL(target))
    return _compiled[0]


def condense(matrix, order, kept):
    """Dense stiffness of the kept unknowns, the others free of load; and MUMPS's memory in MB."""
    lower = scipy.sparse.tril(matrix).tocoo()
    rows, columns = (lower.row + 1).astype(np.int32), (lower.col + 1).astype(np.int32)
    values = np.ascontiguousarray(lower.data)
    turn = np.empty(len(order), dtype=np.int32)
    turn[np.concatenate([order[~np.isin(order, kept)], kept])] = np.arange(1, len(order) + 1)
    listed = (kept + 1).astype(np.int32)
    dense = np.zeros((len(kept), len(kept)))
    memory = ctypes.c_int(0)
    start = lambda array: array.ctypes.data_as(ctypes.c_void_p)
    error = _library().condense(
        ctypes.c_int(matrix.shape[0]), ctypes.c_longlong(len(values)), start(rows), start(columns),
        start(values), start(turn), ctypes.c_int(len(kept)), start(listed), start(dense),
        ctypes.byref(memory))
    if error:
        raise RuntimeError(f"MUMPS stopped with {error}")
    triangle = np.tril(dense)
    return triangle + triangle.T - np.diag(np.diag(triangle)), memory.value


class Surface:
    """What the top's nodes within `reach` of the origin answer to forces on them.

    points: 2 x nodes. compliance: 3 nodes x 3 nodes, mm/mN; rows and columns that a mirror holds
    are zero. times: how many such parts make the block, 4 for a quarter, 2 for a half.
    """

    def __init__(self, axes, layers, base, reach):
        matrix, where, free = stiffness(axes, layers, base)
        number = -np.ones(matrix.shape[0], dtype=int)
        number[free] = np.arange(len(free))
        index = np.array([np.searchsorted(places(a), w - 1e-7) for a, w in zip(axes, where)])
        order = number[(3 * dissection(index[:, ::3])[:, None] + np.arange(3)).ravel()]
        top = np.flatnonzero((where[2] > -1e-7) & (np.hypot(*where[:2]) <= reach) & (number >= 0))
        dense, self.memory = condense(matrix[free][:, free], order[order >= 0], number[top])
        inverse = scipy.linalg.cho_solve(scipy.linalg.cho_factor(dense), np.eye(len(top)))
        node, slot = np.unique(top // 3, return_inverse=True)
        self.compliance = np.zeros((3 * len(node), 3 * len(node)))
        self.compliance[np.ix_(3 * slot + top % 3, 3 * slot + top % 3)] = inverse
        self.points = where[:2, 3 * node]
        self.times = 2 ** sum(axis[0] == 0.0 for axis in axes[:2])
        self.unknowns, self.reach = len(free), reach


# ---- contact -----------------------------------------------------------------------------------

def complementary(matrix, gap):
    """Forces p >= 0 with gap + matrix p >= 0 and p (gap + matrix p) = 0, by active sets."""
    active = gap < 0.0
    tiny = 1e-12 * np.max(np.abs(gap))
    for turn in range(400):
        force = np.zeros(len(gap))
        on = np.flatnonzero(active)
        force[on] = scipy.linalg.solve(matrix[np.ix_(on, on)], -gap[on], assume_a="pos")
        rest = gap + matrix @ force
        pulled = active & (force < 0.0)
        pierced = ~active & (rest < -tiny)
        if not pulled.any() and not pierced.any():
            return force
        if turn < 20:
            active = (active & ~pulled) | pierced
        elif pulled.any():  # one node at a time where whole sets go round in circles
            active[np.argmin(np.where(pulled, force, np.inf))] = False
        else:
            active[np.argmin(np.where(pierced, rest, np.inf))] = True
    raise RuntimeError("the set of touching nodes does not settle")


def contact_radius(force, radii):
    """Radius a of p = p0 sqrt(1 - r^2/a^2) (1 + c r^2/a^2) with the forces' moments of r^2, r^4.

    Smoother than the outline of the touching nodes, which moves by whole nodes.
    """
    second = np.sum(force * radii ** 2) / np.sum(force)
    fourth = np.sum(force * radii ** 4) / np.sum(force)
    # Moments of s^1, s^3, s^5, s^7 with sqrt(1 - s^2) over 0..1: 1/3, 2/15, 8/105, 16/315.
    square = lambda c: second * (1 / 3 + 2 * c / 15) / (2 / 15 + 8 * c / 105)
    miss = lambda c: (square(c) ** 2 * (8 / 105 + 16 * c / 315) / (1 / 3 + 2 * c / 15) - fourth)
    low, high = -0.9, 4.0
    for _ in range(100):
        c = 0.5 * (low + high)
        low, high = (c, high) if miss(low) * miss(c) > 0.0 else (low, c)
    return np.sqrt(square(c))


def vertical(surface, radius, depth, shape="sphere"):
    """Contact vertical at the undeformed radius: forces (3 x nodes) and displacements.

    The top's node at r goes down by depth - profile(r) or more, under vertical forces.
    """
    r = np.hypot(*surface.points)
    profile = radius - np.sqrt(radius ** 2 - r ** 2) if shape == "sphere" else r ** 2 / (2 * radius)
    down = complementary(surface.compliance[2::3, 2::3], profile - depth)
    forces = np.zeros((3, len(r)))
    forces[2] = -down
    return forces, (surface.compliance @ forces.T.ravel()).reshape(-1, 3).T


def normal(surface, radius, depth):
    """Contact along the sphere's normal: forces (3 x nodes) and displacements.

    A node X stays outside the sphere with its displacement, |X + u - centre| >= radius, and its
    force points along the sphere's normal at X + u. Each turn solves with the normals n of the
    turn before; they change by u over radius, so a handful of turns settles them.
    """
    count = surface.points.shape[1]
    offset = np.vstack([surface.points, np.full(count, depth - radius)])
    moved, last = np.zeros((3, count)), 0.0
    for _ in range(100):
        length = np.sqrt(np.sum((offset + moved) ** 2, axis=0))
        along = (offset + moved) / length
        spread = np.zeros((3 * count, count))
        for k in range(3):
            spread[3 * np.arange(count) + k, np.arange(count)] = along[k]
        reply = surface.compliance @ spread
        # |X + u' - c| - R with u' = reply p, to first order about the last u
        gap = length - radius - np.sum(along * moved, axis=0)
        push = complementary(spread.T @ reply, gap)
        moved = (reply @ push).reshape(count, 3).T
        total = np.sum(push)
        if abs(total - last) < 1e-10 * total:
            return along * push, moved
        last = total
    raise RuntimeError("the normals do not settle")


def answer(surface, forces, moved, deformed):
    """Total downward force and contact radius; deformed: whether at the displaced places."""
    if np.max(np.hypot(*surface.points)[forces[2] < 0.0]) > 0.97 * surface.reach:
        raise RuntimeError("the contact reaches the edge of the nodes that may touch")
    at = surface.points + (moved[:2] if deformed else 0.0)
    return -surface.times * np.sum(forces[2]), contact_radius(-forces[2], np.hypot(*at))


def press(surface, radius, depth):
    """(force, contact radius) of the vertical variant and of the normal one."""
    return (answer(surface, *vertical(surface, radius, depth), False),
            answer(surface, *normal(surface, radius, depth), True))
