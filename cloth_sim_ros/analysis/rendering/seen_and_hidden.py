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

"""Draw what stands on the cloth twice: where it is hidden, and where it is seen."""

from collections.abc import Iterator

from cloth_sim_ros.analysis.rendering.look import HIDDEN
from cloth_sim_ros.gl.draw_state import draw_hidden
from cloth_sim_ros.gl.draw_state import draw_nearest


def seen_and_hidden(*, hides: bool = False) -> Iterator[float]:
    """
    Yield the opacity to draw with, once for what is hidden and once for what is seen.

    :param hides: hide what comes later and is farther away
    """
    draw_hidden()
    yield HIDDEN
    draw_nearest(hides=hides)
    yield 1.0
    draw_nearest()
