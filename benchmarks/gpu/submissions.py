# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Dispatches, barriers and waits of a substep, by mode and scene."""

from collections.abc import Iterator
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.self_contact_speed import folded
from cloth_sim_ros.study.self_contact_speed import towel
from gpu.call_counts import CallCounts
from gpu.call_counts import counted_calls
from gpu.section import Row
from gpu.section import Section
import numpy as np

# What a dispatch costs with its barrier [s], whatever it computes: an NVIDIA H200 takes 4 to 5 us
# (docs/notes/gpu/nvidia_h200.md).
DISPATCH_TIME = 5e-6
_SIDE = 64
_FRAME = 0.02  # [s]
# Simulated time before counting, and of it [s].
_SETTLE, _COUNTED = 0.1, 0.1
_SPRINGS: Mapping[str, Any] = {'material.preset': 'none'}
_BALL: Mapping[str, Any] = {
    **_SPRINGS, 'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere',
    'colliders.ball.size': [0.15], 'colliders.ball.friction': 0.3, 'start.z': 0.2,
    'pins': ['none']}
_TOWEL = 'towel, folded'
_SCENES: Mapping[str, Mapping[str, Mapping[str, Any]]] = {
    'mass_spring': {'springs, hung': _SPRINGS, 'springs on a ball': _BALL},
    'constraint': {
        'springs, hung': _SPRINGS, 'fabric, hung in air': {}, 'springs on a ball': _BALL},
    'adaptive': {
        'fabric, few edges at their limit': {'adaptive.scheme': 'list'},
        'springs, hung': _SPRINGS, 'springs on a ball': _BALL}}
_DT_OF_TOWEL = {'mass_spring': 0.001, 'constraint': 0.005, 'adaptive': 0.001}


def advance(cloth: Simulation, seconds: float) -> int:
    """Simulate ``seconds`` more, in frames, and return the substeps made."""
    made = 0
    for _ in range(round(seconds / _FRAME)):
        of_steps: list[int] = []
        first = cloth.steps
        cloth.stepping.aim(_FRAME)

        def note(noted: list[int] = of_steps) -> bool:
            noted.append(cloth.substeps)
            return False

        cloth.work(is_due=note)
        # Springs make several steps at once, all of as many substeps.
        made += cloth.substeps * (cloth.steps - first) if cloth.mode == 'mass_spring' else sum(
            of_steps)
    return made


def counted(
        scene: Scene, context: Context, start: np.ndarray | None = None, *,
        settle: float, seconds: float) -> Row:
    """
    Return what substeps of ``scene`` submit, each by itself, and the real-time factor by that.

    :param start: positions to start from [m]; None takes those of the scene
    :param settle: simulated time before counting [s]
    :param seconds: simulated time in which it is counted [s]
    """
    with counted_calls() as counts, Simulation(scene, context=context, tuned=False) as cloth:
        cloth.warm_up()
        if start is not None:
            cloth.set_state(start, np.zeros_like(start))
        advance(cloth, settle)
        first = cloth.steps
        counts.clear()
        substeps = advance(cloth, seconds)
        found = CallCounts(**asdict(counts))
        steps = cloth.steps - first
    return {
        'substeps a step': substeps / steps,
        **{f'{name} a substep': count / substeps for name, count in asdict(found).items()},
        f'real-time factor at {1e6 * DISPATCH_TIME:g} us a dispatch':
            scene['dt'] * steps / (DISPATCH_TIME * found.dispatches)}


def rows(context: Context, *, quick: bool = False, only: str = '') -> Iterator[Row]:
    """
    Yield the counts of all modes and scenes, as they run in ``context``.

    :param quick: small cloths for a short time
    :param only: mode to count; all when empty
    """
    side = 16 if quick else _SIDE
    settle, seconds = (0.0, _FRAME) if quick else (_SETTLE, _COUNTED)
    for mode, scenes in _SCENES.items():
        if only not in ('', mode):
            continue
        head: Row = {'mode': mode, 'side': side}
        for name, values in scenes.items():
            scene = Scene({'mode': mode, 'rows': side, 'cols': side, **values})
            yield {**head, 'scene': name, **counted(
                scene, context, settle=settle, seconds=seconds)}
        scene = towel(mode, side, is_enabled=True, dt=_DT_OF_TOWEL[mode])
        yield {**head, 'scene': _TOWEL, **counted(
            scene, context, folded(side), settle=settle, seconds=seconds)}


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    yield from rows(context, quick=quick)
    context.close()


SECTION = Section('submissions', 'Submissions', 60.0, _measure)
