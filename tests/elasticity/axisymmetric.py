"""A rigid frictionless sphere on a soft body of revolution, in small and in finite strain.

Quadrilaterals of 9 nodes; the volume change J - 1 is projected on linear functions in each element
(the Q2/P1 pair), so that nothing locks up to Poisson's ratio 0.4999. The energy is neo-Hookean,
    W = mu/2 (I1bar - 3) + kappa/2 (J - 1)^2,   I1bar = J^(-2/3) tr(F^T F),
and small-strain elasticity is its second derivative in the undeformed body. Contact acts at the
Gauss points of the top's edges through a stiff layer of springs, whose own share of the force is
taken off again. Any consistent units: mm and kPa give mN.
"""
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from axisymmetric_mesh import quadratic

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)
EDGE_POINTS, EDGE_WEIGHTS = np.polynomial.legendre.leggauss(4)
CENTRE = 4  # the node inside an element
EDGE_NODES = [k for k in range(9) if k != CENTRE]
BOUNDARY = np.array([2 * k + c for k in EDGE_NODES for c in (0, 1)])
INSIDE = np.array([2 * CENTRE, 2 * CENTRE + 1])


@dataclass
class Tangent:
    """Forces and stiffness of the elements in one state."""
    force: np.ndarray  # of all unknowns
    stiffness: np.ndarray  # (elements, 18, 18)
    least_volume: float  # the smallest J of all Gauss points


@dataclass
class Factored:
    """A stiffness ready to be solved with."""
    back: Callable  # from loads to displacements of what stays in the band
    definite: bool  # whether the equilibrium is stable
    inner: np.ndarray  # the inverse of the inner nodes' part
    link: np.ndarray  # their part with the others


@dataclass
class Touch:
    """What the springs of the contact say in one state."""
    force: float  # of the sphere on the body, downwards
    load: np.ndarray  # on all unknowns, as internal forces
    stiffness: np.ndarray  # (edges, 6, 6)
    push: np.ndarray  # the derivative of `load` by the depth
    radius: float  # of the outermost Gauss point in contact, deformed


