# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The two scenes on which ways of limiting the strain are compared."""

from typing import Any

from cloth_sim_ros.sim.scene import FAMILIES

GRAVITY = 9.81
_PUSH_START, _PUSH_SECONDS = 1.0, 0.2


def paper_scene(push: float, dt: float, **changes: Any) -> dict[str, Any]:
    """Return 12 x 12 nodes of 1 kg, 1 m apart; ``push`` in units of the weight, upward."""
    springs = {
        **{f'stiffness.{family}': 1000.0 for family in FAMILIES},
        **{f'damping.{family}': 10.0 for family in FAMILIES}}
    return {
        'rows': 12, 'cols': 12, 'width': 11.0, 'height': 11.0, 'node_mass': 1.0, **springs,
        **_pushed(12, 1.0, push), 'mode': 'adaptive', 'dt': dt, **changes}


def unit_scene(nodes: int, push: float, dt: float, **changes: Any) -> dict[str, Any]:
    """Return ``nodes`` x ``nodes`` over 1 m2 with springs so soft that the limit has to work."""
    springs = {}
    for family, stiffness in zip(FAMILIES, (5.0, 5.0, 0.5)):
        springs[f'stiffness.{family}'] = stiffness
        springs[f'damping.{family}'] = 2e-4 * stiffness
    return {
        'rows': nodes, 'cols': nodes, 'areal_density': 0.2, **springs,
        **_pushed(nodes, 0.2 / nodes**2, push), 'mode': 'adaptive', 'dt': dt, **changes}


def _pushed(nodes: int, node_mass: float, push: float) -> dict[str, Any]:
    free = nodes * nodes - 2
    return {
        'pushes.start': [_PUSH_START], 'pushes.duration': [_PUSH_SECONDS],
        'pushes.force': [0.0, 0.0, push * GRAVITY * node_mass * free]}
