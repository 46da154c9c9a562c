# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The time of /clock: the cloth makes the steps that it has passed, and no more."""

from collections import deque
from collections.abc import Callable
import threading

from cloth_sim_interfaces.msg import TimeBase as TimeBaseMessage
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.node.node_time import NodeTime
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.clock import JumpThreshold
from rclpy.clock import TimeJump
from rclpy.duration import Duration
from rclpy.node import Node

# Max. jump forward of /clock [ns] that the cloth makes up for: as long as tf2 keeps transforms by
# default. Chosen: any time from a step of a simulator to that will do.
LONGEST_LEAP = 10 * NANOSECONDS
_SMALLEST_JUMP = Duration(nanoseconds=1)


class FollowedTime(NodeTime):
    """
    Time of /clock, in lockstep.

    Stamps are 0 before its first message, as ROS has it. None is before one that was sent, unless
    /clock itself goes back.

    :param node: with use_sim_time, whose clock listens to /clock
    :param post: has a function called on the device thread
    :param begun: called there when the first message has come
    :param went_back: called there with a sentence when /clock is before the cloth
    :param leapt: called there with a sentence when /clock has skipped time
    :param changed: called there with the stamp that the present moment had [ns]
    """

    is_followed = True

    def __init__(
            self, node: Node, simulation: Simulation, post: Callable[[Callable[[], object]], None],
            *, begun: Callable[[], object], went_back: Callable[[str], object],
            leapt: Callable[[str], object], changed: Callable[[int], object]) -> None:
        """Listen to /clock."""
        super().__init__(simulation, changed, 0, TimeBaseMessage.ROS)
        self.is_known = False
        self._post = post
        self._begun = begun
        self._went_back = went_back
        self._leapt = leapt
        # Times that have come and were not taken [ns]; while /clock goes forward, the latest only.
        self._waiting: deque[int] = deque()
        self._lock = threading.Lock()
        self._now = 0
        # Whether /clock went back behind the cloth, which was not reset yet.
        self._is_before = False
        self._looked_at = -1
        self._clock = node.get_clock()
        # Its callback lives as long as this.
        self._jumps = self._clock.create_jump_callback(
            JumpThreshold(
                min_forward=_SMALLEST_JUMP, min_backward=Duration(nanoseconds=-1),
                on_clock_change=False),
            post_callback=self._on_jump)

    @property
    def goal(self) -> int:
        """Return how many steps of dt may have been made by now."""
        if not self.is_known:
            return 0
        dt, passed = self._simulation.dt, self._now - self.base.epoch
        steps = max(round(passed / (dt * NANOSECONDS)), 0)
        return steps if nanoseconds(steps * dt) <= passed else steps - 1

    @property
    def behind(self) -> float:
        """Return how far the cloth is behind /clock [s]."""
        return (self._now - self._stamp()) / NANOSECONDS if self.is_known else 0.0

    def is_still(self) -> bool:
        """Return whether no other time has come since this was last asked."""
        before, self._looked_at = self._looked_at, self._now
        return self._looked_at == before

    def catch_up(self) -> None:
        """Continue from the time that it is now; steps missed until then are skipped."""
        if self.is_known:
            before = self._stamp()
            self._begin_at(max(self._now, before), before)

    def restart(self, before: float) -> None:
        """Note that simulated time has returned from ``before`` [s] to 0."""
        if self.is_known:
            stamp = self.base.at(before)
            self._begin_at(self._now if self._is_before else max(self._now, stamp), stamp)
            self._is_before = False

    def _on_jump(self, _: TimeJump) -> None:
        """Take a message of /clock, on the ROS thread."""
        now = self._clock.now().nanoseconds
        with self._lock:
            if self._waiting and self._waiting[-1] <= now:
                # The job of the one before takes this one.
                self._waiting[-1] = now
                return
            self._waiting.append(now)
        self._post(self._take)

    def _take(self) -> None:
        with self._lock:
            now = self._waiting.popleft()
        before, self._now = self._now, now
        if not self.is_known:
            self.is_known = True
            self._begin_at(now, self._stamp())
            self._begun()
        elif now < before:
            self._look_back(before)
        else:
            self._look_ahead(before)

    def _look_ahead(self, before: int) -> None:
        """Report a jump of /clock since ``before`` [ns]."""
        stamp = self._stamp()
        leap = self._now - max(before, stamp)
        if leap > LONGEST_LEAP:
            self._begin_at(stamp + leap, stamp)
            self._leapt(
                f'/clock went from {_seconds(before)} to {_seconds(self._now)} s at once, more '
                f'than {LONGEST_LEAP // NANOSECONDS} s: the cloth continues from there as it was, '
                'without the time between')

    def _look_back(self, before: int) -> None:
        """See whether the cloth is ahead of a /clock that went back from ``before`` [ns]."""
        if self._now < self._stamp():
            self._is_before = True
            self._went_back(f'/clock went back from {_seconds(before)} to {_seconds(self._now)} s')


def _seconds(time: int) -> str:
    return f'{time / NANOSECONDS:.9g}'
