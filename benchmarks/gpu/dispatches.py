# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a dispatch costs beside its work: direct, indirect, skipped, with and without a barrier."""

from collections.abc import Callable
from collections.abc import Iterator
import time

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_dispatches_visible
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from gpu.kernel import ADD
from gpu.kernel import compiled
from gpu.kernel import LOCAL
from gpu.section import Row
from gpu.section import Section
import numpy as np

_COUNT = 2000


def _nothing() -> None:
    pass


def _measure(quick: bool) -> Iterator[Row]:
    context = Context(single_thread=True)
    count = 100 if quick else _COUNT
    values = Buffer(np.zeros(LOCAL, dtype=np.float32))
    groups = Buffer(np.array([1, 1, 1, 0, 1, 1], dtype=np.uint32))
    quick_calls.use_program(compiled(ADD))
    values.bind_storage(0)
    groups.bind_dispatches()
    ways: dict[str, Callable[[], None]] = {
        'direct': lambda: quick_calls.dispatch(1, 1, 1),
        'direct, no workgroup': lambda: quick_calls.dispatch(0, 1, 1),
        'indirect': lambda: quick_calls.dispatch_indirect(0),
        'indirect, no workgroup': lambda: quick_calls.dispatch_indirect(12)}
    barriers: dict[str, Callable[[], None]] = {
        'none': _nothing, 'writes': shader_writes_visible,
        'writes and commands': shader_dispatches_visible}
    for way, run in ways.items():
        for name, barrier in barriers.items():
            found = []
            for _ in range(3):
                context.finish()
                begin = time.perf_counter()
                for _ in range(count):
                    run()
                    barrier()
                submitted = time.perf_counter() - begin
                context.finish()
                found.append((time.perf_counter() - begin, submitted))
            whole, submitted = min(found)
            yield {'dispatch': way, 'barrier': name, 'us each': 1e6 * whole / count,
                   'us to submit': 1e6 * submitted / count}
    scalar = np.empty(1, dtype=np.float32)
    begin = time.perf_counter()
    for _ in range(count // 10):
        quick_calls.dispatch(1, 1, 1)
        values.read_into(scalar)
    yield {'dispatch': 'direct', 'barrier': 'read 4 bytes back',
           'us each': 1e7 * (time.perf_counter() - begin) / count, 'us to submit': '-'}
    context.close()


SECTION = Section('dispatches', 'Dispatches', 15.0, _measure)