class Solid:
    """A body on its base; `youngs` and `poisson` are those of the mesh's materials."""

    def __init__(self, mesh, youngs, poisson, base="bonded"):
        self.mesh = mesh
        youngs = np.atleast_1d(np.asarray(youngs, float))
        poisson = np.broadcast_to(np.asarray(poisson, float), youngs.shape)
        self.shear = (youngs / 2.0 / (1.0 + poisson))[mesh.material]
        self.bulk = (youngs / 3.0 / (1.0 - 2.0 * poisson))[mesh.material]
        self.plane_modulus = (youngs / (1.0 - poisson ** 2))[mesh.material[0]]  # at the top
        self.unknowns = 2 * len(mesh.points)
        self._number(base)
        self._prepare_elements()
        self._prepare_edges()

    def _number(self, base):
        """Places in the banded matrix: -1 for what is held or eliminated in its element."""
        held = np.zeros(self.unknowns, bool)
        held[2 * self.mesh.axis] = True
        held[2 * self.mesh.base + 1] = True
        if base == "bonded":
            held[2 * self.mesh.base] = True
        self.held = held
        kept = ~held
        inner = self.mesh.elements[:, CENTRE]
        kept[2 * inner] = kept[2 * inner + 1] = False
        self.place = np.full(self.unknowns, -1)
        self.place[kept] = np.arange(kept.sum())
        self.size = int(kept.sum())
        self.dofs = np.stack([2 * self.mesh.elements, 2 * self.mesh.elements + 1], 2)
        self.dofs = self.dofs.reshape(-1, 18)
        places = self.place[self.dofs[:, BOUNDARY]]
        least = np.where(places < 0, self.size, places).min(1)
        self.band = int((places.max(1) - least).max())
        self.element_slots = self._slots(places)

    def _slots(self, places):
        """Where the entries of small matrices go in the lower band, and which of them."""
        row, column = places[:, :, None], places[:, None, :]
        used = (row >= column) & (column >= 0)
        slots = (column * (self.band + 1) + row - column)[used]
        return slots, used

    def _prepare_elements(self):
        """The matrices from displacements to F, and the functions of the projected volume."""
        corners = self.mesh.points[self.mesh.elements]
        count = len(corners)
        centre = corners[:, CENTRE]
        size = np.abs(corners - centre[:, None]).max((1, 2))
        gradients, weights, linear = [], [], []
        for i, along in enumerate(POINTS):
            shape_a, slope_a = quadratic(along)
            for j, up in enumerate(POINTS):
                shape_b, slope_b = quadratic(up)
                shape = np.outer(shape_b, shape_a).ravel()
                local = np.stack([np.outer(shape_b, slope_a).ravel(),
                                  np.outer(slope_b, shape_a).ravel()])
                jacobian = local @ corners
                determinant = np.linalg.det(jacobian)
                if determinant.min() <= 0.0:
                    raise ValueError("an element of the mesh is turned over")
                slope = np.linalg.solve(jacobian, np.broadcast_to(local, (count, 2, 9)))
                place = shape @ corners
                matrix = np.zeros((count, 5, 18))  # F11, F12, F21, F22, F33
                matrix[:, 0, 0::2] = matrix[:, 2, 1::2] = slope[:, 0]
                matrix[:, 1, 0::2] = matrix[:, 3, 1::2] = slope[:, 1]
                matrix[:, 4, 0::2] = shape / place[:, :1]
                gradients.append(matrix)
                weights.append(2.0 * np.pi * place[:, 0] * determinant * WEIGHTS[i] * WEIGHTS[j])
                linear.append(np.concatenate([np.ones((count, 1)),
                                              (place - centre) / size[:, None]], 1))
        self.gradient = np.stack(gradients, 1)  # (elements, 9, 5, 18)
        self.weight = np.stack(weights, 1)
        linear = np.stack(linear, 1)
        mass = np.einsum("eg,egi,egj->eij", self.weight, linear, linear)
        factor = np.linalg.inv(np.linalg.cholesky(mass))
        self.projector = linear @ factor.transpose(0, 2, 1)  # orthonormal in each element

    def _prepare_edges(self):
        edges = self.mesh.top_edges
        shape, slope = zip(*[quadratic(s) for s in EDGE_POINTS])
        self.edge_shape = np.array(shape)  # (points, 3)
        corners = self.mesh.points[edges]
        self.edge_place = np.einsum("gk,ekc->egc", self.edge_shape, corners)
        length = np.linalg.norm(np.einsum("gk,ekc->egc", np.array(slope), corners), axis=2)
        self.edge_area = 2.0 * np.pi * self.edge_place[:, :, 0] * length * EDGE_WEIGHTS
        self.edge_dofs = np.stack([2 * edges, 2 * edges + 1], 2).reshape(-1, 6)
        self.edge_slots = self._slots(self.place[self.edge_dofs])
        span = np.linalg.norm(corners[:, 2] - corners[:, 0], axis=1)
        # Springs far stiffer than an element of the tissue: they give way by p h / (25 E*).
        self.spring = 25.0 * self.plane_modulus / span

    def tangent(self, u):
        """Forces and stiffness of the elements at the displacements u."""
        count = len(self.dofs)
        undeformed = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
        f = undeformed + (self.gradient.reshape(count, 45, 18)
                          @ u[self.dofs][:, :, None]).reshape(count, 9, 5)
        f11, f12, f21, f22, f33 = np.moveaxis(f, 2, 0)
        plane = f11 * f22 - f12 * f21
        volume = plane * f33
        least = volume.min()
        if least <= 0.0:
            return Tangent(None, None, least)
        slope = np.stack([f22 * f33, -f21 * f33, -f12 * f33, f11 * f33, plane], 2)
        bend = np.zeros((count, 9, 5, 5))
        for i, j, value in ((0, 3, f33), (1, 2, -f33), (0, 4, f22), (1, 4, -f21), (2, 4, -f12),
                            (3, 4, f11)):
            bend[:, :, i, j] = bend[:, :, j, i] = value
        # mu/2 J^(-2/3) I1 and its derivatives by F
        square = (f ** 2).sum(2)
        power = volume ** (-2.0 / 3.0) * self.shear[:, None] * self.weight
        first = power / volume
        change = (self.projector * ((volume - 1.0) * self.weight)[:, :, None]).sum(1)
        pressure = self.bulk[:, None] * (self.projector @ change[:, :, None])[:, :, 0]
        by_volume = pressure * self.weight - first * square / 3.0
        stress = by_volume[:, :, None] * slope + power[:, :, None] * f
        cross = (2.0 / 3.0 * first)[:, :, None, None] * slope[:, :, :, None] * f[:, :, None, :]
        moduli = by_volume[:, :, None, None] * bend - cross - np.swapaxes(cross, 2, 3)
        moduli += (5.0 / 9.0 * first / volume * square)[:, :, None, None] \
            * slope[:, :, :, None] * slope[:, :, None, :]
        moduli[:, :, np.arange(5), np.arange(5)] += power[:, :, None]
        flat = self.gradient.reshape(count, 45, 18)
        flat_turned = flat.transpose(0, 2, 1)
        force = (flat_turned @ stress.reshape(count, 45, 1))[:, :, 0]
        stiffness = flat_turned @ (moduli @ self.gradient).reshape(count, 45, 18)
        spread = self.weight[:, :, None, None] * slope[:, :, :, None] * self.projector[:, :, None]
        coupling = flat_turned @ spread.reshape(count, 45, 3)
        stiffness += (self.bulk[:, None, None] * coupling) @ coupling.transpose(0, 2, 1)
        total = np.bincount(self.dofs.ravel(), force.ravel(), self.unknowns)
        return Tangent(total, stiffness, least)

    def touch(self, u, radius, depth, kinematics):
        """The contact's springs; `kinematics` is `normal`, `vertical` or `paraboloid`."""
        moved = u[self.edge_dofs].reshape(-1, 3, 2)
        place = self.edge_place + np.einsum("gk,ekc->egc", self.edge_shape, moved)
        apex = self.mesh.points[self.mesh.top_edges[0, 0], 1]
        if kinematics == "normal":
            across = place[:, :, 0]
            above = place[:, :, 1] - (apex - depth + radius)
            distance = np.hypot(across, above)
            normal = np.stack([across, above], 2) / distance[:, :, None]
            gap = np.where(above < 0.0, distance - radius, 1.0)
            turning = gap / distance
        else:
            rest = self.edge_place[:, :, 0]
            lift = rest ** 2 / (2.0 * radius)
            if kinematics == "vertical":
                lift = radius - np.sqrt(np.maximum(radius ** 2 - rest ** 2, 0.0))
            gap = np.where((kinematics == "vertical") & (rest >= radius), 1.0,
                           apex - depth + lift - place[:, :, 1])
            normal = np.zeros(gap.shape + (2,))
            normal[:, :, 1] = -1.0
            turning = np.zeros(gap.shape)
        spring = np.where(gap < 0.0, self.spring[:, None] * self.edge_area, 0.0)
        pull = (spring * gap)[:, :, None] * normal
        load = np.einsum("gk,egc->ekc", self.edge_shape, pull).reshape(-1, 6)
        across = np.eye(2) - normal[:, :, :, None] * normal[:, :, None, :]
        local = spring[:, :, None, None] * (normal[:, :, :, None] * normal[:, :, None, :]
                                            + turning[:, :, None, None] * across)
        stiffness = np.einsum("gk,gl,egcd->ekcld", self.edge_shape, self.edge_shape, local)
        push = np.einsum("gk,egc->ekc", self.edge_shape, local[:, :, :, 1]).reshape(-1, 6)
        ids = self.edge_dofs.ravel()
        total = np.bincount(ids, load.ravel(), self.unknowns)
        active = gap < 0.0
        return Touch(force=pull[:, :, 1].sum(), load=total, stiffness=stiffness.reshape(-1, 6, 6),
                     push=np.bincount(ids, push.ravel(), self.unknowns),
                     radius=place[:, :, 0][active].max() if active.any() else 0.0)

    def factor(self, element_stiffness, edge_stiffness=None):
        """The banded matrix, factored, with the elements' inner nodes eliminated.

        Cholesky's factor, or that of Gauss with pivots where the matrix is not positive definite:
        on the way to an equilibrium, and in a body that would rather fold.
        """
        inner = np.linalg.inv(element_stiffness[:, INSIDE[:, None], INSIDE])
        link = element_stiffness[:, BOUNDARY[:, None], INSIDE]
        outer = element_stiffness[:, BOUNDARY[:, None], BOUNDARY] \
            - link @ inner @ link.transpose(0, 2, 1)
        slots, used = self.element_slots
        values = outer[used]
        if edge_stiffness is not None:
            more, edge_used = self.edge_slots
            slots = np.concatenate([slots, more])
            values = np.concatenate([values, edge_stiffness[edge_used]])
        matrix = np.bincount(slots, values, self.size * (self.band + 1))
        matrix = matrix.reshape(self.size, self.band + 1).T  # columns contiguous, as LAPACK wants
        factor, info = lapack.dpbtrf(matrix, lower=1)
        if info == 0:
            return Factored(lambda load: lapack.dpbtrs(factor, load, lower=1)[0], True, inner, link)
        band = self.band
        both = np.zeros((3 * band + 1, self.size), order="F")
        both[2 * band:] = matrix
        for offset in range(1, band + 1):
            both[2 * band - offset, offset:] = matrix[offset, :self.size - offset]
        factors, pivots, info = lapack.dgbtrf(both, band, band, overwrite_ab=1)
        return Factored(lambda load: lapack.dgbtrs(factors, band, band, load, pivots)[0], False,
                        inner, link)

    def solve(self, factored, load):
        """Displacements under `load`, both of all unknowns."""
        inner, link = factored.inner, factored.link
        load = np.where(self.held, 0.0, load)
        condensed = load.copy()
        inside = load[self.dofs[:, INSIDE]]
        passed = (link @ (inner @ inside[:, :, None]))[:, :, 0]
        condensed -= np.bincount(self.dofs[:, BOUNDARY].ravel(), passed.ravel(), self.unknowns)
        kept = self.place >= 0
        solution = factored.back(condensed[kept])
        result = np.zeros(self.unknowns)
        result[kept] = solution[self.place[kept]]
        moved = result[self.dofs[:, BOUNDARY]]
        rest = inside - (link.transpose(0, 2, 1) @ moved[:, :, None])[:, :, 0]
        result[self.dofs[:, INSIDE]] = (inner @ rest[:, :, None])[:, :, 0]
        return result


