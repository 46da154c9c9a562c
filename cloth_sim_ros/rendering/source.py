# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the frames of a row of a picture come from."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Iterator
from collections.abc import Sequence

from cloth_sim_ros.analysis.frame import Frame


class Source(ABC):
    """
    Frames of one cloth in the order of time.

    :param name: that tells it from others
    """

    name: str

    @property
    @abstractmethod
    def modes(self) -> list[str]:
        """Get the simulation modes, in the order they came; none when that is not known."""

    @property
    @abstractmethod
    def device(self) -> str:
        """Name the device that simulated it; empty when that is not known."""

    @property
    @abstractmethod
    def missing(self) -> list[str]:
        """Name what can't be drawn, since it is not there."""

    @abstractmethod
    def frames(self) -> Iterator[Frame]:
        """Yield every frame, one in memory at a time."""

    @abstractmethod
    def frames_at(self, times: Sequence[float]) -> list[Frame]:
        """Return the frame nearest to each of ``times`` [s], which grow."""

    @abstractmethod
    def default_times(self, count: int) -> list[float]:
        """Return at most ``count`` times [s] that show what happens."""
