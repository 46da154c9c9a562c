# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Snapshots: read at once, and read while the next frame is computed."""

from collections.abc import Iterator
from ctypes import c_ubyte
from ctypes import cast
from ctypes import POINTER

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import bench_scene
from gpu.clock import seconds_each
from gpu.section import Row
from gpu.section import Section
import numpy as np
from OpenGL.GL.ARB.buffer_storage import glBufferStorage

# Substeps of a frame of 20 ms at 1 ms.
_STEPS = 20


def _ways(context: Context, size: int, turn: float) -> Row:
    """Return the rates at which ``size`` bytes get to the host, by the way they are read."""
    source, staging = Buffer(np.ones(size, dtype=np.uint8)), Buffer(size, is_staging=True)
    target = np.empty(size, dtype=np.uint8)

    def by_staging() -> None:
        source.copy_to(staging, 0, size)
        staging.read_into(target)

    ways = {'direct': lambda: source.read_into(target), 'by a staging buffer': by_staging}
    if glBufferStorage:
        flags = GL.GL_MAP_READ_BIT | GL.GL_MAP_PERSISTENT_BIT | GL.GL_MAP_COHERENT_BIT
        mapped = int(GL.glGenBuffers(1))
        GL.glBindBuffer(GL.GL_COPY_WRITE_BUFFER, mapped)
        glBufferStorage(GL.GL_COPY_WRITE_BUFFER, size, None, flags | GL.GL_CLIENT_STORAGE_BIT)
        address = GL.glMapBufferRange(GL.GL_COPY_WRITE_BUFFER, 0, size, flags)
        view = np.ctypeslib.as_array(cast(address, POINTER(c_ubyte)), (size,))

        def by_mapping() -> None:
            GL.glMemoryBarrier(GL.GL_BUFFER_UPDATE_BARRIER_BIT)
            GL.glBindBuffer(GL.GL_COPY_READ_BUFFER, source.name)
            GL.glBindBuffer(GL.GL_COPY_WRITE_BUFFER, mapped)
            GL.glCopyBufferSubData(GL.GL_COPY_READ_BUFFER, GL.GL_COPY_WRITE_BUFFER, 0, 0, size)
            GL.glFinish()
            target[:] = view

        ways['by a mapped buffer'] = by_mapping
    row: Row = {'bytes': size, 'unit': 'GB/s to the host'}
    for name, run in ways.items():
        target[:] = 0
        row[name] = size / seconds_each(run, context, turn) / 1e9
        row[f'{name}, right'] = bool(target.all())
    source.delete()
    staging.delete()
    return row


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    for size in (2**16,) if quick else (2**14, 2**18, 2**22, 2**26):
        yield _ways(context, size, 0.02 if quick else 0.1)
    turn = 0.02 if quick else 0.2
    sides = (64, 256) if context.is_software else (64, 256, 1024, 2048)
    for side in (32,) if quick else sides:
        with Simulation(bench_scene(side, {}), context=context) as cloth:
            def at_once() -> None:
                cloth.step(_STEPS)
                cloth.snapshot()

            waiting = [cloth.begin_snapshot()]

            def overlapped() -> None:
                cloth.step(_STEPS)
                finish = cloth.begin_snapshot()
                waiting.pop()()
                waiting.append(finish)

            times = {
                'steps alone [ms]': seconds_each(lambda: cloth.step(_STEPS), context, turn),
                'and snapshot [ms]': seconds_each(at_once, context, turn),
                'and snapshot, overlapped [ms]': seconds_each(overlapped, context, turn),
                'snapshot [ms]': seconds_each(cloth.snapshot, context, turn),
                'positions [ms]': seconds_each(cloth.positions, context, turn)}
            waiting.pop()()
        yield {'side': side, **{name: 1e3 * value for name, value in times.items()}}
    context.close()


SECTION = Section('read_back', 'Reading the state', 30.0, _measure)
