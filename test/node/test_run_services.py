# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pause, step and reset."""

from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
import pytest
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger


def test_step_makes_the_steps_before_it_answers(cloth):
    """A caller of ~/step would read a state that is not there yet."""
    response = cloth.call(Step, 'step', steps=12)
    assert response.success
    assert response.sim_time == pytest.approx(12 * cloth.dt)
    # A paused node also shows once a second what is there already.
    cloth.wait_for('stats', lambda stats: stats.steps == 12)


def test_step_is_refused_while_running(cloth):
    """A step in a running simulation would mean nothing."""
    cloth.call(SetBool, 'pause', data=False)
    response = cloth.call(Step, 'step', steps=1)
    assert not response.success
    assert 'pause it first, with ~/pause with data: true or' in response.message


@pytest.mark.parametrize('steps', [0, 100001, 2**32 - 1])
def test_step_needs_a_sensible_number(cloth, steps):
    """A mistyped number would do nothing, or keep the node busy for days."""
    response = cloth.call(Step, 'step', steps=steps)
    assert not response.success
    assert f'steps {steps} is outside' in response.message
    assert '1 to 100000' in response.message
    assert cloth.call(Step, 'step', steps=1).sim_time == pytest.approx(cloth.dt)


def test_pause_holds_time_and_resume_lets_it_go(cloth):
    """A paused cloth would move on, or a resumed one would not."""
    assert cloth.call(SetBool, 'pause', data=False).message.startswith('running')
    assert cloth.wait_for('state').run_state == 'running'
    cloth.wait_for('stats', lambda message: message.steps >= 8)
    assert cloth.call(SetBool, 'pause', data=True).message.startswith('paused')
    held = cloth.call(Step, 'step', steps=1).sim_time
    assert cloth.call(Step, 'step', steps=1).sim_time == pytest.approx(held + cloth.dt)
    assert cloth['state'][-1].run_state == 'paused'
    cloth.clear()
    cloth.wait_for('stats', lambda stats: stats.real_time_factor == 0.0)


def test_pausing_twice_is_no_mistake(cloth):
    """A script that pauses to be sure would fail."""
    assert cloth.call(SetBool, 'pause', data=True).success
    assert cloth.call(SetBool, 'pause', data=True).success


def test_reset_goes_back_to_the_start(cloth, simulation):
    """Time, pose or pins would be left over from before the reset."""
    cloth.call(SetPin, 'set_pin', row=4, col=4)
    cloth.call(SetPin, 'set_pin', row=0, col=0, release=True)
    cloth.call(Step, 'step', steps=30)
    cloth.frame(30)
    cloth.clear()
    assert cloth.call(Trigger, 'reset').success
    assert cloth.frame(0).tobytes() == simulation.snapshot().records.tobytes()
    assert cloth.wait_for('inputs/command').command == 'reset'
    cloth.call(Step, 'step', steps=10)
    simulation.step(10)
    assert cloth.frame(10).tobytes() == simulation.snapshot().records.tobytes()
