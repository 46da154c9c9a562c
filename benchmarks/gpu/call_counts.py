# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How many dispatches, barriers and waits a piece of work submits to the device."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
from contextlib import ExitStack
from dataclasses import dataclass
from dataclasses import fields
from typing import Any
from unittest.mock import patch

from cloth_sim_ros.gl import buffer
from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.libraries import GL


@dataclass
class CallCounts:
    """
    Calls made since counting began.

    :param dispatches: direct and indirect ones
    :param indirect: those whose workgroups the device decides on, which may be none
    :param barriers: of memory
    :param reads: of buffers by the host, which wait for all that was submitted before
    :param waits: without a read: for a fence, or until the device has finished
    :param writes: of buffers by the host
    """

    dispatches: int = 0
    indirect: int = 0
    barriers: int = 0
    reads: int = 0
    waits: int = 0
    writes: int = 0

    def clear(self) -> None:
        """Begin anew."""
        for each in fields(self):
            setattr(self, each.name, 0)


@contextmanager
def counted_calls() -> Iterator[CallCounts]:
    """Lend the counts of what is submitted by objects that are made in the block."""
    counts = CallCounts()

    def counting(call: Callable[..., Any], *names: str) -> Callable[..., Any]:
        def run(*arguments: Any) -> Any:
            for name in names:
                setattr(counts, name, getattr(counts, name) + 1)
            return call(*arguments)
        return run

    with ExitStack() as patches:
        for place, call, *names in (
                (quick_calls, 'dispatch', 'dispatches'),
                (quick_calls, 'dispatch_indirect', 'dispatches', 'indirect'),
                (buffer, 'memory_barrier', 'barriers'), (buffer, 'read_buffer', 'reads'),
                (buffer, 'write_buffer', 'writes'), (GL, 'glFinish', 'waits'),
                (GL, 'glClientWaitSync', 'waits')):
            patches.enter_context(
                patch.object(place, call, counting(getattr(place, call), *names)))
        yield counts
