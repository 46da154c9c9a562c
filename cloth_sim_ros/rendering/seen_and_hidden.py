# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw what stands on the cloth twice: where it is hidden, and where it is seen."""

from collections.abc import Iterator

from cloth_sim_ros.rendering.look import HIDDEN
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
