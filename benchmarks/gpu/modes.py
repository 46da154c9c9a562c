# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Steps of all modes, hung, on a ball and in air: wall time, dispatches, real-time factor."""

from collections.abc import Iterator
from collections.abc import Mapping
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import Inventory
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
# Each way in which mode adaptive holds edges at their limit.
_AT_LIMIT: Mapping[str, Any] = {
    'material.preset': 'none', 'stiffness.structural': 5.0, 'stiffness.shear': 5.0,
    'stiffness.bend': 0.0, 'damping.bend': 0.0, 'adaptive.threshold': 0.02}
_OF_ADAPTIVE: Mapping[str, Mapping[str, Any]] = {
    f'at its limit, {scheme}': {**_AT_LIMIT, 'adaptive.scheme': scheme}
    for scheme in ('list', 'lattice', 'whole', 'paper')}
_SIDES = {'mass_spring': (64, 128, 256), 'constraint': (64, 128, 256), 'adaptive': (32, 64, 128)}
_FRAME = 0.02  # [s]
# Simulated time and wall time of a run [s], whichever ends first.
_SIMULATED = 0.4
_WALL = 2.0


def timed_run(scene: Scene, context: Context, *, simulated: float, wall: float) -> Row:
    """Return what a run from the scene's start costs, compilation aside."""
    with take_inventory() as inventory, Simulation(scene, context=context) as cloth:
        cloth.warm_up()
        return timed(cloth, inventory, simulated=simulated, wall=wall)


def timed(cloth: Simulation, inventory: Inventory, *, simulated: float, wall: float) -> Row:
    """
    Return what a run of ``cloth``, which is warmed up, costs from where it is.

    :param inventory: of what is made on the device
    :param simulated: simulated time [s], after a first frame
    :param wall: wall time [s], after which the run ends as well
    """
    dt = cloth.scene['dt']
    cloth.advance(_FRAME)
    cloth.finish()
    before = sum(inventory.dispatches())
    steps = 0
    begin = time.perf_counter()
    while steps * dt < simulated and time.perf_counter() - begin < wall:
        steps += cloth.advance(_FRAME)
    cloth.finish()
    seconds = time.perf_counter() - begin
    snapshot = cloth.snapshot()
    return {
        'simulated [s]': steps * dt, 'ms a step': 1e3 * seconds / steps,
        'real-time factor': steps * dt / seconds,
        'dispatches a step': (sum(inventory.dispatches()) - before) / steps,
        'substeps of the last step': snapshot.substeps,
        'largest strain': float(snapshot.records['strain'].max())}


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    for mode, sides in _SIDES.items():
        for side in (16,) if quick else sides:
            scenes = {**_SCENES, **(_OF_ADAPTIVE if mode == 'adaptive' and not quick else {})}
            for name, values in scenes.items():
                # Springs of default stiffness need substeps in proportion to the side.
                scene = Scene({'mode': mode, 'rows': side, 'cols': side, **values})
                yield {
                    'mode': mode, 'scene': name, 'side': side,
                    **timed_run(scene, context, simulated=0.04 if quick else _SIMULATED,
                                wall=_WALL), FAULT: ''}
    context.close()


SECTION = Section('modes', 'Modes', 110.0, _measure)
