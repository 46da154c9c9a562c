# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The table of the extremes."""

from collections import Counter
from collections.abc import Sequence

from cloth_sim_ros.study.extremity.extreme import OUTCOMES
from cloth_sim_ros.study.extremity.nonsense import MOST_GAIN
from cloth_sim_ros.study.extremity.scenes import EXTREMES
from cloth_sim_ros.study.results import Result

_RIGHT = 'as it should'
_REPORTED = 'reported'
_NONSENSE = 'NONSENSE'
_OTHERWISE = 'OTHERWISE'


def verdict(result: Result) -> str:
    """
    Return whether a row is right, nonsense, or came out otherwise.

    'reported' is what has gone wrong and says so, in its snapshot and in ~/diagnostics.
    """
    extreme = EXTREMES[result.settings['name']]
    if not result.is_done:
        return _OTHERWISE
    if result.values['nonsense']:
        return _NONSENSE
    if result.values['outcome'] not in extreme.expected:
        return _OTHERWISE
    return _REPORTED if result.values['gained'] > MOST_GAIN else _RIGHT


def is_right(result: Result) -> bool:
    """Return whether a row is as it should be, or says itself what is wrong."""
    return verdict(result) in (_RIGHT, _REPORTED)


def extreme_table(results: Sequence[Result]) -> str:
    """Return a row for each scene and mode in Markdown, and how many there are of each kind."""
    lines = [
        '| group | scene | mode | outcome | verdict | detail |', '|---|---|---|---|---|---|']
    for result in results:
        extreme = EXTREMES[result.settings['name']]
        if result.is_done:
            outcome, detail = result.values['outcome'], result.values['detail']
        else:
            outcome, detail = result.outcome, result.reason
        wrong = '; '.join(result.values.get('nonsense', ()))
        lines.append(
            f'| {extreme.group} | {result.settings["name"]} | {result.scene["mode"]} | {outcome} '
            f'| {verdict(result)} | {wrong + "; " if wrong else ""}{detail} |')
    counts = Counter(
        result.values['outcome'] if result.is_done else result.outcome for result in results)
    verdicts = Counter(map(verdict, results))
    lines += ['', f'{len(results)} rows: '
              + ', '.join(f'{counts[outcome]} {outcome}' for outcome in OUTCOMES)
              + f'; {verdicts[_NONSENSE]} nonsense, {verdicts[_OTHERWISE]} otherwise than they '
              f'should, {verdicts[_REPORTED]} gone wrong and reported.']
    return '\n'.join(lines) + '\n'
