# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Frames for the images of a video."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.nearest_frames import nearest_frames
from hypothesis import given
from hypothesis import strategies
import numpy as np

TIMES = strategies.lists(strategies.integers(0, 1000), min_size=1, max_size=20, unique=True)


@given(TIMES, TIMES)
def test_each_time_gets_the_nearest_frame(given_times, wanted):
    """A video would lag behind its clock, or skip a part."""
    frames = [Frame(float(time), np.zeros(0)) for time in sorted(given_times)]
    wanted = sorted(wanted)
    found = list(nearest_frames(iter(frames), wanted))
    assert len(found) == len(wanted)
    for time, frame in zip(wanted, found):
        assert abs(frame.time - time) == min(abs(other.time - time) for other in frames)
