# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The shape that a cloth is cut to: which cells of its rectangle there are.

A cell is there where its middle lies within the outline, outside all holes, and where more of
it is white than black on the mask; of a disc, as many of those nearest to the middle as it has the
area of. Lengths are from the middle of the rectangle, x along rows, y towards row 0.
"""

from base64 import b64decode
from base64 import b64encode
from collections.abc import Mapping
from collections.abc import Sequence
from io import BytesIO
import math
from pathlib import Path
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

SHAPE_FIELDS = ('shape.outline', 'shape.holes', 'shape.disc', 'shape.mask')
# Max. pixels of a mask [1]: those of the largest lattice, and no image that fills the memory.
_MOST_PIXELS = 8192**2
# Max. size of the file of a mask [bytes]: one byte a pixel.
_MOST_BYTES = _MOST_PIXELS
# What an embedded mask begins with.
_EMBEDDED = 'data:image/png;base64,'
# Grey of a pixel above which it is white [1], of 255.
_GREY = 127
# Formats that Pillow reads by itself, without running other programs.
_FORMATS = ('PNG', 'JPEG', 'BMP', 'GIF', 'TIFF', 'WEBP', 'PPM')
_GIVE_IMAGE = f'give an image of {", ".join(_FORMATS)}, white where there is cloth'
_GIVE_CORNERS = 'give x and y of 3 corners or more'


def is_shaped(values: Mapping[str, Any]) -> bool:
    """Return whether a cloth is cut to a shape other than its rectangle."""
    return any(values[name] for name in SHAPE_FIELDS)


def cells_of(values: Mapping[str, Any]) -> np.ndarray:
    """
    Return which cells there are, (rows - 1, cols - 1) bool.

    :param values: checked ones, of all scene parameters
    :raises ClothSimError: for a shape that cannot be cut, or that falls into pieces
    """
    rows, cols = values['rows'], values['cols']
    x = ((np.arange(cols - 1) + 0.5) / (cols - 1) - 0.5) * values['width']
    y = (0.5 - (np.arange(rows - 1) + 0.5) / (rows - 1)) * values['height']
    at_x, at_y = np.meshgrid(x, y)
    present = np.ones((rows - 1, cols - 1), dtype=bool)
    if values['shape.outline']:
        present &= _inside(_corners(values['shape.outline'], 'shape.outline'), at_x, at_y)
    if values['shape.disc']:
        cell = values['width'] / (cols - 1) * values['height'] / (rows - 1)
        present &= _disc(at_x, at_y, math.pi * (0.5 * values['shape.disc'])**2 / cell)
    for corners in _holes(values):
        present &= ~_inside(corners, at_x, at_y)
    if values['shape.mask']:
        present &= _white(values['shape.mask'], present.shape)
    _check(present, values['shape.pieces'])
    return present


def _disc(x: np.ndarray, y: np.ndarray, count: float) -> np.ndarray:
    """
    Return the cells nearest to the middle, as many as the disc has the area of.

    Those whose middle lies in the disc have an area that is off by 0.9 % at 70 cells across, and
    these by 0.1 %. Cells that mirror one another are in together.

    :param x: of the middles of cells [m]
    :param y: of the middles of cells [m]
    :param count: area over that of a cell
    """
    # Equal distances that differ by rounding are one.
    unit = 1e-9 * max(float(np.hypot(x, y).max()), 1e-300)
    away = np.rint(np.hypot(x, y) / unit)
    longer = np.rint(np.maximum(np.abs(x), np.abs(y)) / unit)
    order = np.lexsort((longer.ravel(), away.ravel()))
    keys = np.stack([away.ravel(), longer.ravel()])[:, order]
    # Where a group of cells that mirror one another ends.
    ends = np.flatnonzero(np.any(keys[:, 1:] != keys[:, :-1], axis=0)) + 1
    ends = np.concatenate([[0], ends, [x.size]])
    inside = np.zeros(x.size, dtype=bool)
    inside[order[:ends[np.argmin(np.abs(ends - count))]]] = True
    return inside.reshape(x.shape)


def _corners(flat: Sequence[float], name: str) -> np.ndarray:
    """Return the corners of a polygon, (n, 2) [m]."""
    if len(flat) % 2 or len(flat) < 6:
        raise ClothSimError(
            f'{name} needs two numbers for each of 3 corners or more, got {len(flat)} numbers: '
            f'{_GIVE_CORNERS}')
    corners = np.array(flat, dtype=float).reshape(-1, 2)
    if _crosses_itself(corners):
        raise ClothSimError(
            f'{name} crosses itself: {_GIVE_CORNERS}, in the order in which one walks around it')
    return corners


def _holes(values: Mapping[str, Any]) -> list[np.ndarray]:
    flat, counts = values['shape.holes'], values['shape.hole_corners']
    if not flat:
        return []
    counts = counts or (len(flat) // 2,)
    if 2 * sum(counts) != len(flat):
        raise ClothSimError(
            f'shape.hole_corners has {sum(counts)} corners in all, and shape.holes '
            f'{len(flat) / 2:g}: give how many corners each hole has')
    ends = np.cumsum(counts) * 2
    return [
        _corners(flat[end - 2 * count:end], 'shape.holes')
        for count, end in zip(counts, ends.tolist())]


def _inside(corners: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return which points lie in a polygon."""
    # Only polygons need it, and its import takes 0.1 s.
    from matplotlib.path import Path as Outline
    points = np.stack([x.ravel(), y.ravel()], axis=-1)
    closed = np.concatenate([corners, corners[:1]])
    return Outline(closed, closed=True).contains_points(points).reshape(x.shape)


