# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What was measured to be fastest on a device, kept in the user's cache directory, by device."""

from collections.abc import Mapping
from dataclasses import asdict
from dataclasses import dataclass
import json
import os
from pathlib import Path
import re
from typing import Any
import warnings

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.scene import Scene

# In the environment: with one of these words, no device has a tuning.
VARIABLE = 'CLOTH_SIM_TUNING'
OFF = 'off'
_OFF = (OFF, 'no', 'false', '0')
_FOLDER = 'cloth_sim_ros'
# Max. size of a file [bytes]: a larger one is no tuning.
_MOST_BYTES = 1 << 16
# Max. sizes of cloth in a file [1].
MOST_SIZES = 64
# Max. letters of a file's name that are the device's [1], for people: the file has its name, too.
_MOST_LETTERS = 160
_FIELDS = {field.name: field for field in SCENE_FIELDS if field.name in (
    'rows', 'loads', 'block')}


@dataclass(frozen=True)
class Choice:
    """How a shader goes about its nodes: the parameters of a scene that leave its model alone."""

    loads: str
    block: int

    def __str__(self) -> str:
        """Return it in words."""
        return f'{self.loads} loads, block {self.block}'


# As in a scene: what the code chooses for a device without measurements.
BUILT_IN = Choice('auto', 0)


@dataclass(frozen=True)
class Tuning:
    """
    The choices for one device.

    :param device: GL_RENDERER
    :param driver: GL_VERSION
    :param choices: by the nodes along each side of the square cloth that was measured
    """

    device: str
    driver: str
    choices: Mapping[int, Choice]

    def choice(self, nodes: int) -> Choice:
        """
        Return the choice for a cloth of so many nodes.

        It is that of the measured cloths next to it in size, BUILT_IN where they have two: what is
        fastest for one can be slower for the other.
        """
        smaller = [side for side in sorted(self.choices) if side**2 <= nodes]
        larger = [side for side in sorted(self.choices) if side**2 >= nodes]
        found = {self.choices[side] for side in (*smaller[-1:], *larger[:1])}
        return found.pop() if len(found) == 1 else BUILT_IN


def tuned_choice(scene: Scene, device: str, driver: str) -> Choice:
    """
    Return what was found for cloths like ``scene`` on a device, BUILT_IN without a tuning.

    A file that cannot be used is warned of.
    """
    is_measured = scene['mode'] == 'mass_spring' and not scene.has_bending_damping
    if not is_measured or is_off():
        return BUILT_IN
    try:
        tuning = read_tuning(device, driver)
    except ClothSimError as error:
        warnings.warn(str(error))
        return BUILT_IN
    return tuning.choice(scene.node_count) if tuning else BUILT_IN


def is_off() -> bool:
    """Return whether the environment switches tunings off."""
    return os.environ.get(VARIABLE, '').lower() in _OFF


def read_tuning(device: str, driver: str) -> Tuning | None:
    """
    Return the tuning of a device; None when there is none.

    :raises ClothSimError: when its file is none, or of another device
    """
    path = tuning_path(device, driver)
    if path is None:
        return None
    try:
        content = read_regular(path, _MOST_BYTES)
        tuning = _tuning(json.loads(content))
        if (tuning.device, tuning.driver) != (device, driver):
            raise ValueError(f'it is of {cut(tuning.device)} with OpenGL {cut(tuning.driver)}')
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError, RecursionError) as error:
        raise ClothSimError(
            f'{cut(path)} is not the tuning of {cut(device)} ({cut(error)}): remove it, make it '
            f'anew with `cloth_sim tune`, or set {VARIABLE}={OFF}') from error
    return tuning


def write_tuning(tuning: Tuning) -> Path:
    """
    Keep ``tuning`` instead of an earlier one of its device, and return the path of its file.

    :raises ClothSimError: when it cannot be written
    """
    path = tuning_path(tuning.device, tuning.driver)
    if path is None:
        raise ClothSimError(
            'a tuning is kept in the cache directory of the user, and there is none without a '
            'home: set XDG_CACHE_HOME to the absolute path of a folder')
    content = {
        'device': tuning.device, 'driver': tuning.driver,
        'choices': [
            {'rows': side, **asdict(choice)} for side, choice in sorted(tuning.choices.items())]}
    # Under its name a file is whole.
    half = path.with_suffix(f'.{os.getpid()}.part')
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(half, 'w', encoding='utf-8') as file:
            file.write(json.dumps(content, indent=2) + '\n')
        os.replace(half, path)
    except OSError as error:
        raise ClothSimError(
            f'{cut(path)} cannot be written: {error}: free disk space, or set XDG_CACHE_HOME to '
            'another folder') from error
    return path


def tuning_path(device: str, driver: str) -> Path | None:
    """Return where the tuning of a device is kept; None when the user has no cache directory."""
    folder = os.environ.get('XDG_CACHE_HOME', '')
    if not os.path.isabs(folder):  # then it does not count, says its specification
        folder = os.path.expanduser('~/.cache')
    if not os.path.isabs(folder):
        return None
    name = re.sub('[^A-Za-z0-9]+', '_', f'{device}_{driver}').strip('_')[:_MOST_LETTERS]
    return Path(folder) / _FOLDER / f'tuning_{name}.json'


def _tuning(content: Any) -> Tuning:
    """Return what a file holds; ValueError when it is something else."""
    device, driver, listed = _values(content, 'device', 'driver', 'choices')
    if not isinstance(device, str) or not isinstance(driver, str):
        raise ValueError('device and driver must be words')
    if not isinstance(listed, list) or not 0 < len(listed) <= MOST_SIZES:
        raise ValueError(f'choices must be a list of 1 to {MOST_SIZES}')
    choices = {}
    for entry in listed:
        side, loads, block = (
            _FIELDS[name].check(value)
            for name, value in zip(_FIELDS, _values(entry, *_FIELDS)))
        choices[side] = Choice(loads, block)
    return Tuning(device, driver, choices)


def _values(content: Any, *names: str) -> list[Any]:
    if not isinstance(content, dict) or set(content) != set(names):
        raise ValueError(f'{", ".join(names)} are needed, got {shown(content)}')
    return [content[name] for name in names]
