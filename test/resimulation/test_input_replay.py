# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Stamps and steps."""

from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.resimulation.input_replay import StepClock
import pytest


@pytest.mark.parametrize('dt', [0.005, 1.0 / 60.0, 0.0123456789, 1e-7, 1.2345678e-7, 1.0])
@pytest.mark.parametrize('steps', [0, 1, 2, 3, 7, 999, 123456, 8640000])
def test_a_stamp_leads_back_to_its_step(dt, steps):
    """An input would be given one step too early or too late."""
    clock = StepClock(dt, dt)
    assert clock.steps(stamp(steps * dt)) == steps
    assert clock.recorded_time(stamp(steps * dt)) == steps * dt


@pytest.mark.parametrize(('new_dt', 'steps'), [
    (0.005, 14), (0.01, 7), (0.0025, 28), (0.02, 3), (0.1, 0), (0.0049, 14)])
def test_another_dt_never_comes_after_the_moment(new_dt, steps):
    """A push that begins where it was given would lie in the past."""
    assert StepClock(0.005, new_dt).steps(stamp(14 * 0.005)) == steps
