# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Which cases of the tests are long by what a whole run took, beside those marked in the code.

The slowest cases are, until the others take no longer than a budget; but of each test the fastest
case stays ordinary, so that each run asks every test. To list them anew:

    scripts/test.sh --long -m 'not long' --durations=0 -vv -n 4 --dist=loadfile > durations.txt
    python test/support/long_cases.py durations.txt --budget 2000 > test/long_cases.txt
"""

import argparse
from collections import defaultdict
from collections.abc import Iterable
from collections.abc import Mapping
from pathlib import Path
import re

LISTED = Path(__file__).resolve().parents[1] / 'long_cases.txt'
# A line of pytest's --durations.
_DURATION = re.compile(r'^\s*([\d.]+)s (?:setup|call|teardown)\s+(test/\S+::.+?)\s*$')
# Shorter cases than this stay ordinary [s]; chosen: those of 0.3 to 0.5 s are 2.5 % of the time.
_SHORT = 0.5


def listed_cases() -> frozenset[str]:
    """Return the long cases, as pytest names them."""
    lines = LISTED.read_text(encoding='utf-8').splitlines()
    return frozenset(line for line in lines if line and not line.startswith('#'))


def seconds_of_cases(lines: Iterable[str]) -> dict[str, float]:
    """Return what each case took in all [s], from the lines of a report of durations."""
    seconds: dict[str, float] = defaultdict(float)
    for line in lines:
        found = _DURATION.match(line)
        if found:
            seconds[found[2]] += float(found[1])
    return seconds


def choose(seconds: Mapping[str, float], budget: float) -> list[str]:
    """
    Return the cases that are to be long, sorted.

    :param seconds: of each case [s]
    :param budget: for the others [s]
    """
    fastest: dict[str, str] = {}
    for case, time in seconds.items():
        test = case.partition('[')[0]
        if test not in fastest or time < seconds[fastest[test]]:
            fastest[test] = case
    left = sum(seconds.values())
    chosen = []
    for case in sorted(set(seconds) - set(fastest.values()), key=lambda case: -seconds[case]):
        if left <= budget or seconds[case] < _SHORT:
            break
        chosen.append(case)
        left -= seconds[case]
    return sorted(chosen)


def main() -> None:
    """Print the list."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('report', type=Path)
    parser.add_argument('--budget', type=float, default=2000.0, help='[s] in all processes')
    given = parser.parse_args()
    seconds = seconds_of_cases(given.report.read_text(encoding='utf-8').splitlines())
    header = Path(__file__).read_text(encoding='utf-8').splitlines()[:2]
    print('\n'.join([*header, *choose(seconds, given.budget)]))


if __name__ == '__main__':
    main()
