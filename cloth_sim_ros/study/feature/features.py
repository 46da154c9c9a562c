# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The features of a scene that can be left out, and the scene without each."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.sim.given_values import with_default_fabric
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.scene import Scene

# What a frame makes for others, besides the steps.
OUTPUTS = ('points', 'markers', 'stats', 'wrenches', 'recording')
_BEND, _SHEAR = 'bend springs', 'shear springs'
_DAMPING, _MODE = 'damping', 'mode'
_AIR, _PUSHES, _PIN_MOVES = 'air', 'pushes', 'pins that move'
_RIGIDITY = 'bending rigidity'
SCENE_FEATURES = (_BEND, _RIGIDITY, _SHEAR, _DAMPING, _MODE, _AIR, _PUSHES, _PIN_MOVES)
# Of the parameters that a feature is left out with.
_PREFIXES = {_AIR: ('air.', 'gusts.'), _PUSHES: ('pushes.',), _PIN_MOVES: ('pin_moves.',)}


def has_feature(values: Mapping[str, Any], feature: str) -> bool:
    """Return whether the scene of ``values`` has one of SCENE_FEATURES."""
    scene = Scene(values)
    if feature in (_BEND, _SHEAR):
        return _has_edges(scene, feature.split()[0])
    return {
        _DAMPING: scene.has_bending_damping or any(
            scene.damping(family) > 0.0 for family in ('structural', 'shear', 'bend')),
        _MODE: scene['mode'] != MassSpring.name,
        _AIR: scene.has_air,
        _RIGIDITY: scene.has_rigidity,
        _PUSHES: bool(scene['pushes.start']),
        _PIN_MOVES: bool(scene['pin_moves.start']),
    }[feature]


def without(values: Mapping[str, Any], feature: str) -> dict[str, Any]:
    """Return the scene of ``values`` without one of SCENE_FEATURES; plain springs for the mode."""
    values = with_default_fabric(values)
    if feature in (_BEND, _SHEAR):
        return _without_family(values, feature.split()[0])
    if feature == _DAMPING:
        return {**values, 'bending.damping': 0.0, **{
            f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}}
    if feature == _RIGIDITY:
        return {**values, 'bending.rigidity': 0.0}
    if feature == _MODE:
        return {**values, 'mode': MassSpring.name}
    prefixes = _PREFIXES[feature]
    return {name: value for name, value in values.items() if not name.startswith(prefixes)}


def _has_edges(scene: Scene, family: str) -> bool:
    return family in AVAILABLE[scene['mode']].edge_families(scene)


def _without_family(values: Mapping[str, Any], family: str) -> dict[str, Any]:
    scene = Scene(values)
    return {
        **values, f'stiffness.{family}': 0.0, f'damping.{family}': 0.0,
        **({'material.shear': 0.0} if family == 'shear' else {}),
        **{name: [other for other in scene[name] if other != family]
           for name in ('constraint.hard', 'constraint.springs')}}
