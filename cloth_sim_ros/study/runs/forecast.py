# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long the rest of a study takes, judged by the runs that have ended."""

from collections.abc import Iterable

from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS
from cloth_sim_ros.study.runs.result import Result
from cloth_sim_ros.study.runs.run import Run

_DEFAULTS = {field.name: field.default for field in SCENE_FIELDS}
_Kind = tuple[str, str]


class Forecast:
    """
    Expects each run to take as long for its work as the ended runs of its kind did.

    A kind is the function with the mode; its work grows with the nodes and the steps. What runs at
    the same time is taken from the wall time of the study itself.

    :param runs: those to be made
    """

    def __init__(self, runs: Iterable[Run]) -> None:
        """Begin with all runs to be made."""
        self._left = {run.key: (_kind(run), _work(run)) for run in runs}
        # Of each kind: seconds and work of the runs that have ended.
        self._ended: dict[_Kind, list[tuple[float, float]]] = {}

    def end(self, result: Result) -> None:
        """Take account of a run that has ended."""
        kind, work = self._left.pop(result.key)
        self._ended.setdefault(kind, []).append((result.wall_seconds, work))

    def seconds_left(self, elapsed: float) -> float | None:
        """
        Return the wall time until the last run ends; None while nothing is known [s].

        :param elapsed: wall time since the first run began [s]
        """
        ended = [entry for entries in self._ended.values() for entry in entries]
        spent = sum(seconds for seconds, _ in ended)
        if spent <= 0.0:
            return None
        expected = sum(
            work * _rate(self._ended.get(kind) or ended) for kind, work in self._left.values())
        return expected * elapsed / spent


def in_minutes(seconds: float) -> str:
    """Return a forecast in words, to the nearest 10 s or minute: it is no more exact."""
    if seconds < 95.0:
        return f'about {max(10 * round(seconds / 10.0), 10)} s'
    if seconds < 5400.0:
        return f'about {round(seconds / 60.0)} min'
    return f'about {seconds / 3600.0:.1f} h'


def _rate(entries: list[tuple[float, float]]) -> float:
    return sum(seconds for seconds, _ in entries) / sum(work for _, work in entries)


def _kind(run: Run) -> _Kind:
    return run.function, str(run.scene.get('mode', _DEFAULTS['mode']))


def _work(run: Run) -> float:
    """Return roughly what the time of the run is in proportion to; 1 where it is not known."""
    rows, cols, dt, refine = (
        run.scene.get(name, _DEFAULTS[name]) for name in ('rows', 'cols', 'dt', 'refine'))
    repeats = len(run.settings.get('settings', [None])) * run.settings.get('rounds', 1)
    try:
        return max(rows * cols * refine * repeats / dt, 1.0)
    except (TypeError, ZeroDivisionError):
        return 1.0  # a scene that will be refused
