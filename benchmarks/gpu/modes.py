# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Steps of all modes, hung, on a ball and in air: wall time, dispatches, real-time factor."""

from collections.abc import Iterator
from collections.abc import Mapping
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section

_SCENES: Mapping[str, Mapping[str, Any]] = {
    'springs, hung': {'material.preset': 'none'},
    'fabric, hung in air': {},
    'springs on a ball': {
        'material.preset': 'none', 'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere',
        'colliders.ball.size': [0.15], 'colliders.ball.friction': 0.3, 'start.z': 0.2,
        'pins': ['none']},
}
_SIDES = {'mass_spring': (64, 128, 256), 'constraint': (64, 128, 256), 'adaptive': (32, 64, 128)}
_FRAME = 0.02  # [s]
# Simulated time and wall time of a run [s], whichever ends first.
_SIMULATED = 0.4
_WALL = 2.0


def timed_run(scene: Scene, context: Context, *, simulated: float, wall: float) -> Row:
    """Return what a run from the scene's start costs, compilation aside."""
    with take_inventory() as inventory, Simulation(scene, context=context) as cloth:
        cloth.warm_up()
        cloth.advance(_FRAME)
        cloth.finish()
        before = sum(inventory.dispatches())
        substeps = steps = 0
        begin = time.perf_counter()
        while steps * scene['dt'] < simulated and time.perf_counter() - begin < wall:
            steps += cloth.advance(_FRAME)
            substeps += cloth.engines.in_use.mode.substeps
        cloth.finish()
        seconds = time.perf_counter() - begin
        snapshot = cloth.snapshot()
        return {
            'simulated [s]': steps * scene['dt'], 'ms a step': 1e3 * seconds / steps,
            'real-time factor': steps * scene['dt'] / seconds,
            'dispatches a step': (sum(inventory.dispatches()) - before) / steps,
            'substeps of the last step': snapshot.substeps,
            'largest strain': float(snapshot.records['strain'].max())}


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    for mode, sides in _SIDES.items():
        for side in (16,) if quick else sides:
            for name, values in _SCENES.items():
                # Springs of default stiffness need substeps in proportion to the side.
                scene = Scene({'mode': mode, 'rows': side, 'cols': side, **values})
                yield {
                    'mode': mode, 'scene': name, 'side': side,
                    **timed_run(scene, context, simulated=0.04 if quick else _SIMULATED,
                                wall=_WALL), FAULT: ''}
    context.close()


SECTION = Section('modes', 'Modes', 110.0, _measure)
