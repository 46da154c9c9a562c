# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Contact of the surface: a folded towel in each mode, a thin rod, and the same bits twice."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.self_contact_speed import folded
from cloth_sim_ros.study.self_contact_speed import towel
from gpu.modes import timed
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np

_DT = {'mass_spring': 0.001, 'adaptive': 0.001, 'constraint': 0.005}
_SIDES = (32, 64, 128)
# Simulated time and wall time of a run [s], whichever ends first.
_SIMULATED = 0.2
_WALL = 4.0


def _over_a_rod(side: int) -> Scene:
    """Return a cloth that falls onto a rod of half a cell in radius, between its nodes."""
    cell = 1.0 / (side - 1)
    return Scene({
        'rows': side, 'cols': side, 'dt': 0.005, 'pins': ['none'], 'start.z': 0.01,
        'colliders.names': ['rod'], 'colliders.rod.shape': 'capsule',
        'colliders.rod.size': [0.5 * cell, 2.0],
        'colliders.rod.position': [0.5 * cell, 0.0, -0.5 * cell],
        'colliders.rod.orientation': [float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5))]})


def _row(context: Context, scene: Scene, start: np.ndarray | None, simulated: float) -> Row:
    rows, ends, fault = [], {}, ''
    for _ in range(2):
        with take_inventory() as inventory, Simulation(scene, context=context) as cloth:
            cloth.warm_up()
            if start is not None:
                cloth.set_state(start, np.zeros_like(start))
            rows.append(timed(cloth, inventory, simulated=simulated, wall=_WALL))
            # A run that the wall time ended may be longer than another.
            state = cloth.positions().tobytes()
            if ends.setdefault(cloth.steps, state) != state:
                fault = 'other bits in a second run'
            if not cloth.snapshot().surface_contact_held:
                fault = 'contact of the surface was not held'
    return {**rows[1], FAULT: fault}


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    simulated = 0.02 if quick else _SIMULATED
    for side in (16,) if quick else _SIDES:
        for mode, dt in _DT.items():
            scene = towel(mode, side, is_enabled=True, dt=dt)
            yield {
                'mode': mode, 'scene': 'folded towel', 'side': side,
                **_row(context, scene, folded(side), simulated)}
        yield {
            'mode': 'mass_spring', 'scene': 'over a rod of half a cell', 'side': side,
            **_row(context, _over_a_rod(side), None, simulated)}
    context.close()


SECTION = Section('surface', 'Contact of the surface', 90.0, _measure)
