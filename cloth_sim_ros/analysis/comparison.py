# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Two recordings of one cloth, node by node, at the times both have a frame."""

from collections.abc import Iterable
from collections.abc import Iterator
from dataclasses import dataclass

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import not_watched
from cloth_sim_ros.analysis.run import Watch
from cloth_sim_ros.analysis.summary import figure
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

SAME_TIME = 1e-6  # [s]: stamps are whole nanoseconds, and steps are longer
_FIGURES = ('max_strain', 'total_energy')
_KEYS = ('points', 'stats')


@dataclass(frozen=True)
class Comparison:
    """
    How far the second recording is from the first.

    Frames are matched where both have one at the same simulated time; no other is looked at,
    and nothing is interpolated. All arrays are of these times, (n,); nan where a recording
    lacks what is compared.

    :param first: name of the recording that is compared with
    :param second: name of the one that is compared
    :param times: simulated, going on over resets [s]
    :param rms_distance: root of the mean squared distance of the nodes [m]
    :param max_distance: of the node that is farthest off [m]
    :param strain_difference: of the largest strain, second minus first
    :param energy_difference: of the total energy, second minus first [J]
    :param unmatched: frames of either that the other has none for
    """

    first: str
    second: str
    times: np.ndarray
    rms_distance: np.ndarray
    max_distance: np.ndarray
    strain_difference: np.ndarray
    energy_difference: np.ndarray
    unmatched: tuple[int, int]

    @property
    def identical(self) -> bool:
        """Return whether every node is at the same place in every matched frame, bit for bit."""
        return bool(np.all(self.max_distance == 0.0))


def compare(first: Recording, second: Recording, watch: Watch = not_watched) -> Comparison:
    """
    Compare ``second`` with ``first``; each is read once, side by side.

    :param watch: is given the entries of either and their number, and hands them on
    :raises ClothSimError: when their cloths have other numbers of nodes, or no time in common
    """
    sides = [_Side(first, watch), _Side(second, watch)]
    distances = {
        time: _distances(one, other, sides) for time, one, other in _matched_frames(*sides)}
    figures = [side.rest() for side in sides]
    times = np.array(sorted({*distances, *_matched_times(*figures)}))
    if not len(times):
        raise ClothSimError(
            f'{first.path} and {second.path} have no frames at common simulated times: record '
            'both with the same publish.rate')
    rms, largest = np.array([distances.get(time, (np.nan, np.nan)) for time in times]).T
    strain, energy = (
        (_at(times, figures[1]) - _at(times, figures[0])).T)
    return Comparison(
        sides[0].name, sides[1].name, times, rms, largest, strain, energy,
        (sides[0].count - len(times), sides[1].count - len(times)))


class _Side:
    """One of the two recordings: hands out its frames, and keeps its figures on the way."""

    def __init__(self, recording: Recording, watch: Watch) -> None:
        self.path = recording.path
        self.name = recording.name
        self._figures: dict[float, tuple[float, ...]] = {}
        self._times: set[float] = set()
        self._entries = iter(watch(recording.entries(*_KEYS), recording.count(*_KEYS)))
        self.frames = self._walk()

    def _walk(self) -> Iterator[Frame]:
        for entry in self._entries:
            self._times.add(entry.time)
            if entry.key == 'points':
                yield Frame.from_points(entry.time, entry.message)
            else:
                self._figures[entry.time] = tuple(
                    getattr(entry.message, name, np.nan) for name in _FIGURES)

    def rest(self) -> dict[float, tuple[float, ...]]:
        """Read to the end and return largest strain and total energy by time."""
        for _ in self.frames:
            pass
        return self._figures

    @property
    def count(self) -> int:
        """Get the number of moments."""
        return len(self._times)


def _matched_frames(first: _Side, second: _Side) -> Iterator[tuple[float, Frame, Frame]]:
    one, other = next(first.frames, None), next(second.frames, None)
    while one is not None and other is not None:
        if abs(one.time - other.time) <= SAME_TIME:
            yield one.time, one, other
            one, other = next(first.frames, None), next(second.frames, None)
        elif one.time < other.time:
            one = next(first.frames, None)
        else:
            other = next(second.frames, None)


def _matched_times(first: Iterable[float], second: Iterable[float]) -> list[float]:
    mine, others = np.array(sorted(first)), np.array(sorted(second))
    return mine[_nearest_distance(mine, others) <= SAME_TIME].tolist()


def _nearest_distance(times: np.ndarray, others: np.ndarray) -> np.ndarray:
    if not len(others):
        return np.full(len(times), np.inf)
    return np.abs(others[_nearest(times, others)] - times)


def _nearest(times: np.ndarray, others: np.ndarray) -> np.ndarray:
    right = np.clip(np.searchsorted(others, times), 1, max(len(others) - 1, 1))
    right = np.minimum(right, len(others) - 1)
    left = np.maximum(right - 1, 0)
    return np.where(np.abs(others[left] - times) <= np.abs(others[right] - times), left, right)


def _at(times: np.ndarray, figures: dict[float, tuple[float, ...]]) -> np.ndarray:
    """Return the figures at ``times``, (n, 2); nan where there are none."""
    values = np.full((len(times), len(_FIGURES)), np.nan)
    if figures:
        known = np.array(sorted(figures))
        table = np.array([figures[time] for time in known.tolist()], dtype=float)
        nearest = _nearest(times, known)
        same = np.abs(known[nearest] - times) <= SAME_TIME
        values[same] = table[nearest[same]]
    return values


def _distances(one: Frame, other: Frame, sides: list[_Side]) -> tuple[float, float]:
    if one.records.shape != other.records.shape:
        sizes = [f'{side.path} has {frame.records.shape[0]} x {frame.records.shape[1]} nodes'
                 for side, frame in zip(sides, (one, other))]
        raise ClothSimError(
            f'{" and ".join(sizes)}, which cannot be compared node by node: '
            'give recordings with the same rows and cols')
    if not np.array_equal(one.cells, other.cells):
        raise ClothSimError(
            f'{sides[0].path} and {sides[1].path} are cloths of different shapes, which cannot be '
            'compared node by node: give recordings with the same shape')
    there = one.present
    squares = np.zeros(np.count_nonzero(there))
    for axis in 'xyz':
        squares += np.square(
            one.records[axis][there] - other.records[axis][there].astype(float))
    return float(np.sqrt(squares.mean())), float(np.sqrt(squares.max()))


def comparison_lines(comparison: Comparison) -> dict[str, str]:
    """Return the lines of a comparison by their names."""
    lines = {
        'compared': f'{comparison.second} with {comparison.first}, at their common times',
        'matched': f'{len(comparison.times)} frames from {comparison.times[0]:.6g} to '
                   f'{comparison.times[-1]:.6g} s; {comparison.unmatched[0]} and '
                   f'{comparison.unmatched[1]} are in only one of them',
    }
    if comparison.identical:
        lines['node distance'] = 'none: all positions are bitwise identical'
    else:
        lines['node distance'] = _line(comparison.rms_distance, ' m', 'RMS')
    lines['max strain'] = _line(comparison.strain_difference, '', 'difference')
    lines['total energy'] = _line(comparison.energy_difference, ' J', 'difference')
    return lines


def _line(series: np.ndarray, unit: str, what: str) -> str:
    told = series[np.isfinite(series)]
    if not len(told):
        return 'unknown: not in both recordings'
    most = told[np.argmax(np.abs(told))]
    return f'{what} {figure(told[-1])}{unit} at the end, peak {figure(most)}{unit}'
