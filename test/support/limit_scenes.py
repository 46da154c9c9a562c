# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scene of the paper, for the reference."""

from typing import Any

from cloth_sim_ros.sim.scene import Scene

GRAVITY = 9.81


def push_up(strength: float, mass: float) -> dict[str, Any]:
    """Return a push of ``strength`` g on all free nodes, ``mass`` [kg], from 1.0 to 1.2 s."""
    return {'pushes.start': [1.0], 'pushes.duration': [0.2],
            'pushes.force': [0.0, 0.0, strength * GRAVITY * mass]}


def springs(stiffness: float, damping: float, bend: float) -> dict[str, float]:
    """Return one stiffness [N/m] and damping [N s/m] for all families, times ``bend`` there."""
    return {
        'stiffness.structural': stiffness, 'stiffness.shear': stiffness,
        'stiffness.bend': bend * stiffness, 'damping.structural': damping,
        'damping.shear': damping, 'damping.bend': bend * damping}


def paper_scene(dt: float, strength: float, bend: float = 1.0, **values: Any) -> Scene:
    """Return 12 x 12 nodes of 1 kg, 1 m apart, held at two corners, pushed at 1 s."""
    return Scene({
        'rows': 12, 'cols': 12, 'width': 11.0, 'height': 11.0, 'node_mass': 1.0, 'dt': dt,
        **springs(1000.0, 10.0, bend), **push_up(strength, 142.0), **values})
