# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where one frame was in the last seconds, and where it was between."""

from bisect import bisect_left
from dataclasses import dataclass

from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.sim.pose import between
from cloth_sim_ros.sim.pose import Pose

# As tf2 does by default [ns].
KEPT = 10 * NANOSECONDS
# Of one frame: 10 s at 200 Hz. At higher rates memory counts more than old stamps.
MOST_SAMPLES = 2000


@dataclass(frozen=True, slots=True)
class Sample:
    """
    Where a frame is at one time.

    :param time: [ns], of the clock of its publisher
    :param parent: the frame that ``pose`` is given in
    :param pose: of the frame
    """

    time: int
    parent: str
    pose: Pose


class FrameHistory:
    """The samples of one frame, by the rules of tf2."""

    def __init__(self) -> None:
        """Begin without any."""
        self._times: list[int] = []
        self._samples: list[Sample] = []

    @property
    def oldest(self) -> Sample:
        """Return the sample of the earliest time."""
        return self._samples[0]

    @property
    def latest(self) -> Sample:
        """Return the sample of the latest time."""
        return self._samples[-1]

    def add(self, sample: Sample) -> None:
        """
        Keep ``sample``; of several of one time, the first counts.

        One that is older than all that is kept starts anew: its publisher was reset.
        """
        times = self._times
        if times and sample.time < times[-1] - KEPT:
            self.drop_from(times[0])
        place = bisect_left(times, sample.time)
        if place < len(times) and times[place] == sample.time:
            return
        times.insert(place, sample.time)
        self._samples.insert(place, sample)
        outdated = max(bisect_left(times, times[-1] - KEPT), len(times) - MOST_SAMPLES)
        del times[:outdated], self._samples[:outdated]

    def drop_from(self, time: int) -> None:
        """Forget the samples of ``time`` [ns] and later."""
        place = bisect_left(self._times, time)
        del self._times[place:], self._samples[place:]

    def at(self, time: int) -> Sample | None:
        """Return where the frame was at ``time`` [ns]; None outside what is known."""
        place = bisect_left(self._times, time)
        if place == len(self._times):
            return None
        after = self._samples[place]
        if after.time == time:
            return after
        if place == 0:
            return None
        before = self._samples[place - 1]
        # Between two parents, the frame is still at the first.
        if before.parent != after.parent:
            return Sample(time, before.parent, before.pose)
        share = (time - before.time) / (after.time - before.time)
        return Sample(time, before.parent, between(before.pose, after.pose, share))
