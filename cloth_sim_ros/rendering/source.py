# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Sources of pictures: frames of a recording, or a state file."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.frames import COLLIDER_KEYS
from cloth_sim_ros.analysis.frames import ColliderHistory
from cloth_sim_ros.analysis.frames import default_times
from cloth_sim_ros.analysis.frames import frames_at
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.files.checked_npz import load_arrays
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.rendering.cloth_drawing import surface_normals
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import numpy as np

_WRITE_IT_ANEW = 'write it with `cloth_sim run --out`'
# Coordinate from which a run counts as blown up [m]; its square is beyond float32 not far above.
_FARTHEST = 1e12


class Source(ABC):
    """
    Frames of one cloth in the order of time.

    :param name: that tells it from others
    """

    name: str

    @property
    @abstractmethod
    def modes(self) -> list[str]:
        """Get the simulation modes, in the order they came; none when that is not known."""

    @property
    @abstractmethod
    def device(self) -> str:
        """Name the device that simulated it; empty when that is not known."""

    @property
    @abstractmethod
    def missing(self) -> list[str]:
        """Name what can't be drawn, since it is not there."""

    @abstractmethod
    def frames(self) -> Iterator[Frame]:
        """Yield every frame, one in memory at a time."""

    @abstractmethod
    def frames_at(self, times: Sequence[float]) -> list[Frame]:
        """Return the frame nearest to each of ``times`` [s], which grow."""

    @abstractmethod
    def default_times(self, count: int) -> list[float]:
        """Return at most ``count`` times [s] that show what happens."""


def nearest_frames(frames: Iterable[Frame], times: Iterable[float]) -> Iterator[Frame]:
    """
    Yield the frame nearest to each of ``times`` [s]; two are in memory at a time.

    :param frames: at least one, in the order of time
    :param times: which grow
    """
    stream = iter(frames)
    before = next(stream)
    after: Frame | None = before
    for time in times:
        while after is not None and after.time < time:
            before, after = after, next(stream, None)
        if after is None or time - before.time < after.time - time:
            yield before
        else:
            yield after


class RecordingSource(Source):
    """The cloth of ``recording``."""

    def __init__(self, recording: Recording) -> None:
        """Keep the recording, without reading it."""
        self._recording = recording
        path = recording.path.resolve()
        self.name = path.stem if path.is_file() else path.name

    @property
    def modes(self) -> list[str]:
        """Get the simulation modes, in the order they came; none when that is not known."""
        return self._metadata[0]

    @property
    def device(self) -> str:
        """Name the device that simulated it; empty when that is not known."""
        return self._metadata[1]

    @property
    def missing(self) -> list[str]:
        """Name what can't be drawn: colliders that this version does not know."""
        return ['colliders'] if self._metadata[2] else []

    def frames(self) -> Iterator[Frame]:
        """Yield every frame; ClothSimError when there is none."""
        is_empty = True
        for frame in read_frames(self._recording):
            is_empty = False
            yield frame
        if is_empty:
            raise self._recording.no_frame()

    def frames_at(self, times: Sequence[float]) -> list[Frame]:
        """Return the frame nearest to each of ``times`` [s], which grow."""
        return frames_at(self._recording, times)

    def default_times(self, count: int) -> list[float]:
        """Return ``count`` times [s] that show what happens."""
        return default_times(self._recording, count)

    @cached_property
    def _metadata(self) -> tuple[list[str], str, str]:
        """Get the modes, the device, and the problem with the colliders, empty if none."""
        modes: list[str] = []
        device = ''
        colliders = ColliderHistory()
        for entry in self._recording.entries('inputs/mode', 'state', *COLLIDER_KEYS):
            if entry.key in COLLIDER_KEYS:
                colliders.read(entry)
            elif entry.key == 'state':
                device = entry.message.device
            elif entry.message.mode not in modes:
                modes.append(entry.message.mode)
        return modes, device, colliders.problem