@dataclass
class Reading:
    """The rigid sphere's force at one depth."""
    depth: float
    force: float
    contact_radius: float
    least_volume: float  # 1 in small strain
    iterations: int
    stable: bool = True


def press(solid, radius, depths, most_iterations=14):
    """Finite strain: readings at growing depths; ends early where no equilibrium is found."""
    u = np.zeros(solid.unknowns)
    rate = None  # du/dh at the last depth
    reached, step, readings, spent = 0.0, depths[0], [], 0
    targets = list(depths)
    smallest = 1e-3 * depths[-1]
    while targets:
        depth = min(targets[0], reached + step)
        start = u if rate is None else u + (depth - reached) * rate
        found = _equilibrium(solid, radius, depth, start, most_iterations)
        spent += found[-1]
        if found[0] is None:
            step = 0.5 * (depth - reached)
            if step < smallest:
                break
            continue
        u, state, touch, factored, used = found
        rate = solid.solve(factored, -touch.push)
        reached = depth
        step = 2.0 * step if used <= 6 else step
        if depth >= targets[0] * (1.0 - 1e-12):
            readings.append(Reading(depth, _without_springs(touch, rate), touch.radius,
                                    state.least_volume, spent, factored.definite))
            targets.pop(0)
            step = max(step, targets[0] - reached) if targets else step
            spent = 0
    return readings


