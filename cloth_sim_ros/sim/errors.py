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

"""Errors a user can mend: each says rule, value and way out in one sentence."""

from cloth_sim_ros.files.errors import ClothSimError


class NonFiniteStateError(ClothSimError):
    """
    The state became invalid: a position or velocity is not finite, or far too large.

    The simulation keeps the last finite state, and can be inspected, changed, reset or
    retried.

    :param steps: made since the start or the last reset until the state that is kept
    :param node: row and col of the node that was fastest among those that were lost; None where
        that can't be told
    """

    def __init__(
            self, message: str, *, steps: int, node: tuple[int, int] | None = None) -> None:
        """Keep what the message says."""
        super().__init__(message)
        self.steps = steps
        self.node = node
