# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How many substeps explicit springs need, and whether they are allowed."""

from decimal import Decimal
from decimal import ROUND_DOWN

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import MOST_SUBSTEPS
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.stability import choose_substeps
from cloth_sim_ros.sim.stability import needed_substeps
from cloth_sim_ros.sim.stability import safe_substep
from cloth_sim_ros.sim.stability import stability_limit

_SHORTEST_DT = next(field.low for field in SCENE_FIELDS if field.name == 'dt') or 0.0
_AUTOMATIC = 'auto_substeps: true'
_OTHER_SPRINGS = 'use softer springs, less damping or a larger node mass'


def spring_substeps(scene: Scene, mode: str, *, check_stability: bool = True) -> int:
    """
    Return the substeps of dt that ``scene`` asks for, or those that are stable.

    :param mode: its name, for the message
    :raises ClothSimError: when they are too many, or too long to be stable
    """
    substeps = choose_substeps(scene) if scene['auto_substeps'] else scene['substeps']
    if substeps > MOST_SUBSTEPS:
        raise ClothSimError(_too_many(scene))
    if check_stability and scene['dt'] / substeps > stability_limit(scene):
        raise ClothSimError(_too_long(scene, substeps, mode))
    return substeps


# What is printed is rounded down, so that a dt computed from it is accepted, and every other
# number of a message is computed from those printed.

def _too_many(scene: Scene) -> str:
    dt, refine, safe = scene['dt'], scene['refine'], _rounded_down(safe_substep(scene))
    count = refine * needed_substeps(dt, float(safe))
    longest = safe * (MOST_SUBSTEPS // refine)
    refined = f', times refine {refine}' if refine > 1 else ''
    return (
        f'dt {dt:g} s would take {count:.3g} substeps of the {float(safe):g} s that are safe in '
        f'any shape{refined}, more than {MOST_SUBSTEPS}: {_way_out(longest, _OTHER_SPRINGS)}')


def _too_long(scene: Scene, substeps: int, mode: str) -> str:
    safe, limit = _rounded_down(safe_substep(scene)), _rounded_down(stability_limit(scene))
    other = _AUTOMATIC if choose_substeps(scene) <= MOST_SUBSTEPS else _OTHER_SPRINGS
    return (
        f'dt {scene["dt"]:g} s in {substeps} substeps is above the stability limit '
        f'{float(limit):g} s of a substep in mode {mode} (node mass {scene.node_mass:.3g} kg), '
        f'and {float(safe):g} s are safe in any shape: {_way_out(safe * substeps, other)}')


def _way_out(longest: Decimal, other: str) -> str:
    """Return that dt may be as long as ``longest`` [s], if a dt can be so short, or ``other``."""
    if longest >= _SHORTEST_DT:
        return f'set dt <= {float(_rounded_down(longest)):g}, or {other}'
    return f'set {other}' if other == _AUTOMATIC else other


def _rounded_down(value: float | Decimal) -> Decimal:
    """Return ``value`` in three digits, not above it."""
    exact = Decimal(value)
    return exact.quantize(Decimal(1).scaleb(exact.adjusted() - 2), ROUND_DOWN)
