"""Meshes of bodies of revolution for axisymmetric.py: mapped grids of 9-node quadrilaterals."""
import numpy as np


def quadratic(s):
    """The three quadratic shape functions at s in [-1, 1], and their slopes."""
    return (np.array([0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)]),
            np.array([s - 0.5, -2.0 * s, s + 0.5]))


def growing(first, length, growth, largest=np.inf):
    """Borders from 0 to `length` of elements that start at `first` and grow up to `largest`."""
    borders, size = [0.0], first
    while borders[-1] + 0.6 * size < length:
        borders.append(borders[-1] + size)
        size = min(size * growth, largest)
    if len(borders) == 1:
        borders.append(length)
    return np.array(borders) * (length / borders[-1])


def chain(*parts):
    """Parts that each start at 0, one after the other."""
    borders = [np.zeros(1)]
    for part in parts:
        borders.append(borders[-1][-1] + np.asarray(part)[1:])
    return np.concatenate(borders)


class Mesh:
    """A grid of `across` by `down` borders, `down` from 0 at the top; mapped to (r, z).

    `mapping` takes and returns (n, 2); `material` takes the elements' middles before mapping.
    """

    def __init__(self, across, down, mapping=None, material=None):
        across, down = _with_middles(across), -_with_middles(down)
        columns, rows = len(across), len(down)
        flat = np.stack(np.meshgrid(across, down, indexing="ij"), 2).reshape(-1, 2)
        # The numbers run along the shorter side, so that the matrix has a narrow band.
        number = np.arange(columns * rows).reshape(columns, rows)
        if columns < rows:
            order = number.T.ravel()
            flat = flat[order]
            number = np.argsort(order).reshape(columns, rows)
        self.points = flat if mapping is None else mapping(flat)
        i, j = [a.ravel() for a in np.meshgrid(np.arange(0, columns - 1, 2),
                                               np.arange(0, rows - 1, 2), indexing="ij")]
        self.elements = np.stack([number[i + a, j + 2 - b] for b in range(3) for a in range(3)], 1)
        self.top_edges = np.stack([number[0:-1:2, 0], number[1::2, 0], number[2::2, 0]], 1)
        self.axis = number[0]
        lowest = self.points[:, 1].min()
        self.base = np.flatnonzero(self.points[:, 1] <= lowest + 1e-9 * abs(lowest) + 1e-12)
        middles = flat[self.elements[:, 4]]
        self.material = np.zeros(len(middles), int) if material is None else material(middles)


def _with_middles(borders):
    borders = np.asarray(borders, float)
    return np.sort(np.concatenate([borders, 0.5 * (borders[1:] + borders[:-1])]))


def contact_axis(contact, length, elements, growth=1.25):
    """Borders along r: `elements` up to `contact` that are finer at the axis, then growing ones.

    Half of the elements are equal and cover the inner quarter; the others grow with the radius, so
    that shallow presses are resolved as well as deep ones.
    """
    inner = elements // 2
    first = np.linspace(0.0, 0.25 * contact, inner + 1)
    count = elements - inner
    # Sizes in geometric growth from the inner ones, with the sum 3/4 of the contact.
    low, high = 1.0, 3.0
    powers = np.arange(1, count + 1)
    for _ in range(80):
        ratio = 0.5 * (low + high)
        low, high = (ratio, high) if (first[1] * ratio ** powers).sum() < 0.75 * contact \
            else (low, ratio)
    second = 0.25 * contact + np.cumsum(first[1] * ratio ** powers)
    inside = np.concatenate([first, second])
    if length <= 1.01 * contact:
        return inside * (length / inside[-1])
    size = inside[-1] - inside[-2]
    return chain(inside, growing(size * growth, length - contact, growth))


def disc(radius, layers, contact, elements, growth=1.25, least_in_layer=3):
    """A flat disc with the layers' thicknesses from the top; materials are the layers' numbers."""
    across = contact_axis(contact, radius, elements, growth)
    size = across[1]
    parts = []
    for thickness in layers:
        start = min(size, thickness / least_in_layer)
        part = growing(start, thickness, growth)
        parts.append(part)
        size = part[-1] - part[-2]
    down = chain(*parts)
    borders = np.cumsum(layers)[:-1]
    return Mesh(across, down, None, lambda middles: np.searchsorted(borders, -middles[:, 1]))


def dome(radius, height, contact, elements, growth=1.25):
    """Half an ellipsoid on its base: columns are vertical, and rows divide the height."""
    across = contact_axis(contact, 0.5 * np.pi * radius, elements, growth)
    down = growing(across[1] / height, 1.0, growth)

    def mapping(points):
        angle = points[:, 0] / radius
        return np.stack([radius * np.sin(angle), (1.0 + points[:, 1]) * height * np.cos(angle)], 1)

    return Mesh(across, down, mapping)


def dish(radius, height, hollow, contact, elements, growth=1.25):
    """A disc of `height` on the axis whose top is hollow, with the radius of curvature `hollow`."""
    across = contact_axis(contact, radius, elements, growth)
    down = growing(across[1] / height, 1.0, growth)

    def mapping(points):
        rise = hollow - np.sqrt(hollow ** 2 - points[:, 0] ** 2)
        return np.stack([points[:, 0], (1.0 + points[:, 1]) * (height + rise)], 1)

    return Mesh(across, down, mapping)


def disc_with_ball(radius, height, ball, centre, contact, elements):
    """A disc with a ball on its axis, `centre` below the top; the ball's material is 1.

    A square of the grid around the ball's centre is drawn to a circle; the change fades out towards
    a larger square, which must lie inside the disc, and is weaker towards the centre.
    """
    outer = min(centre, height - centre, 2.0 * ball)
    across = _through(contact_axis(contact, radius, elements), (ball, outer))
    levels = (centre - outer, centre - ball, centre, centre + ball, centre + outer)
    down = _through(growing(across[1], height, 1.25, 0.4 * ball), levels)

    def mapping(points):
        local = points + np.array([0.0, centre])
        square = np.abs(local).max(1)
        round_ = np.hypot(local[:, 0], local[:, 1])
        fade = np.where(square <= ball, (square / ball) ** 2,
                        np.clip((outer - square) / (outer - ball), 0.0, 1.0))
        scale = 1.0 + fade * (square / np.maximum(round_, 1e-300) - 1.0)
        return local * scale[:, None] - np.array([0.0, centre])

    inside = lambda middles: (np.abs(middles + np.array([0.0, centre])).max(1) < ball).astype(int)
    return Mesh(across, down, mapping, inside)


def _through(borders, marks):
    """The borders, the nearest of which are moved to the marks; extra ones where none is near."""
    borders = np.array(borders)
    for mark in marks:
        if mark <= borders[0] or mark >= borders[-1]:
            continue
        taken = np.isin(borders, marks)
        free = np.where(taken | (np.arange(len(borders)) % (len(borders) - 1) == 0), np.inf,
                        np.abs(borders - mark))
        nearest = int(np.argmin(free))
        room = np.diff(borders)[max(0, nearest - 1):nearest + 1].max()
        if free[nearest] < 0.6 * room and not np.any(borders == mark):
            borders[nearest] = mark
            borders = np.sort(borders)
        elif not np.any(borders == mark):
            borders = np.sort(np.append(borders, mark))
    return borders
