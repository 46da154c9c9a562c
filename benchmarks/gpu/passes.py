# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Device time of each pass of a step by timer queries, and what lies between passes."""

from collections import defaultdict
from collections.abc import Callable
from collections.abc import Iterator
from ctypes import byref
from ctypes import c_uint64
import time
from typing import Any
from unittest.mock import patch

from cloth_sim_ros.gl import program
from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from gpu.clock import seconds_each
from gpu.section import Row
from gpu.section import Section
import numpy as np
from OpenGL.raw.GL.VERSION.GL_3_3 import glGetQueryObjectui64v

_STEPS = 5
# Min. device time over wall time [1]: llvmpipe has no timer and reports 1 ns a pass.
_LEAST_SHARE = 1e-3


def _elapsed(query: int) -> int:
    """Wait for a query, and return its time [ns]."""
    value = c_uint64()
    glGetQueryObjectui64v(query, int(GL.GL_QUERY_RESULT), byref(value))
    return value.value


class _Timers:
    """A timer query around every dispatch, by the name of the program in use."""

    def __init__(self) -> None:
        self.names: dict[int, str] = {}
        self._in_use = 0
        self._open: list[tuple[str, int]] = []

    def linked(self, link: Callable[[Any], int]) -> Callable[[Any], int]:
        def note(stages: Any) -> int:
            number = link(stages)
            self.names[number] = ' and '.join(source.name for source in stages.values())
            return number
        return note

    def used(self, use: Callable[[int], None]) -> Callable[[int], None]:
        def note(number: int) -> None:
            self._in_use = number
            use(number)
        return note

    def timed(self, dispatch: Callable[..., None]) -> Callable[..., None]:
        def run(*arguments: int) -> None:
            query = int(np.ravel(GL.glGenQueries(1))[0])
            GL.glBeginQuery(GL.GL_TIME_ELAPSED, query)
            dispatch(*arguments)
            GL.glEndQuery(GL.GL_TIME_ELAPSED)
            self._open.append((self.names.get(self._in_use, '?'), query))
        return run

    def take(self) -> dict[str, list[float]]:
        """Return the times of all dispatches since the last call, by pass [s]."""
        found: defaultdict[str, list[float]] = defaultdict(list)
        for name, query in self._open:
            found[name].append(1e-9 * _elapsed(query))
            GL.glDeleteQueries(1, [query])
        self._open.clear()
        return found


def _repeated(quick: bool) -> Iterator[Row]:
    """Yield the time of each pass of a solve when it is run over and over."""
    try:
        from byte_floor import SolverPasses
    except ImportError as error:
        yield {'left out': f'passes of a solve, repeated: {error}'}
        return
    context = Context()
    for side in (16,) if quick else (64, 128, 256):
        passes = SolverPasses(side, context)
        passes.bind()
        yield {'side': side, 'unit': 'us a pass, repeated', **{
            name: 1e6 * seconds_each(run, context, 0.02) for name, run in passes.passes.items()}}
        passes.delete()
    context.close()


def _measure(quick: bool) -> Iterator[Row]:
    yield from _repeated(quick)
    timers = _Timers()
    with patch.object(program, '_linked', timers.linked(program._linked)), \
            patch.object(quick_calls, 'use_program', timers.used(quick_calls.use_program)), \
            patch.object(quick_calls, 'dispatch', timers.timed(quick_calls.dispatch)), \
            patch.object(
                quick_calls, 'dispatch_indirect', timers.timed(quick_calls.dispatch_indirect)):
        context = Context()
        # One small case of each on software, which has no timer.
        cases = (('mass_spring', 32), ('mass_spring', 64), ('constraint', 32)) if quick else (
            ('mass_spring', 128), ('mass_spring', 1024), ('constraint', 64), ('constraint', 256),
            ('adaptive', 128))
        if context.is_software:
            cases = cases[:1] + cases[2:3]
        for mode, side in cases:
            values = {'mode': mode, 'rows': side, 'cols': side}
            if mode == 'mass_spring':
                values |= {'stiffness.structural': 10.0, 'stiffness.shear': 10.0}
            with Simulation(Scene(values), context=context) as cloth:
                cloth.warm_up()
                cloth.step(60 if mode == 'adaptive' else 10)
                cloth.finish()
                timers.take()
                begin = time.perf_counter()
                cloth.step(_STEPS)
                cloth.finish()
                wall = time.perf_counter() - begin
                found = timers.take()
            total = sum(map(sum, found.values()))
            yield {'mode': mode, 'side': side,
                   'wall, with queries [ms a step]': 1e3 * wall / _STEPS,
                   'device [ms a step]': 1e3 * total / _STEPS,
                   'dispatches a step': sum(map(len, found.values())) / _STEPS}
            if total < _LEAST_SHARE * wall:
                yield {'left out': f'passes of {mode}, {side}: this device has no timer'}
                continue
            for name, times in sorted(found.items(), key=lambda each: -sum(each[1])):
                yield {'mode': mode, 'side': side, 'pass': name,
                       'a step': len(times) / _STEPS, 'us each': 1e6 * sum(times) / len(times),
                       'share of device time': sum(times) / total}
        context.close()


SECTION = Section('passes', 'Passes by timer queries', 50.0, _measure)
