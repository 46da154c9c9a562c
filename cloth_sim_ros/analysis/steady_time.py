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


"""Simulated time that only grows, over the resets of a run."""

from typing import Any


class SteadyTime:
    """Turns the stamps of a recording, one behind the other, into times that never go back."""

    def __init__(self) -> None:
        """Begin before the first message."""
        self.now = 0.0
        self._offset = 0.0

    def read(self, stamp: Any) -> float:
        """Return the time [s] of the next message, which is stamped ``stamp``."""
        stamped = stamp.sec + 1e-9 * stamp.nanosec
        if stamped + self._offset < self.now:
            self._offset = self.now - stamped
        self.now = stamped + self._offset
        return self.now
