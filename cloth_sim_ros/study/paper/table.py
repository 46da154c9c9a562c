# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the paper prints and what was measured, as a table for people."""

from collections.abc import Mapping
from collections.abc import Sequence
import statistics

from cloth_sim_ros.study.growth import Growth
from cloth_sim_ros.study.paper.printed import PrintedSpeed
from cloth_sim_ros.study.paper.printed import REAL_TIME
from cloth_sim_ros.study.paper.timing import Speed
from cloth_sim_ros.study.paper.timing import TimedCloth

HEAD = (
    '| nodes | edges | printed CPU, GPU [fps] | printed speed-up | program | fps here '
    "| over the paper's serial program (rounds) | over the serial one without a matrix "
    '| |\n'
    '|---|---|---|---|---|---|---|---|---|')
_NONE = '-'


def table_rows(cloth: TimedCloth) -> str:
    """Return a row for each contender on one cloth."""
    return '\n'.join(
        _row(cloth if number == 0 else None, speed) for number, speed in enumerate(cloth.speeds))


def heading(cloth: TimedCloth) -> str:
    """Return what comes above the rows of the method of ``cloth``."""
    threads = f' (LP_NUM_THREADS: {cloth.threads})' if cloth.threads else ''
    return f'\n{cloth.method}, on {cloth.device}{threads}\n\n{HEAD}'


def growth_line(growths: Mapping[str, Growth]) -> str:
    """Return how the time of a frame grows with the nodes."""
    return 'Time of a frame grows with the nodes to the power of: ' + '; '.join(
        f'{name} {growth}' for name, growth in growths.items())


def real_time_line(cloth: TimedCloth) -> str:
    """Return whether what the paper calls real time is reached here."""
    fastest = max(
        (speed for speed in cloth.speeds if speed.fps and not speed.is_serial),
        key=lambda speed: speed.fps or 0.0, default=None)
    printed = f'{cloth.method}, {cloth.nodes:,} nodes: printed {REAL_TIME:g} fps or more; '
    if fastest is None or fastest.fps is None:
        return printed + 'none here'
    return printed + f'{_number(fastest.fps)} fps here ({fastest.contender})'


def _row(cloth: TimedCloth | None, speed: Speed) -> str:
    first = ['', '', '', ''] if cloth is None else [
        f'{cloth.nodes:,}', f'{cloth.springs:,}', *_printed(cloth.printed)]
    if speed.fps is None:
        return f'| {" | ".join(first)} | {speed.contender} | not run | | | {speed.reason} |'
    return (
        f'| {" | ".join(first)} | {speed.contender} | {_with_range(speed.fps, speed.rounds)} '
        f'| {_ratio(speed.ratios)} | {_ratio(speed.plain_ratios)} | {speed.detail} |')


def _printed(printed: PrintedSpeed | None) -> list[str]:
    if printed is None:
        return [_NONE, _NONE]
    rates = [_NONE if fps is None else f'{fps:g}' for fps in (printed.cpu_fps, printed.gpu_fps)]
    return [', '.join(rates), _NONE if printed.speed_up is None else f'{printed.speed_up:g}']


def _ratio(ratios: Sequence[float]) -> str:
    return _with_range(statistics.median(ratios), ratios) if ratios else _NONE


def _with_range(middle: float, values: Sequence[float]) -> str:
    if len(values) < 2:
        return _number(middle)
    return f'{_number(middle)} ({_number(min(values))} to {_number(max(values))})'


def _number(value: float) -> str:
    return f'{value:,.0f}' if value >= 100.0 else f'{value:.3g}'
