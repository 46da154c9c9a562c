# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording as a run: its scene and version, what it begins with, and what followed."""

from collections.abc import Iterator
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain
from itertools import islice
from pathlib import Path
from typing import Any

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recorded_values import plain_value
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.recording.bag_metadata import folder_metadata
from cloth_sim_ros.recording.bag_metadata import PACKAGE
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.model.scene_fields import Field
from cloth_sim_ros.sim.scene import Scene


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
        names = {field.name for field in all_fields(given)}
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
        return {field.name: field for field in all_fields(self.values)}

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


# A recording as a run: what it begins with, and what followed.

_PARAMETERS = 'inputs/parameters'
_INPUTS = (
    _PARAMETERS, 'inputs/mode', 'inputs/pin', 'inputs/pin_target', 'inputs/grasp',
    'inputs/grasp_target', 'inputs/collider_target', 'inputs/push', 'inputs/wind',
    'inputs/command')
_SHOWN = ('points', 'stats', 'state')


class RecordedRun:
    """
    Reads the beginning of a recording; the rest when it is requested, one message at a time.

    The simulator begins each recording with inputs that stand for all that went before: the
    parameters, the mode, changed pins, grasps, moves in progress, and pushes that act or will act.

    ``path``, ``name`` and ``node`` are the recording's, ``scene`` has the parameters and the mode,
    ``begin`` is the stamp of the beginning, ``opening`` has the inputs there, ``device`` is the
    GL_RENDERER or empty, ``shown_size`` are rows and cols of the first cloud, or None.

    :raises ClothSimError: when it can't be run again, because it does not begin so
    """

    def __init__(self, recording: Recording) -> None:
        """Read up to what was shown first."""
        self.path, self.name, self.node = recording.path, recording.name, recording.node
        entries = recording.entries(*_INPUTS, *_SHOWN)
        inputs: list[Entry] = []
        shown: list[Entry] = []
        for entry in entries:
            if entry.key in _SHOWN:
                shown.append(entry)
                break
            inputs.append(entry)
        if not inputs and not shown:
            raise recording.no_frame()
        parameters = [
            entry.message for entry in inputs
            if entry.key == _PARAMETERS and entry.message.new_parameters]
        if len(parameters) != 1:
            raise _no_beginning(recording)
        modes = [entry.message.mode for entry in inputs if entry.key == 'inputs/mode']
        self.scene = RecordedScene.from_parameters(
            parameters[0].new_parameters, modes[-1] if modes else '')
        self.begin: Any = parameters[0].stamp
        self.opening = tuple(inputs)
        self._early = _up_to_the_first_cloud(shown, entries, self.begin)
        self._rest = entries
        states = [entry.message for entry in self._early if entry.key == 'state']
        self.device: str = states[0].device if states else ''
        self.shown_size = _shown_size(recording)

    @property
    def first_cloud(self) -> Any:
        """Get the decoded cloud of the beginning; None when it was not recorded."""
        return next((
            entry.message for entry in self._early
            if entry.key == 'points' and _is_at(entry, self.begin)), None)

    def entries(self) -> Iterator[Entry]:
        """Yield what came after the opening, once."""
        return chain(self._early, self._rest)


def stamp_of(message: Any) -> Any:
    """Return the simulated time that a decoded message carries."""
    return message.header.stamp if hasattr(message, 'header') else message.stamp


def _up_to_the_first_cloud(
        shown: list[Entry], entries: Iterator[Entry], begin: Any) -> list[Entry]:
    """Return ``shown`` and what follows it, up to the cloud of ``begin`` where there is one."""
    early = list(shown)
    for last in early:
        # Grows while it is read: each entry asks for the one behind it.
        if last.key != 'points' and _is_at(last, begin):
            early.extend(islice(entries, 1))
    return early


def _shown_size(recording: Recording) -> tuple[int, int] | None:
    """Return rows and cols of the first cloud, whose bytes are there; None without one."""
    for entry in recording.entries('points'):
        return Frame.from_points(entry.time, entry.message).records.shape
    return None


def _is_at(entry: Entry, moment: Any) -> bool:
    stamp = stamp_of(entry.message)
    return (stamp.sec, stamp.nanosec) == (moment.sec, moment.nanosec)


def _no_beginning(recording: Recording) -> ClothSimError:
    return ClothSimError(
        f'{recording.path} does not begin with the parameters of its run, which resimulation '
        'needs: record with recording.enabled, `cloth_sim record start` or `cloth_sim run '
        '--record`, which write them; `ros2 bag record` cannot')
