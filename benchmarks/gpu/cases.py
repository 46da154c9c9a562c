# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Small scenes that together use every mode and every load, for checks on any device."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.sim.scene import Scene

_SPRINGS: Mapping[str, Any] = {
    'material.preset': 'none', 'rows': 17, 'cols': 21, 'dt': 0.005, 'start.jitter': 0.02}
_BALL: Mapping[str, Any] = {
    'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.2],
    'colliders.ball.friction': 0.3, 'start.z': 0.215, 'pins': ['none']}
_BODIES: Mapping[str, Any] = {
    'colliders.names': ['floor', 'box', 'rod', 'drum'], 'colliders.floor.shape': 'plane',
    'colliders.box.shape': 'box', 'colliders.box.size': [0.3, 0.3, 0.2],
    'colliders.box.position': [0.2, 0.2, 0.1], 'colliders.rod.shape': 'capsule',
    'colliders.rod.size': [0.08, 0.5], 'colliders.rod.position': [-0.2, 0.0, 0.1],
    'colliders.drum.shape': 'cylinder', 'colliders.drum.size': [0.1, 0.2],
    'colliders.drum.position': [0.2, -0.25, 0.1], 'start.z': 0.215, 'pins': ['none']}
_PUSHES: Mapping[str, Any] = {
    'pushes.start': [0.0, 0.01], 'pushes.duration': [0.03, 0.05],
    'pushes.force': [0.2, 0.0, 3.0, 0.0, 1.0, 0.0],
    'pushes.center': [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 'pushes.radius': [0.0, 0.35]}
# Below the strain from which hard edges are springs for a while.
_IMPLICIT: Mapping[str, Any] = {
    'solver.tolerance': 1e-5, 'solver.max_iterations': 300, 'start.jitter': 0.002,
    'auto_substeps': False}


@dataclass(frozen=True)
class Case:
    """
    A scene and the steps after which its state is compared.

    :param has_reference: whether the float64 reference models all of it
    """

    name: str
    values: Mapping[str, Any]
    steps: int = 20
    has_reference: bool = False

    def scene(self) -> Scene:
        """Return the scene."""
        return Scene({**_SPRINGS, **self.values})


CASES = (
    Case('springs', {}, has_reference=True),
    Case('springs, paper layout', {'layout': 'paper'}, has_reference=True),
    Case('springs, pushed', _PUSHES, has_reference=True),
    Case('springs, moving pin', {
        'pin_moves.start': [0.02], 'pin_moves.node': ['top_left'],
        'pin_moves.target': [-0.4, 0.45, 1.1], 'pin_moves.speed': [1.0]}),
    Case('fabric in wind', {
        'material.preset': 'trousers', 'air.density': 1.225, 'air.wind': [2.0, 1.0, 0.0],
        'pins': ['top_edge'], 'start.pose': 'hanging'}),
    Case('bending and its damping', {
        'bending.rigidity': 1e-4, 'bending.damping': 0.01, 'stiffness.bend': 0.0,
        'damping.bend': 0.0}, has_reference=True),
    Case('springs on a ball', _BALL),
    Case('springs on four bodies', _BODIES),
    Case('springs, grasped', {
        'grasps.start': [0.01], 'grasps.name': ['hand'], 'grasps.position': [0.0, 0.0, 1.0],
        'grasps.radius': [0.2], 'grasp_moves.start': [0.03], 'grasp_moves.name': ['hand'],
        'grasp_moves.target': [0.1, 0.0, 1.2]}),
    Case('constraint', {'mode': 'constraint', **_IMPLICIT}, has_reference=True),
    Case('constraint, pushed', {
        'mode': 'constraint', **_PUSHES, **_IMPLICIT}, has_reference=True),
    Case('constraint, free', {
        'mode': 'constraint', 'pins': ['none'], **_PUSHES, **_IMPLICIT}),
    Case('constraint, block Jacobi', {
        'mode': 'constraint', 'solver.preconditioner': 'block_jacobi', **_IMPLICIT},
        has_reference=True),
    Case('constraint, all hard', {
        'mode': 'constraint', 'constraint.hard': ['structural', 'shear', 'bend'], **_IMPLICIT},
        has_reference=True),
    Case('constraint, implicit bending', {
        'mode': 'constraint', 'bending.rigidity': 1e-3, 'bending.damping': 0.01,
        'stiffness.bend': 0.0, 'damping.bend': 0.0, **_IMPLICIT}),
    Case('constraint on a ball', {'mode': 'constraint', **_BALL, **_IMPLICIT}, 10),
    Case('constraint on four bodies', {'mode': 'constraint', **_BODIES, **_IMPLICIT}, 3),
    Case('adaptive, calm', {'mode': 'adaptive'}),
    Case('adaptive at its limit', {
        'mode': 'adaptive', 'stiffness.structural': 2.0, 'stiffness.shear': 2.0,
        'stiffness.bend': 0.0, 'damping.bend': 0.0, 'adaptive.threshold': 0.02,
        'start.pose': 'hanging', 'start.jitter': 0.0, **_PUSHES, **_IMPLICIT}),
    Case("adaptive, the paper's scheme", {
        'mode': 'adaptive', 'adaptive.scheme': 'paper', 'adaptive.threshold': 0.05}),
)