class StateSource(Source):
    """
    The one frame of the npz file at ``path``.

    It needs ``positions``, (rows, cols, 3) [m]; ``time`` [s], ``strain`` and ``flags``, both
    (rows, cols), are taken where they are there. Positions may be NaN where there is no node, by
    the flags.

    :raises ClothSimError: when there is no such file, or no cloth in it
    """

    def __init__(self, path: str | Path) -> None:
        """Read the file."""
        self.name = Path(path).stem
        arrays = _read(path)
        positions = _positions(path, arrays)
        shape = positions.shape[:2]
        records = np.zeros(shape, POINT_DTYPE)
        self._missing = [key for key in ('strain', 'flags') if arrays.get(key) is None]
        records['strain'] = np.nan
        for key in ('strain', 'flags'):
            if key not in self._missing:
                records[key] = _checked(path, arrays, key, shape)
        self._frame = Frame(0.0, records)
        _check_positions(path, positions[self._frame.present])
        normals = surface_normals(positions)
        for place, axis in enumerate('xyz'):
            records[axis] = positions[..., place]
            records[f'normal_{axis}'] = normals[..., place]
        time = _checked(path, arrays, 'time', ()) if 'time' in arrays else 0.0
        if not np.isfinite(time):
            raise ClothSimError(
                f'time in {path} is {time:g} s, not a finite number: {_WRITE_IT_ANEW}')
        self._frame = replace(self._frame, time=float(time))

    @property
    def modes(self) -> list[str]:
        """Get none: a state file does not tell."""
        return []

    @property
    def device(self) -> str:
        """Name none: a state file does not tell."""
        return ''

    @property
    def missing(self) -> list[str]:
        """Name what can't be drawn, since it is not there."""
        told = {'strain': 'strain', 'flags': 'pins and limits'}
        return [told[key] for key in self._missing]

    def frames(self) -> Iterator[Frame]:
        """Yield the frame."""
        yield self._frame

    def frames_at(self, times: Sequence[float]) -> list[Frame]:
        """Return the frame once for each of ``times``."""
        return [self._frame] * len(times)

    def default_times(self, count: int) -> list[float]:
        """Return its time [s]."""
        return [self._frame.time]


def _read(path: str | Path) -> dict[str, np.ndarray]:
    try:
        return load_arrays(path, 'state file', _WRITE_IT_ANEW)
    except FileNotFoundError as error:
        raise ClothSimError(
            f'there is no state file {cut(path)}: {_WRITE_IT_ANEW}') from error
    except OSError as error:
        raise ClothSimError(
            f'{cut(path)} cannot be read ({error.strerror}): {_WRITE_IT_ANEW}') from error


def _checked(
        path: str | Path, arrays: dict[str, np.ndarray], key: str,
        shape: tuple[int, ...]) -> np.ndarray:
    """Return the array ``key``; ClothSimError when it is none of numbers and of ``shape``."""
    array = arrays[key]
    if array.shape != shape:
        raise ClothSimError(
            f'{key} in {path} has the shape {array.shape}, the cloth {shape}: {_WRITE_IT_ANEW}')
    kinds = np.integer if key == 'flags' else np.floating
    if not np.issubdtype(array.dtype, kinds):
        raise ClothSimError(
            f'{key} in {path} has the type {array.dtype}: {_WRITE_IT_ANEW}')
    return array


def _positions(path: str | Path, arrays: dict[str, np.ndarray]) -> np.ndarray:
    positions = arrays.get('positions')
    if positions is None:
        raise ClothSimError(f'{path} holds no positions: {_WRITE_IT_ANEW}')
    if positions.ndim != 3 or positions.shape[2] != 3 or 0 in positions.shape:
        raise ClothSimError(
            f'positions in {path} have the shape {positions.shape}, not (rows, cols, 3): '
            f'{_WRITE_IT_ANEW}')
    is_number = np.issubdtype(positions.dtype, np.number)
    if not is_number:
        _check_positions(path, np.array(np.nan))
    return positions.astype(float)


def _check_positions(path: str | Path, positions: np.ndarray) -> None:
    if not (np.abs(positions) <= _FARTHEST).all():
        raise ClothSimError(
            f'positions in {path} are not all finite numbers up to {_FARTHEST:g} m: use a state '
            'from before the blow-up')