def _without_springs(touch, rate):
    """A rigid surface's force to first order: F + dU/dh with U the energy in the springs.

    U depends on the depth directly, by F, and through the displacements.
    """
    return touch.force + touch.force + touch.load @ rate


def _equilibrium(solid, radius, depth, u, most):
    """Newton's iterations at one depth; the first result is None where they fail."""
    failed = (None, None, None, None)
    for iteration in range(1, most + 1):
        state = solid.tangent(u)
        if state.force is None:
            return *failed, iteration
        touch = solid.touch(u, radius, depth, "normal")
        rest = np.where(solid.held, 0.0, state.force + touch.load)
        factored = solid.factor(state.stiffness, touch.stiffness)
        change = solid.solve(factored, -rest)
        largest = np.abs(change).max()
        if largest < 1e-6 * radius:
            return u, state, touch, factored, iteration
        if largest > 2.0 * radius:
            return *failed, iteration
        u = u + change
    return *failed, most


class SmallStrain:
    """Linear elasticity, condensed to the top's unknowns within `reach` of the axis."""

    def __init__(self, solid, reach):
        self.solid = solid
        factored = solid.factor(solid.tangent(np.zeros(solid.unknowns)).stiffness)
        edges = solid.edge_place[:, 0, 0] < reach
        self.edges = edges
        nodes = np.unique(solid.edge_dofs[edges])
        self.nodes = nodes[solid.place[nodes] >= 0]
        unit = np.zeros((solid.size, len(self.nodes)), order="F")
        unit[solid.place[self.nodes], np.arange(len(self.nodes))] = 1.0
        answer = factored.back(unit)
        compliance = answer[solid.place[self.nodes]]
        self.stiffness = np.linalg.inv(0.5 * (compliance + compliance.T))
        self.at = np.full(solid.unknowns, -1)
        self.at[self.nodes] = np.arange(len(self.nodes))

    def press(self, radius, depths, kinematics):
        """Readings at growing depths by one kinematics: `normal`, `vertical` or `paraboloid`."""
        solid = self.solid
        places = self.at[solid.edge_dofs]
        used = (places[:, :, None] >= 0) & (places[:, None, :] >= 0)
        rows = np.broadcast_to(places[:, :, None], used.shape)[used]
        columns = np.broadcast_to(places[:, None, :], used.shape)[used]
        slots = rows * len(self.nodes) + columns
        u, rate, reached, readings = np.zeros(solid.unknowns), 0.0, 0.0, []
        for depth in depths:
            u = u + (depth - reached) * rate
            for iteration in range(1, 80):
                touch = solid.touch(u, radius, depth, kinematics)
                matrix = self.stiffness + np.bincount(
                    slots, touch.stiffness[used], len(self.nodes) ** 2).reshape(
                        self.stiffness.shape)
                rest = self.stiffness @ u[self.nodes] + touch.load[self.nodes]
                change = np.linalg.solve(matrix, -rest)
                # Half steps end a cycle between two sets of touching points.
                u[self.nodes] += change if iteration < 20 else 0.5 * change
                if np.abs(change).max() < 1e-7 * radius:
                    break
            else:
                break
            rate = np.zeros(solid.unknowns)
            rate[self.nodes] = np.linalg.solve(matrix, -touch.push[self.nodes])
            reached = depth
            readings.append(Reading(depth, _without_springs(touch, rate), touch.radius, 1.0,
                                    iteration))
        return readings
