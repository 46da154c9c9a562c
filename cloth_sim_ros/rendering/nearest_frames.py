# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames nearest to given times, out of a stream."""

from collections.abc import Iterable
from collections.abc import Iterator

from cloth_sim_ros.analysis.frame import Frame


def nearest_frames(frames: Iterable[Frame], times: Iterable[float]) -> Iterator[Frame]:
    """
    Yield the frame nearest to each of ``times`` [s]; two are in memory at a time.

    :param frames: at least one, in the order of time
    :param times: which grow
    """
    stream = iter(frames)
    before = after = next(stream)
    for time in times:
        while after is not None and after.time < time:
            before, after = after, next(stream, None)
        is_before_nearer = after is None or time - before.time < after.time - time
        yield before if is_before_nearer else after
