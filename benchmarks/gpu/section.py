# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A section of the suite, run in a process of its own within a time limit."""

from collections.abc import Callable
from collections.abc import Iterator
from dataclasses import asdict
from dataclasses import dataclass
from dataclasses import field
import json
import os
from pathlib import Path
import subprocess
import sys
import tempfile
import time
import traceback
from typing import Any

_SUITE = Path(__file__).resolve().parents[1] / 'gpu_suite.py'
# A figure or a verdict: the columns of a table and their values.
Row = dict[str, Any]
# Time that the short form has over that of the whole one [1]: it runs on any device, and without a
# shader cache Mesa compiles four sections longer than a GPU runs them.
SLOWER = 4.0
# Key of a row that found the device to be wrong.
FAULT = 'fault'


@dataclass(frozen=True)
class Section:
    """
    What one part of the suite finds out.

    :param name: word on the command line
    :param title: heading on the page
    :param seconds: time limit [s]; a section that exceeds it is ended, and keeps its rows
    :param measure: yields the rows; True for the short form
    """

    name: str
    title: str
    seconds: float
    measure: Callable[[bool], Iterator[Row]]


@dataclass
class Outcome:
    """
    What a section has found.

    :param status: ok, faults, failed or time limit
    :param seconds: wall time [s]
    :param error: last lines of a process that failed
    """

    name: str
    title: str
    status: str = 'ok'
    seconds: float = 0.0
    rows: list[Row] = field(default_factory=list)
    error: str = ''

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return asdict(self)


def in_words(row: Row) -> str:
    """Return a row as one line."""
    return ', '.join(f'{name} {_figure(value)}' for name, value in row.items())


def _figure(value: Any) -> str:
    return f'{value:.4g}' if isinstance(value, float) else str(value)


def run_here(section: Section, path: Path, quick: bool) -> int:
    """Measure in this process; append the rows to ``path``, one JSON document a line."""
    with path.open('a', encoding='utf-8') as file:
        try:
            for row in section.measure(quick):
                file.write(json.dumps(row) + '\n')
                file.flush()
                print(f'  {in_words(row)}', flush=True)
        except Exception:
            traceback.print_exc(limit=-6)
            return 1
    return 0


def run_section(section: Section, quick: bool, seconds: float) -> Outcome:
    """
    Run ``section`` in a process of its own.

    :param seconds: time left to the suite [s]
    :raises KeyboardInterrupt: with an ``outcome`` that has the rows found until then
    """
    limit = min(section.seconds * (SLOWER if quick else 1.0), seconds)
    outcome = Outcome(section.name, section.title)
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, 'rows.jsonl')
        path.touch()
        errors = Path(folder, 'errors')
        with errors.open('wb') as stream:
            process = subprocess.Popen(
                [sys.executable, str(_SUITE), '--in-process', section.name,
                 '--rows', str(path), *(['--quick'] if quick else [])],
                stderr=stream, env=_environment(),
                # Ctrl-C reaches the suite alone, which ends the section.
                start_new_session=True)
            try:
                if process.wait(limit):
                    outcome.status = 'failed'
            except subprocess.TimeoutExpired:
                outcome.status = 'time limit'
            except KeyboardInterrupt as interrupt:
                outcome.status = 'interrupted'
                interrupt.outcome = outcome  # type: ignore[attr-defined]
                raise
            finally:
                process.kill()
                process.wait()
                outcome.seconds = time.monotonic() - begin
                outcome.rows += [
                    json.loads(line) for line in path.read_text(encoding='utf-8').splitlines()]
                if outcome.status == 'failed':
                    outcome.error = errors.read_text(encoding='utf-8', errors='replace')[-3000:]
                elif outcome.status == 'ok' and any(row.get(FAULT) for row in outcome.rows):
                    outcome.status = 'faults'
    return outcome


def _environment() -> dict[str, str]:
    """Return the environment of a section: this checkout, and no tuning of an earlier run."""
    root = str(Path(__file__).resolve().parents[2])
    paths = [root, *filter(None, [os.environ.get('PYTHONPATH')])]
    return {**os.environ, 'PYTHONPATH': os.pathsep.join(paths), 'CLOTH_SIM_TUNING': 'off'}
