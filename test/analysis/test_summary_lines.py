# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A summary in words."""

from dataclasses import replace
import math

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.analysis.summary_lines import summary_lines
from cloth_sim_ros.analysis.summary_lines import text_table
import pytest


@pytest.fixture
def summary(known):
    """Return the summary of the known recording."""
    return summarise(Recording(known.folder))


def test_what_is_unknown_is_said_to_be(summary):
    """A user would read nan, or a zero that nobody measured."""
    lines = summary_lines(replace(
        summary, dt=math.nan, substeps=math.nan, last_energy=math.nan, device='', rows=0))
    assert lines['dt'] == 'unknown s in unknown substeps'
    assert 'unknown J at the end' in lines['total energy']
    assert lines['device'] == lines['cloth'] == 'not recorded'


def test_parts_that_a_run_has_are_told(summary):
    """Solver, constraints, switches and gaps would have to be looked for in the plots."""
    assert not {
        'solver', 'constraints', 'lengths', 'stalled pins', 'mode switches', 'gaps', 'problems',
    } & set(summary_lines(summary))
    lines = summary_lines(replace(
        summary, solver_iterations=12.0, solver_residual=1e-3, solver_missed=4, most_active=7.0,
        lengths_lost=3, stalled=2, switches=[(1.5, 'adaptive', 'constraint')],
        gaps=[(float(n), n + 0.5) for n in range(6)], problems=['a is truncated']))
    assert lines['solver'].startswith('at most 12 iterations, worst residual 0.001, 4 frames')
    assert lines['constraints'] == 'at most 7 active'
    assert lines['lengths'] == 'far off in 3 frames'
    assert lines['stalled pins'] == 'in 2 frames'
    assert lines['mode switches'] == 'constraint at 1.5 s'
    assert lines['gaps'].startswith('0 to 0.5 s, ') and lines['gaps'].endswith(' and 2 more')
    assert lines['problems'] == 'a is truncated'


def test_the_table_has_a_line_for_each_part(summary):
    """A long value would push the next one out of sight."""
    lines = summary_lines(summary)
    assert [row.split()[0] for row in text_table(lines).splitlines()] == [
        name.split()[0] for name in lines]
