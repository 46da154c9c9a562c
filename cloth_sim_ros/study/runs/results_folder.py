# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The results of a study: a file with a line of JSON for each run, and arrays beside it."""

import fcntl
import json
import os
from pathlib import Path
from typing import Any
from typing import cast

from cloth_sim_ros.files.checked_npz import load_arrays
from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.runs.result import Result
import numpy as np

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
