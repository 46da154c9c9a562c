# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether the flat cloth at rest stays at rest, with springs and one step a dt."""

from collections.abc import Mapping
from contextlib import closing
import math
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.stable.probe_outcome import GROWN
from cloth_sim_ros.study.stable.probe_outcome import grown
from cloth_sim_ros.study.stable.probe_outcome import ProbeOutcome

# Small, so that springs answer in proportion; large beside what float32 rounds of a position.
JITTER = 1e-3
_STEPS = 600
_LOOKS = 12


def rest_scene(values: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return the cloth of ``values`` alone: no gravity, no pins, no pushes, all its waves seeded.

    It lies at the origin, where float32 has most digits.
    """
    alone = {name: value for name, value in values.items()
             if not name.startswith(('pushes.', 'pin_moves.'))}
    return {
        **alone, 'gravity': [0.0, 0.0, 0.0], 'start.pose': 'horizontal', 'start.z': 0.0,
        'start.jitter': JITTER, 'pins': ['none'], 'auto_substeps': False, 'substeps': 1}


def rest_probe(
        values: Mapping[str, Any], dt: float, *, context: Context | None = None) -> ProbeOutcome:
    """
    Step the cloth of ``values`` at rest by ``dt`` [s], beyond any check, and look at its growth.

    The growth is the root of kinetic and elastic energy over those at the start. Below the limit
    a conserved energy bounds it; above, the fastest wave grows without end.
    """
    scene = Scene({**rest_scene(values), 'dt': dt})
    with closing(Simulation(
            scene, context=context, check_stability=False, stop_at_non_finite=False)) as run:
        begin = _energy(run)
        growth = 1.0
        for _ in range(_LOOKS):
            run.step(_STEPS // _LOOKS)
            growth = max(growth, math.sqrt(_energy(run) / begin)) if begin else 0.0
            if not growth < GROWN:
                break
        return grown(growth, run.substeps)


def _energy(run: Simulation) -> float:
    seen = run.measure()
    return seen.kinetic_energy + seen.elastic_energy if seen.finite else math.inf
