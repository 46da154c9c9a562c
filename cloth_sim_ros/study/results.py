# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The runs of a study, what became of each, and the folder of their results."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
import fcntl
from functools import cache
import hashlib
import json
import os
from pathlib import Path
from typing import Any
from typing import cast

import cloth_sim_ros
from cloth_sim_ros.files.checked_npz import load_arrays
from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Max. size of a source file [bytes].
_MOST_BYTES = 1 << 24


@cache
def code_digest() -> str:
    """Return a fingerprint of all Python files and shaders: a version stays while these change."""
    digest = hashlib.sha256()
    for root, pattern in (
            (Path(cloth_sim_ros.__file__).parent, '*.py'), (shader_directory(), '*.*')):
        for path in sorted(root.rglob(pattern)):
            if path.is_file():
                digest.update(f'{path.relative_to(root)}\0'.encode())
                digest.update(read_regular(path, _MOST_BYTES))
    return digest.hexdigest()


@dataclass(frozen=True)
class Run:
    """
    What is to be made, in plain values: everything that its result depends on.

    :param function: `module:name` of a function (scene, **settings) that returns plain values and
        NumPy arrays by name, 'device' among them
    :param scene: scene parameters by name; what is not given has its default
    :param settings: the other arguments of the function
    """

    function: str
    scene: Mapping[str, Any] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def key(self) -> str:
        """Tell this run from all others, also by other code."""
        return _digest([self.function, self.scene, self.settings, code_digest()])[:20]

    @property
    def scene_sha256(self) -> str:
        """Return a fingerprint of all parameters of the scene, defaults included."""
        try:
            return _digest(Scene(self.scene).values)
        except ClothSimError:
            return _digest(self.scene)


def _digest(values: Any) -> str:
    text = json.dumps(values, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


# Result of a run: one line of JSON, and a file of arrays.

DONE = 'done'
REFUSED = 'refused'
STOPPED = 'stopped'
FAILED = 'failed'


@dataclass(frozen=True)
class Result:
    """
    What became of one run.

    :param outcome: done; refused, with the reason that the simulation gave; stopped, where its
        state was lost; or failed, with the error, and made again when the study is continued
    :param scene: parameters that the run was given
    :param scene_sha256: fingerprint of all parameters, defaults included
    :param values: what the function returned, without arrays
    :param device: that it ran on; empty where that is not known
    :param wall_seconds: from begin to end of the function; others may have run beside it
    :param arrays: what the function returned as arrays, by name; kept in a file of their own
    """

    key: str
    function: str
    outcome: str
    reason: str
    scene: Mapping[str, Any]
    scene_sha256: str
    settings: Mapping[str, Any]
    values: Mapping[str, Any]
    device: str
    version: str
    wall_seconds: float
    arrays: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def is_done(self) -> bool:
        """Return whether there are values."""
        return self.outcome == DONE

    @property
    def is_final(self) -> bool:
        """Return whether the run need not be made again."""
        return self.outcome != FAILED

    def line(self) -> str:
        """Return the line of JSON, without arrays."""
        plain = {name: value for name, value in vars(self).items() if name != 'arrays'}
        return json.dumps({**plain, 'arrays': sorted(self.arrays)}, allow_nan=False)


def unmade(run: Run, outcome: str, reason: str, **known: Any) -> Result:
    """Return the result of a run that has no values."""
    return Result(**{
        **describe(run), 'outcome': outcome, 'reason': reason, 'values': {}, 'device': '',
        'wall_seconds': 0.0, **known})


def describe(run: Run) -> dict[str, Any]:
    """Return what the result of ``run`` repeats of it."""
    return {
        'key': run.key, 'function': run.function, 'scene': dict(run.scene),
        'scene_sha256': run.scene_sha256, 'settings': dict(run.settings),
        'version': project_version()}


# The results of a study: a file with a line of JSON for each run, and arrays beside it.

LINES = 'results.jsonl'
_ARRAYS = 'arrays'


class ResultsFolder:
    """
    Keeps results as they come, and finds those that are there.

    A line is written whole. A last line that is only half there, of a study that was killed, is
    dropped. Of two lines with the same key the later one counts.

    :param folder: made when it is not there
    :raises ClothSimError: when it can't be written, or another study is writing into it
    """

    def __init__(self, folder: str | Path) -> None:
        """Read what is there."""
        self.folder = Path(folder)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            if (self.folder / LINES).exists():
                open_regular(self.folder / LINES).close()
            self._file = open(self.folder / LINES, 'a+b')
        except OSError as error:
            raise ClothSimError(
                f'{folder} cannot be written: {error}: give another --out') from error
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            self._file.close()
            raise ClothSimError(
                f'another study is writing into {folder}: wait for it, or give another --out'
            ) from error
        self._lines: dict[str, dict[str, Any]] = {}
        self._read_lines()

    def __enter__(self) -> 'ResultsFolder':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Let others write here."""
        self._file.close()

    def find(self, key: str) -> Result | None:
        """Return the result of the run ``key``; None when there is none, or half of one."""
        line = self._lines.get(key)
        if line is None:
            return None
        if not line['arrays']:
            return Result(**{**line, 'arrays': {}})
        try:
            arrays = load_arrays(
                self._array_path(key), 'file of results', 'start the study again')
        except (OSError, ClothSimError):
            return None
        return Result(**{**line, 'arrays': arrays})

    def add(self, result: Result) -> None:
        """Keep ``result``."""
        try:
            if result.arrays:
                self._write_arrays(result)
            self._file.write(result.line().encode() + b'\n')
            self._file.flush()
        except OSError as error:
            raise ClothSimError(
                f'{self.folder} cannot be written: {error}: free disk space, and restart the '
                'study to resume it') from error
        self._lines[result.key] = json.loads(result.line())

    def _read_lines(self) -> None:
        self._file.seek(0)
        whole = 0
        for number, line in enumerate(self._file, 1):
            if not line.endswith(b'\n'):
                break
            whole += len(line)
            try:
                values = json.loads(line)
                Result(**values)
                self._lines[values['key']] = values
            except (ValueError, TypeError, KeyError, RecursionError) as error:
                raise ClothSimError(
                    f'line {number} of {self.folder / LINES} is not a study result: remove it, or '
                    'give another --out') from error
        self._file.truncate(whole)

    def _write_arrays(self, result: Result) -> None:
        path = self._array_path(result.key)
        path.parent.mkdir(exist_ok=True)
        # Under its name a file is whole.
        half = path.with_suffix('.part')
        with open(half, 'wb') as file:
            # Its types take any name for that of an option.
            np.savez(file, **cast(dict[str, Any], result.arrays))
        os.replace(half, path)

    def _array_path(self, key: str) -> Path:
        return self.folder / _ARRAYS / f'{key}.npz'
