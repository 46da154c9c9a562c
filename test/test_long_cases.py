# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The list of cases that run only with --long."""

from pathlib import Path

from long_cases import choose
from long_cases import listed_cases
from long_cases import seconds_of_cases

ROOT = Path(__file__).resolve().parents[1]
REPORT = """
12.50s call     test/sim/test_a.py::test_falls[mass_spring]
0.50s setup    test/sim/test_a.py::test_falls[mass_spring]
30.00s call     test/sim/test_a.py::test_falls[constraint]
20.00s call     test/sim/test_a.py::test_falls[adaptive]
40.00s call     test/sim/test_b.py::test_alone
0.40s call     test/sim/test_b.py::test_short[1]
0.30s call     test/sim/test_b.py::test_short[2]
"""


def test_each_listed_case_is_of_a_test():
    """A test that was renamed would run all its cases, and nobody notice."""
    tests = {case.partition('[')[0] for case in listed_cases()}
    gone = [
        test for test in tests
        if f'def {test.rpartition("::")[2]}(' not in
        (ROOT / test.partition('::')[0]).read_text(encoding='utf-8')]
    assert tests and not gone


def test_only_cases_of_a_test_with_others_are_listed():
    """The fastest case of each test is ordinary: no test is left out of a run."""
    assert all('[' in case for case in listed_cases())


def test_slowest_cases_are_chosen_down_to_the_budget():
    """Setups count; the fastest case of a test stays, and so do short ones."""
    seconds = seconds_of_cases(REPORT.splitlines())
    assert seconds['test/sim/test_a.py::test_falls[mass_spring]'] == 13.0
    slow = [f'test/sim/test_a.py::test_falls[{mode}]' for mode in ('adaptive', 'constraint')]
    assert choose(seconds, 80.0) == [slow[1]]
    assert choose(seconds, 0.0) == slow
    assert choose(seconds, 1000.0) == []