def _crosses_itself(corners: np.ndarray) -> bool:
    """Return whether two sides that are no neighbours have a point in common."""
    begins, ends = corners, np.roll(corners, -1, axis=0)
    count = len(corners)

    def side(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
        along, to = b - a, c - a
        return np.sign(along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0])

    for first in range(count - 2):
        others = np.arange(first + 2, count - (first == 0))
        a, b, c, d = begins[first], ends[first], begins[others], ends[others]
        if np.any((side(a, b, c) * side(a, b, d) <= 0) & (side(c, d, a) * side(c, d, b) <= 0)):
            return True
    return False


def beside(file: str | Path, mask: str) -> str:
    """Return the path of a mask that is given in a ``file``."""
    return mask if not mask or mask.startswith(_EMBEDDED) else str(Path(file).parent / mask)


def embedded_mask(mask: str) -> str:
    """
    Return a mask as a data URL (RFC 2397), which a recording can carry; empty for none.

    :param mask: path of an image, or such a URL
    :raises ClothSimError: when it is no image
    """
    if not mask or mask.startswith(_EMBEDDED):
        return mask
    try:
        data = read_regular(mask, _MOST_BYTES)
    except OSError as error:
        raise ClothSimError(
            f'shape.mask {shown(mask)} cannot be read ({error.strerror}): {_GIVE_IMAGE}'
        ) from error
    # Only a mask needs it.
    from PIL import Image
    written = BytesIO()
    Image.fromarray(_pixels(data, mask) > _GREY).save(written, 'PNG', optimize=True)
    return _EMBEDDED + b64encode(written.getvalue()).decode()


def _white(mask: str, shape: tuple[int, int]) -> np.ndarray:
    """Return which cells an embedded mask covers with more white than black."""
    try:
        data = b64decode(mask.removeprefix(_EMBEDDED), validate=True)
    except ValueError as error:
        raise ClothSimError(
            f'shape.mask begins like a data URL and is not base64 ({error}): {_GIVE_IMAGE}'
        ) from error
    from PIL import Image
    rows, cols = shape
    image = Image.fromarray(_pixels(data, mask))
    return np.asarray(image.resize((cols, rows), Image.Resampling.BOX)) > _GREY


def _pixels(data: bytes, name: str) -> np.ndarray:
    """Return the grey of each pixel of an image, 0 to 255."""
    from PIL import Image
    try:
        with Image.open(BytesIO(data), formats=_FORMATS) as image:
            if math.prod(image.size) > _MOST_PIXELS:
                raise Image.DecompressionBombError
            return np.asarray(image.convert('L'))
    except Image.DecompressionBombError as error:
        raise ClothSimError(
            f'shape.mask {shown(name)} has more than {_MOST_PIXELS} pixels: give a smaller image'
        ) from error
    except Exception as error:
        # What Pillow raises depends on the format and on the damage.
        raise ClothSimError(
            f'shape.mask {shown(name)} is no image that can be read: {_GIVE_IMAGE}'
        ) from error


def _check(present: np.ndarray, most: int) -> None:
    """
    Raise ClothSimError where cells do not hang together by their sides.

    :param most: pieces that there may be
    """
    if not present.any():
        raise ClothSimError(
            'the shape leaves no cell of the cloth: give a larger one, or more rows and cols')
    # Only a shape needs it.
    from scipy import ndimage
    _, pieces = ndimage.label(present)
    _, joined = ndimage.label(present, structure=np.ones((3, 3)))
    if pieces == joined <= most:
        return
    if pieces > joined:
        raise ClothSimError(
            f'the shape has {pieces} parts, some of which hang together by single nodes: make it '
            'wider there, or give more rows and cols')
    raise ClothSimError(
        f'the shape falls into {joined} pieces, more than shape.pieces {most}: give one that '
        'hangs together, more rows and cols, or more shape.pieces')
