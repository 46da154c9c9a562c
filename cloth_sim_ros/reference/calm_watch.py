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

"""For how many substeps no edge of a cloth will come near its strain limit."""

from collections.abc import Callable

# Of the limit: a predicted strain above this makes an edge near it.
_NEAR = 0.9
_FEWEST, _MOST = 4, 64


class CalmWatch:
    """
    Looks ahead along the velocities and the applied accelerations, up to twice as far each time.

    :param foresee: takes the time [s], a time ahead [s], and for how long [s] from now what is
        applied is averaged; returns the largest strains now and then
    """

    def __init__(
            self, limit: float,
            foresee: Callable[[float, float, float], tuple[float, float]]) -> None:
        """Start with a short look."""
        self._near = _NEAR * limit
        self._foresee = foresee
        self._reach = _FEWEST
        self._left = 0
        self._until = 0.0
        # The largest strain at the last look.
        self.seen = 0.0

    def calm_substeps(self, now: float, length: float, quiet_until: float) -> int:
        """
        Return how many substeps of ``length`` [s] can do without limits.

        :param quiet_until: no push acts until then [s]
        """
        if self._left == 0 or quiet_until < self._until:
            self._look(now, length, quiet_until)
        return self._left

    def spend(self, substeps: int) -> None:
        """Tell that ``substeps`` of the calm ones were made."""
        self._left -= substeps

    def _look(self, now: float, length: float, quiet_until: float) -> None:
        quiet = int(min(self._reach, (quiet_until - now) / length))
        reach = max(1, quiet)
        present, ahead = self._foresee(now, reach * length, length)
        self.seen = present
        share = 1.0
        if not max(present, ahead) < self._near:
            share = (self._near - present) / (ahead - present) if present < self._near else 0.0
        self._left = int(share * reach)
        self._until = now + self._left * length
        self._reach = min(max(2 * self._left, _FEWEST), _MOST)
