# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The bits of every case with a full barrier and a wait after each dispatch, against those without.

A pass that reads what an earlier one wrote needs a barrier between both. Where one is missing, a
device that runs passes side by side gives other bits than one that waits.
"""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import closing
from contextlib import contextmanager
from unittest.mock import patch

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.libraries import GL
from gpu.cases import Case
from gpu.cases import CASES
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
from gpu.states import positions_after
import numpy as np

_ALL = 0xFFFFFFFF


@contextmanager
def waits_after_each_dispatch() -> Iterator[None]:
    """Have every dispatch of programs made in the block followed by a barrier and a wait."""
    def waiting(dispatch: Callable[..., None]) -> Callable[..., None]:
        def run(*arguments: int) -> None:
            quick_calls.memory_barrier(_ALL)
            dispatch(*arguments)
            quick_calls.memory_barrier(_ALL)
            GL.glFinish()
        return run

    with patch.object(quick_calls, 'dispatch', waiting(quick_calls.dispatch)), \
            patch.object(
                quick_calls, 'dispatch_indirect', waiting(quick_calls.dispatch_indirect)):
        yield


def same_bits(case: Case, context: Context) -> bool:
    """Return whether the positions after the steps of ``case`` are the same both ways."""
    ordinary = positions_after(case.scene(), case.steps, context)
    with waits_after_each_dispatch():
        waiting = positions_after(case.scene(), case.steps, context)
    return np.array_equal(ordinary, waiting)


def _measure(quick: bool) -> Iterator[Row]:
    with closing(Context(single_thread=True)) as context:
        for case in CASES:
            same = same_bits(case, context)
            yield {'case': case.name, 'same bits with full barriers': same,
                   FAULT: '' if same else 'other bits: a barrier is missing'}


SECTION = Section('barriers', 'Barriers', 40.0, _measure)
