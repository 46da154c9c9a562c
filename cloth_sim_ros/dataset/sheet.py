# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A contact sheet of a data set: colour, depth and labels of its first samples."""

from pathlib import Path

from cloth_sim_ros.camera.depth_shades import depth_shades
from cloth_sim_ros.dataset.sample import path_of
from matplotlib import colormaps
import numpy as np
from PIL import Image

_WIDTH = 180     # of a picture on the sheet [pixel]
_COLUMNS = 3     # samples side by side
_MOST = 24       # samples
_GAP = 4         # between two samples [pixel]
_WHITE = 255


def write_sheet(folder: Path, count: int, file: Path) -> int:
    """
    Write a sheet of the first of ``count`` samples that are there; return how many it shows.

    Near is bright in the depth of each sample, and missing values are white.
    """
    numbers = [
        number for number in range(count) if path_of(folder, 'samples', number).exists()][:_MOST]
    rows = [_sample(folder, number) for number in numbers]
    if not rows:
        return 0
    height = max(row.shape[0] for row in rows)
    width = max(row.shape[1] for row in rows)
    columns = min(_COLUMNS, len(rows))
    lines = -(-len(rows) // columns)
    sheet = np.full(
        (lines * (height + _GAP) - _GAP, columns * (width + _GAP) - _GAP, 3), _WHITE, np.uint8)
    for place, row in enumerate(rows):
        top, left = place // columns * (height + _GAP), place % columns * (width + _GAP)
        sheet[top:top + row.shape[0], left:left + row.shape[1]] = row
    Image.fromarray(sheet).save(file, optimize=True)
    return len(rows)


def _sample(folder: Path, number: int) -> np.ndarray:
    """Return the pictures of a sample side by side, (height, width, 3) uint8."""
    color, depth, labels = (
        np.asarray(Image.open(path_of(folder, kind, number)))
        for kind in ('images', 'depth', 'labels'))
    shades = depth_shades(np.where(depth > 0, depth.astype(float), np.inf))
    paints = 255.0 * colormaps['tab10'](labels % 10)[..., :3]
    paints[labels == 0] = _WHITE
    height = round(_WIDTH * color.shape[0] / color.shape[1])
    return np.concatenate([
        np.asarray(Image.fromarray(part.astype(np.uint8)).resize((_WIDTH, height), how))
        for part, how in (
            (color, Image.Resampling.LANCZOS), (shades, Image.Resampling.NEAREST),
            (paints, Image.Resampling.NEAREST))], axis=1)
