# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is advised to a run that is too slow."""

from cloth_sim_ros.messages.pace import slow_pace
import pytest


@pytest.mark.parametrize(('substeps', 'automatic', 'faster', 'useless'), [
    (16, True, 'softer springs', 'dt'), (1, True, 'a longer dt', 'springs'),
    (16, False, 'a longer dt', 'springs')])
def test_a_longer_dt_is_advised_where_it_helps(substeps, automatic, faster, useless):
    """A user would take a longer dt, which then has more substeps of the same length."""
    advice = slow_pace(0.5, 1.0, substeps=substeps, automatic=automatic)
    assert advice.startswith('0.5 x real time, below the target 1: use fewer nodes, ')
    assert faster in advice and useless not in advice
