# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The parameters of a recorded run, and the version that made it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cloth_sim_ros.analysis.recorded_values import plain_value
from cloth_sim_ros.recording.bag_metadata import folder_metadata
from cloth_sim_ros.recording.bag_metadata import PACKAGE
from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import Field


def recorded_version(path: Path) -> str:
    """
    Return the version named in the metadata.yaml of the recording ``path``; empty without one.

    :param path: of its folder or of a file in it
    """
    folder = path if path.is_dir() else path.parent
    custom = folder_metadata(folder).get('custom_data')
    version = custom.get(PACKAGE) if isinstance(custom, Mapping) else None
    return version if isinstance(version, str) else ''


@dataclass(frozen=True)
class RecordedScene:
    """
    What the recorded parameters say, in the terms of this version.

    :param values: recorded values of the scene's parameters, by name
    :param others: recorded values of all other parameters, the node's and unknown ones
    """

    values: Mapping[str, Any]
    others: Mapping[str, Any]

    @classmethod
    def from_parameters(cls, parameters: Any, mode: str = '') -> 'RecordedScene':
        """
        Take what a recording begins with.

        :param parameters: decoded rcl_interfaces/msg/Parameter
        :param mode: at the beginning of the recording, if it has that by itself
        """
        given = {parameter.name: plain_value(parameter.value) for parameter in parameters}
        if mode:
            given['mode'] = mode
        names = {field.name for field in fields_with_colliders(given)}
        return cls(
            {name: value for name, value in given.items() if name in names},
            {name: value for name, value in given.items() if name not in names})

    @property
    def missing(self) -> tuple[Field, ...]:
        """Return the parameters of a scene that the recording lacks: they take their default."""
        return tuple(field for name, field in self._fields.items() if name not in self.values)

    def unknown(self, fields: tuple[Field, ...]) -> tuple[str, ...]:
        """Return the recorded names that are neither the scene's nor among ``fields``."""
        names = {field.name for field in fields}
        return tuple(name for name in self.others if name not in names)

    def other(self, field: Field) -> Any:
        """Return the recorded value of ``field``, which is no scene's, or its default."""
        try:
            return field.check(self.others.get(field.name, field.default))
        except ClothSimError:
            return field.default

    def scene(self, changes: Mapping[str, Any] | None = None) -> Scene:
        """
        Return the recorded scene with ``changes``.

        :raises ClothSimError: when a recorded value is none in this version, or a change is wrong
        """
        changes = dict(changes or {})
        for name in self.values:
            if name not in changes:
                self._check(name)
        return Scene({**self.values, **changes})

    def as_recorded(self, changes: Mapping[str, Any]) -> Scene:
        """Return the recorded scene, with ``changes`` only where this version can't have it."""
        return self.scene({
            name: value for name, value in changes.items()
            if name in self.values and not self._is_valid(name)})

    def changed(self, scene: Scene) -> tuple[str, ...]:
        """Return the names of the recorded values that ``scene`` has otherwise."""
        return tuple(
            name for name, value in self.values.items()
            if not self._is_valid(name) or self._fields[name].check(value) != scene[name])

    @property
    def _fields(self) -> dict[str, Field]:
        return {field.name: field for field in fields_with_colliders(self.values)}

    def _is_valid(self, name: str) -> bool:
        try:
            self._fields[name].check(self.values[name])
        except ClothSimError:
            return False
        return True

    def _check(self, name: str) -> None:
        try:
            self._fields[name].check(self.values[name])
        except ClothSimError as error:
            raise ClothSimError(
                f'the recording has a parameter that this version does not accept: {error}; '
                f'replace it with --set {name}=...') from error
