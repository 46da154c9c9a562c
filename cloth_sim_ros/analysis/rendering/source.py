# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
