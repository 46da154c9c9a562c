# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the bench prints as JSON, as the tables of the page on speed."""

from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Sequence
import statistics
from typing import Any

from cloth_sim_ros.study.camera_speed import NO_PICTURE

# A line of JSON of the bench.
Found = dict[str, Any]

# From here on a number is rounded to whole ones [1]: three digits before.
_WHOLE = 999.5
_MILLION = 1e6
_MILLISECONDS = 1e3
# How the page names what is switched on of a node.
_PARTS = {
    'node': 'nothing: a node without subscribers', 'points': 'points', 'markers': 'markers',
    'wrenches': 'wrenches and frames of pins', 'stats': 'statistics and diagnostics',
    'recording': 'a recording'}


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines = [header, ['---'] * len(header), *rows]
    return ''.join(f'| {" | ".join(line)} |\n' for line in lines)


def figure(rounds: Sequence[float], scale: float = 1.0) -> str:
    """Return the median of the rounds, with the smallest and the largest one in brackets."""
    median, *ends = (
        _number(scale * value)
        for value in (statistics.median(rounds), min(rounds), max(rounds)))
    return median if len(rounds) == 1 else f'{median} ({" to ".join(ends)})'


def springs(found: Sequence[Found]) -> str:
    """Return the table of layouts by grid: the default one, and that of the paper."""
    def rows() -> Iterator[list[str]]:
        for each in found:
            fused, paper = each['speeds']
            yield [
                _grid(each['rows']), figure(fused['rounds'], 1.0 / _MILLION),
                figure(paper['rounds'], 1.0 / _MILLION), figure(fused['ratio_rounds'])]
    return table(
        ['nodes', '`layout: fused` [million node steps/s]',
         '`layout: paper` [million node steps/s]', 'fused over paper'], rows())


def modes(found: Sequence[Found]) -> str:
    """Return the table of whole modes by grid: speed and stretch."""
    def rows() -> Iterator[list[str]]:
        for speed in found[0]['speeds']:
            name = _settings(speed['values'])
            if speed['failure'] is not None:
                yield [_grid(speed['grid']), name, speed['failure'], '', '']
                continue
            yield [
                _grid(speed['grid']), name, figure(speed['real_time_factors']),
                figure(speed['ratios']) if speed['ratios'] else '',
                f'{100.0 * speed["stretch"]["peak"]:.2f} %']
    return table(
        ['nodes', 'mode', 'real-time factor', 'over the first', 'largest stretch'], rows())


def bodies(found: Sequence[Found]) -> str:
    """Return the table of contact with bodies by mode."""
    return table(
        ['nodes', 'mode', 'scene', 'wall time of a simulated second [s]',
         'over no body, falling', 'over no body, hung', 'substeps of a dt', 'solves of a substep'],
        ([_grid(each['nodes']), f'`{each["mode"]}`', name, figure(seconds),
          figure(each['ratios'][name]), figure(each['ratios_to_hung'][name]),
          figure(each['substeps'][name]),
          figure(each['solves'][name]) if any(each['solves'][name]) else 'none']
         for each in found for name, seconds in each['seconds'].items()))


def layers(found: Sequence[Found]) -> str:
    """Return the table of self-contact by grid, pose and mode."""
    return table(
        ['nodes', 'towel', 'mode', 'without self-contact [s]', 'with it [s]',
         'with it over without', 'contacts'],
        ([_grid(each['nodes']), each['pose'],
          f'`{each["mode"]}`, dt {_MILLISECONDS * each["dt"]:g} ms', figure(each['without']),
          figure(each['touching']), figure(each['ratios']), str(each['contacts'])]
         for each in found))


def cloths(found: Sequence[Found]) -> str:
    """Return the table of many cloths, together and one by one."""
    def rows() -> Iterator[list[str]]:
        for each in found:
            steps = each['cloths'] * each['size']**2 * each['frames'] * each['steps'] / _MILLION
            yield [
                f'{each["cloths"]} of {_grid(each["size"])}',
                'a pin moved, positions read' if each['is_controlled'] else 'steps alone',
                figure([steps / time for time in each['together']]),
                figure([steps / time for time in each['one_by_one']]), figure(each['ratios'])]
    return table(
        ['cloths', 'every ten steps', 'together [million node steps/s]',
         'one by one [million node steps/s]', 'together over one by one'], rows())


def environments(found: Sequence[Found]) -> str:
    """Return the table of environments, together and one by one."""
    return table(
        ['environments', '`make_vec` [steps/s]', 'one by one [steps/s]', 'ratio'],
        ([f'{each["count"]} of {_grid(each["nodes"])}', figure(each['together']),
          figure(each['one_by_one']), figure(each['ratios'])] for each in found))


def camera(found: Sequence[Found]) -> str:
    """Return the table of pictures by what is taken."""
    return table(
        ['what is taken', 'a picture [ms of a processor]', 'steps and picture over steps alone'],
        ([each['taken'], figure(each['picture'], _MILLISECONDS), figure(each['ratios'])]
         for each in found if each['taken'] != NO_PICTURE))


def node(found: Sequence[Found]) -> str:
    """Return the table of a node, topic by topic, with a column for each grid."""
    def rows() -> Iterator[list[str]]:
        for number, name in enumerate(_PARTS.values()):
            yield [name, *(figure(each['parts'][number]['over_bare']) for each in found)]
        yield ['simulation alone [s of a processor for a simulated second]',
               *(figure(each['bare']) for each in found)]
        yield ['real-time factor with everything',
               *(figure(each['parts'][-1]['pace']) for each in found)]
        yield ['clouds lost, of those sent', *(
            f'{_sum(each, "lost")} of {_sum(each, "sent")}' for each in found)]
    return table(['switched on, in addition', *(_grid(each['rows']) for each in found)], rows())


def start_up(found: Sequence[Found]) -> str:
    """Return the table of the time to the first cloud."""
    return table(
        ['scene', 'first cloud after [s]'],
        ([f'`{each["scene"]}`', figure(each['seconds_to_first_cloud'])] for each in found))


def _sum(each: Found, key: str) -> int:
    return sum(part[key] for part in each['parts'])


def _grid(side: int) -> str:
    return f'{side} x {side}'


def _number(value: float) -> str:
    return f'{value:.3g}' if abs(value) < _WHOLE else f'{value:,.0f}'


def _settings(values: Found) -> str:
    parts = [f'`{values["mode"]}`']
    if 'adaptive.threshold' in values:
        parts.append(f'limit {100.0 * values["adaptive.threshold"]:g} %')
    if 'stiffness.structural' in values:
        parts.append(f'{values["stiffness.structural"]:,.0f} N/m')
    return ', '.join(parts)
