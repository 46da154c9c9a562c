# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The time of the node at its own pace: stamps that begin at 0, or at the wall clock."""

from collections.abc import Callable
import time

from cloth_sim_interfaces.msg import TimeBase as TimeBaseMessage
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.messages.time_base import TimeBase
from cloth_sim_ros.sim.simulation import Simulation


class NodeTime:
    """
    Stamps begin at 0, with the start and with each reset.

    Used on the device thread.

    :ivar base: turns simulated time into stamps
    :param simulation: whose time it is
    :param changed: called with the stamp that the present moment had [ns], when it has another
    """

    # Whether stamps follow from /clock, and whether they are known yet.
    is_followed = False
    is_known = True

    def __init__(
            self, simulation: Simulation, changed: Callable[[int], object], epoch: int = 0,
            source: str = TimeBaseMessage.OWN) -> None:
        """Begin with ``epoch`` [ns]."""
        self.base = TimeBase(epoch, source)
        self._simulation = simulation
        self._changed = changed

    @property
    def goal(self) -> int | None:
        """Return how many steps of dt may have been made by now; None for any number."""
        return None

    @property
    def behind(self) -> float:
        """Return how far the present moment is behind the time that its stamp is of [s]."""
        return 0.0

    def is_still(self) -> bool:
        """Return whether the time that is followed stood still since this was last asked."""
        return False

    def catch_up(self) -> None:
        """Continue from the time that it is now; steps missed until then are skipped."""

    def restart(self, before: float) -> None:
        """Note that simulated time has returned from ``before`` [s] to 0."""
        self._changed(self.base.at(before))

    def _begin_at(self, now: int, before: int) -> None:
        """Let the stamp of the present moment be ``now`` [ns], instead of ``before``."""
        epoch = now - nanoseconds(self._simulation.time)
        if epoch != self.base.epoch:
            self.base.epoch = epoch
            self._changed(before)

    def _stamp(self) -> int:
        return self.base.at(self._simulation.time)


class WallTime(NodeTime):
    """
    Stamps of the wall clock, as far as the cloth keeps up with it.

    They go on at the pace of the cloth, and are set to the wall clock again when the cloth has
    stood still. A stamp is never before one that was sent.
    """

    def __init__(self, simulation: Simulation, changed: Callable[[int], object]) -> None:
        """Begin now."""
        super().__init__(simulation, changed, time.time_ns())

    @property
    def behind(self) -> float:
        """Return how far the present moment is behind the wall clock [s]."""
        return (time.time_ns() - self._stamp()) / NANOSECONDS

    def catch_up(self) -> None:
        """Continue from the time that it is now; steps missed until then are skipped."""
        before = self._stamp()
        self._begin_at(max(time.time_ns(), before), before)

    def restart(self, before: float) -> None:
        """Note that simulated time has returned from ``before`` [s] to 0."""
        stamp = self.base.at(before)
        self._begin_at(max(time.time_ns(), stamp), stamp)
