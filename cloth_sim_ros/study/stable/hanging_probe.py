# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a hanging cloth in mode constraint stays in its plane, with one substep a dt."""

from collections.abc import Mapping
from contextlib import closing
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.stable.hanging_cloth import hang
from cloth_sim_ros.study.stable.hanging_cloth import hanging_scene
from cloth_sim_ros.study.stable.probe_outcome import GROWN
from cloth_sim_ros.study.stable.probe_outcome import grown
from cloth_sim_ros.study.stable.probe_outcome import ProbeOutcome
import numpy as np

# Of the spacing, out of the plane: edges get longer by its square only.
_JITTER = 1e-5
_STEPS = 200
_LOOKS = 20


def hanging_probe(
        values: Mapping[str, Any], dt: float, *, context: Context | None = None) -> ProbeOutcome:
    """
    Step the hanging cloth of ``values`` by ``dt`` [s] and look how it moves out of its plane.

    What is unstable goes to and fro from step to step. So the amplitude is the RMS over the nodes
    of (y+ - 2 y + y-) / 4, and the growth is the largest over the RMS of y at the start. Shear
    edges push where the cloth narrows, and it buckles there: that is slow, and not counted.
    """
    scene = Scene({**hanging_scene(values), 'dt': dt})
    positions = hang(scene).positions.copy()
    offsets = np.random.default_rng(scene['start.seed']).uniform(
        -_JITTER * min(scene.spacing), _JITTER * min(scene.spacing), positions.shape[:2])
    positions[..., 1] += np.where(scene.pinned_nodes(), 0.0, offsets)
    with closing(Simulation(scene, context=context, stop_at_non_finite=False)) as run:
        run.set_state(positions, np.zeros_like(positions))
        begin = _rms(positions[..., 1])
        growth = 1.0
        for _ in range(_LOOKS):
            run.step(_STEPS // _LOOKS - 2)
            growth = max(growth, _alternating(run) / begin)
            if not growth < GROWN:
                break
        return grown(growth, run.substeps)


def _alternating(run: Simulation) -> float:
    """Return the amplitude of what changes sign in each step [m]; make two steps."""
    places = []
    for steps in (0, 1, 1):
        run.step(steps)
        seen = run.snapshot()
        if not seen.finite:
            return np.inf
        places.append(seen.positions[..., 1].astype(float))
    return 0.25 * _rms(places[2] - 2.0 * places[1] + places[0])


def _rms(distances: np.ndarray) -> float:
    return float(np.sqrt(np.mean(distances**2)))
