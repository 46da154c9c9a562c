# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mass-spring node steps per second from 1 K to 16 M nodes, beside the device's byte floor."""

from collections.abc import Iterator
from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import bench_scene
from gpu.clock import seconds_a_step
from gpu.clock import seconds_each
from gpu.device import board
from gpu.kernel import compiled
from gpu.kernel import COPY
from gpu.kernel import LOCAL
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section

# A node step loads position and velocity and stores both, 16 bytes each.
BYTES = 64
_SIDES = (32, 64, 128, 256, 512, 1024, 2048, 4096)
_VARIANTS: Mapping[str, Mapping[str, Any]] = {
    'default': {}, 'block 2': {'block': 2}, 'texture': {'loads': 'texture'},
    'paper': {'layout': 'paper'}}


# Bytes that a workgroup copies.
_GROUP_BYTES = 64 * LOCAL


def copy_seconds(context: Context, size: int) -> float:
    """Return the wall time [s] of a dispatch that loads ``size`` bytes and stores them."""
    groups = -(-size // _GROUP_BYTES)
    across = min(groups, 1024)
    down = -(-groups // across)
    source, target = (Buffer(across * down * _GROUP_BYTES) for _ in range(2))
    source.clear()
    quick_calls.use_program(compiled(COPY))

    def copy() -> None:
        source.bind_storage(0)
        target.bind_storage(1)
        quick_calls.dispatch(across, down, 1)
        shader_writes_visible()

    seconds = seconds_each(copy, context)
    source.delete()
    target.delete()
    return seconds * size / (across * down * _GROUP_BYTES)


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    sides = _SIDES[:2] if quick else _SIDES
    turn = 0.02 if quick else 0.1
    for side in sides:
        # Half of the bytes of a step are loaded, half stored.
        floor = side * side / copy_seconds(context, BYTES // 2 * side * side)
        row: Row = {'side': side, 'nodes': side * side,
                    'a copy as large [G node steps/s]': floor / 1e9}
        fault = ''
        for name, values in _VARIANTS.items():
            try:
                with Simulation(bench_scene(side, values), context=context) as cloth:
                    rate = side * side / seconds_a_step(cloth, turn)
                row[f'{name} [G node steps/s]'] = rate / 1e9
            except DeviceError as error:
                row[f'{name} [G node steps/s]'] = f'{error}'.partition(':')[0]
        yield {**row, FAULT: fault}
    yield {'side': sides[-1], **board()}
    context.close()


SECTION = Section('springs', 'Mass-spring', 80.0, _measure)
