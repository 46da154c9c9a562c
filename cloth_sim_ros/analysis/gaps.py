# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Where frames are missing in a recording."""

import numpy as np

_TOO_LONG = 1.5  # over the usual time from frame to frame


def find_gaps(times: np.ndarray, resets: np.ndarray) -> list[tuple[float, float]]:
    """
    Return begin and end [s] of each span without frames where there should be some.

    :param times: of the frames [s], growing
    :param resets: made before each frame; nobody misses a frame across one
    """
    if len(times) < 3:
        return []
    steps = np.diff(times)
    same_run = np.diff(resets) == 0
    if not same_run.any():
        return []
    # Times are multiples of dt, so frames may come with one dt more or less.
    usual = max(np.median(steps[same_run]), np.percentile(steps[same_run], 90))
    found = np.flatnonzero(same_run & (steps > _TOO_LONG * usual))
    return [(float(times[place]), float(times[place + 1])) for place in found]
