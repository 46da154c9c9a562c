# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The noise of a depth sensor that triangulates.

A sensor with focal length f [pixel] and baseline b [m] measures the disparity d = f b / Z, with an
error of standard deviation s [pixel], in steps of its own. The error of the depth is therefore
Z^2 s / (f b) (K. Khoshelham and S. O. Elberink, "Accuracy and Resolution of Kinect Depth Data for
Indoor Mapping Applications", Sensors 12(2), 2012, doi:10.3390/s120201437, eq. 9). Beside a jump of
the depth the two pictures that it compares differ, and it measures nothing.
"""

import zlib

from cloth_sim_ros.sim.model.cameras import CameraModel
import numpy as np

_NANOSECONDS = 1e9


def measured_depth(depth: np.ndarray, camera: CameraModel, time: float) -> np.ndarray:
    """
    Return what a sensor measures of ``depth``, (height, width) float32 [m].

    The same camera has the same noise at the same time.

    :param time: simulated [s]
    :return: NaN where it measures nothing; infinite where ``depth`` is
    """
    noise = camera.noise
    if noise is None:
        return depth
    random = np.random.default_rng(
        (noise.seed, round(time * _NANOSECONDS), zlib.crc32(camera.name.encode())))
    is_finite = np.isfinite(depth)
    product = np.float32(camera.fx * noise.baseline)
    errors = np.float32(noise.disparity) * random.standard_normal(depth.shape, np.float32)
    with np.errstate(divide='ignore', invalid='ignore'):
        disparity = product / depth + errors
        if noise.step > 0.0:
            step = np.float32(noise.step)
            disparity = step * np.rint(disparity / step)
        found = np.where(disparity > 0.0, product / disparity, np.float32(np.inf))
    found = np.where(is_finite, found, depth).astype(np.float32)
    if noise.edge > 0.0:
        found[_beside_jumps(depth, noise.edge) & is_finite] = np.nan
    return found


def _beside_jumps(depth: np.ndarray, edge: float) -> np.ndarray:
    """Return which pixels differ by more than ``edge`` [m] from one of their four neighbours."""
    found = np.zeros(depth.shape, bool)
    for axis in (0, 1):
        with np.errstate(invalid='ignore'):
            # Infinite beside infinite is no jump, and is not finite anyhow.
            jumps = np.abs(np.diff(depth, axis=axis)) > edge
        before = [slice(None), slice(None)]
        after = [slice(None), slice(None)]
        before[axis], after[axis] = slice(None, -1), slice(1, None)
        found[tuple(before)] |= jumps
        found[tuple(after)] |= jumps
    return found
