# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames of a recording, in the order of time."""

from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Sequence

from cloth_sim_ros.analysis import collider_history
from cloth_sim_ros.analysis import push_history
from cloth_sim_ros.analysis.collider_history import ColliderHistory
from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.push_history import PushHistory
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.sim.push import Push
import numpy as np


def read_frames(recording: Recording) -> Iterator[Frame]:
    """Yield every frame, with pushes given before it and colliders; one is in memory at a time."""
    pushes, colliders = PushHistory(), ColliderHistory()
    for entry in recording.entries('points', *push_history.KEYS, *collider_history.KEYS):
        if entry.key == 'points':
            yield Frame.from_points(
                entry.time, entry.message, pushes.pushes, colliders.at(entry.message.header.stamp))
            continue
        if entry.key in push_history.KEYS:
            pushes.read(entry)
        if entry.key in collider_history.KEYS:
            colliders.read(entry)


def frames_at(recording: Recording, times: Sequence[float]) -> list[Frame]:
    """
    Return the frame nearest to each of ``times`` [s], which grow.

    :raises ClothSimError: when the recording holds no frame
    """
    wanted = list(times)
    chosen: list[Frame] = []
    before = None
    for frame in read_frames(recording):
        while wanted and frame.time >= wanted[0]:
            if before is not None and wanted[0] - before.time < frame.time - wanted[0]:
                chosen.append(before)
            else:
                chosen.append(frame)
            wanted.pop(0)
        before = frame
        if not wanted:
            break
    if before is None:
        raise recording.no_frame()
    return chosen + [before] * len(wanted)


def default_times(recording: Recording, count: int) -> list[float]:
    """Return ``count`` times [s] that show what happens; ClothSimError without a frame."""
    times: list[float] = []
    pushes: dict[tuple[float, tuple[float, float, float]], Push] = {}
    for frame in read_frames(recording):
        times.append(frame.time)
        # As it was last seen: an early end shortens it.
        pushes.update({(push.start, push.force): push for push in frame.pushes})
    if not times:
        raise recording.no_frame()
    return panel_times(times[0], times[-1], pushes.values(), count)


def panel_times(begin: float, end: float, pushes: Iterable[Push], count: int) -> list[float]:
    """
    Return ``count`` times from ``begin`` to ``end`` [s], evenly apart but for the pushes.

    The time next to the middle of a push moves there, so that the push is seen; the first and
    the last stay, and a time moves once.
    """
    times = np.linspace(begin, end, count)
    free = set(range(1, count - 1))
    for push in pushes:
        middle = push.start + push.duration / 2
        if not free or not begin < middle < end:
            continue
        nearest = min(free, key=lambda panel: abs(times[panel] - middle))
        times[nearest] = middle
        free.remove(nearest)
    return sorted(times.tolist())
