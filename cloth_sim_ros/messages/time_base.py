# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The base of all stamps: an epoch, and simulated time since."""

from cloth_sim_interfaces.msg import TimeBase as TimeBaseMessage
from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.messages.stamp import stamp
from std_msgs.msg import Header


class TimeBase:
    """
    Turns simulated time into stamps.

    :param epoch: stamp of simulated time 0 [ns]
    :param source: TimeBase.OWN or TimeBase.ROS of cloth_sim_interfaces
    """

    def __init__(self, epoch: int = 0, source: str = TimeBaseMessage.OWN) -> None:
        """Begin with ``epoch``."""
        self.epoch = epoch
        self.source = source

    def at(self, seconds: float) -> int:
        """Return the stamp of simulated ``seconds`` [ns]."""
        return self.epoch + nanoseconds(seconds)

    def message(self, seconds: float) -> TimeBaseMessage:
        """Return that it holds from simulated ``seconds`` on."""
        return TimeBaseMessage(
            header=Header(stamp=stamp(seconds, self.epoch)), epoch=stamp(0.0, self.epoch),
            source=self.source)
