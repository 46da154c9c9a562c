# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The values given for a scene: read from a file, and completed by preset and fabric."""

from collections.abc import Mapping
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.materials import MATERIAL
from cloth_sim_ros.sim.model.materials import MATERIAL_SPRINGS
from cloth_sim_ros.sim.model.materials import with_material
from cloth_sim_ros.sim.model.scene_fields import PRESETS
from cloth_sim_ros.sim.model.shape import beside

NO_PINS = ('none',)
# A woven one whose threads hardly stretch; without air it would whip, and never come to rest.
DEFAULT_FABRIC = MappingProxyType({'material.preset': 'trousers', 'air.density': 1.225})
# They stretch, too, which would add to what a material says.
_BEND_SPRINGS = ('stiffness.bend', 'damping.bend')
# Paths of images.
_PATHS = ('shape.mask', 'look.texture', 'look.backdrop')
_EDGES_OF_CONSTRAINT = ('constraint.hard', 'constraint.springs')


def load_parameters(path: str | Path) -> dict[str, Any]:
    """
    Return the parameters of a ROS parameter YAML as dotted names and values.

    Every node section of the file is taken, later ones over earlier ones; within one, each
    parameter stands once. Paths of images are taken from the folder of the file.

    :raises ClothSimError: when the file can't be read or is no parameter file
    """
    document = load_yaml(path)
    if not isinstance(document, Mapping):
        raise ClothSimError(
            f'{cut(path)} holds no parameters: write "/**: {{ros__parameters: ...}}"')
    parameters: dict[str, Any] = {}
    for section in document.values():
        if not isinstance(section, Mapping) or not isinstance(
                section.get('ros__parameters'), Mapping):
            raise ClothSimError(
                f'{cut(path)} has a section without ros__parameters: '
                'write "/**: {ros__parameters: ...}"')
        names: dict[str, Any] = {}
        _flatten(section['ros__parameters'], '', names, path)
        parameters.update(names)
    for name in _PATHS:
        image = parameters.get(name)
        if isinstance(image, str):
            parameters[name] = beside(path, image)
    return parameters


def _flatten(
        tree: Mapping[str, Any], prefix: str, into: dict[str, Any], path: str | Path) -> None:
    for key, value in tree.items():
        name = f'{prefix}{key}'
        if isinstance(value, Mapping):
            _flatten(value, f'{name}.', into, path)
        elif name in into:
            raise ClothSimError(
                f'{path} has the parameter {cut(name)} twice, nested and with a dot: '
                'keep one')
        else:
            into[name] = value


# What the values given for a scene mean for those that are left out.

def with_preset(given: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return ``given``, completed by the values of its preset.

    Where another mode is given than that of the preset, or mode constraint, its edges stay as they
    are without one: a preset never makes springs of edges that were to be hard.
    """
    name = given.get('preset')
    # What is no preset is left to the check of the field.
    values = dict(_values(name)) if name in PRESETS else {}
    if 'mode' in given:
        for edges in _EDGES_OF_CONSTRAINT:
            values.pop(edges, None)
    return {**values, **given}


@cache
def _values(name: str) -> Mapping[str, Any]:
    path = shared_directory('config') / 'presets' / f'{name}.yaml'
    return MappingProxyType(load_parameters(path))


def with_default_fabric(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return ``given`` with a fabric in air if it is a cloth that is given nothing of its kind."""
    says_how_it_stretches = any(name.startswith(('stiffness.', 'material.')) for name in given)
    is_chain = 1 in (given.get('rows'), given.get('cols'))
    if says_how_it_stretches or is_chain:
        return dict(given)
    return {**DEFAULT_FABRIC, **given}


def completed(given: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return ``given``, completed by the values that follow from it.

    Presets bring their values. A cloth of neither springs nor a material is of the default fabric,
    in still air. A total mass takes the place of the default areal density, a material that of the
    default springs, and pins given by points that of the default pins. Nothing is checked here.
    """
    values = with_material(with_default_fabric(with_preset(given)))
    if values.get('total_mass'):
        values.setdefault('areal_density', 0.0)
    if any(values.get(name) for name in MATERIAL):
        values = {**dict.fromkeys((*MATERIAL_SPRINGS, *_BEND_SPRINGS), 0.0), **values}
    points = values.get('pin_points.positions')
    if isinstance(points, Sequence) and points:
        values.setdefault('pins', NO_PINS)
    return values
