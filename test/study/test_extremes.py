# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Implausible results of extreme scenes are found."""

from dataclasses import replace

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.study.extreme_scenes import Extreme
from cloth_sim_ros.study.extremes import extreme_runs
from cloth_sim_ros.study.extremes import extreme_table
from cloth_sim_ros.study.extremes import is_right
from cloth_sim_ros.study.extremes import message_nonsense
from cloth_sim_ros.study.extremes import nonsense_of
from cloth_sim_ros.study.extremes import run_extreme
from cloth_sim_ros.study.make_runs import perform
import numpy as np
import pytest
from springs import SPRINGS

PLAIN = Extreme({}, 'test')


@pytest.fixture
def context():
    """Return a context."""
    context = Context(single_thread=True)
    yield context
    context.close()


@pytest.fixture
def run(context):
    """Return a simulation that has fallen for a while, and its account."""
    run = Simulation(Scene({**SPRINGS, 'rows': 6, 'cols': 6, 'pins': ['none']}), context=context)
    account = EnergyAccount(run)
    account.step(20)
    yield run, account
    run.close()


def test_a_good_run_is_none(run):
    """Everything would be nonsense."""
    simulation, account = run
    assert nonsense_of(simulation, account.seen, PLAIN, account) == ()


@pytest.mark.parametrize(('changed', 'word'), [
    ({'finite': False}, 'finite'), ({'kinetic_energy': np.inf}, 'kinetic energy'),
    ({'max_strain': np.nan}, 'max strain'), ({'time': 3.0}, 'time')])
def test_numbers_that_cannot_be(run, changed, word):
    """A number that is none would be passed over."""
    simulation, account = run
    wrong = nonsense_of(simulation, replace(account.seen, **changed), PLAIN, account)
    assert len(wrong) == 1 and word in wrong[0]


def test_a_fall_that_is_too_slow(run):
    """A cloth that is held by nothing could hang in the air."""
    simulation, account = run
    wrong = nonsense_of(simulation, account.begin, PLAIN, account)
    assert any('time' in each for each in wrong)
    simulation.set_state(account.begin.positions, account.begin.velocities)
    wrong = nonsense_of(simulation, simulation.snapshot(), PLAIN, account)
    assert any(each.startswith('falls') for each in wrong)


@pytest.mark.parametrize('message', [
    'dt is too long', 'dt 3 s is too long', 'dt 3 s is too long: bad luck', 'set dt: 3\n: set it'])
def test_messages_that_help_nobody(message):
    """An error without value or way out would be passed over."""
    assert message_nonsense(message)


def test_a_message_that_helps():
    """Every error would be nonsense."""
    assert not message_nonsense(
        'dt 1 s is above the limit 0.1 s: set dt <= 0.08, or auto_substeps: true')


def test_edges_that_are_off(context):
    """Hard edges could be any length."""
    wild = Extreme({'pin_moves.start': [0.0], 'pin_moves.node': ['top_left'],
                    'pin_moves.target': [-10.0, 0.5, 1.0], 'pin_moves.speed': [10.0]}, 'test',
                   steps=10)
    found = run_extreme(wild, 'adaptive', context)
    assert any('with the limit' in each for each in found.nonsense)


def test_the_table_tells_what_came_out():
    """A row would have another outcome than its run, or not be counted."""
    runs = [run for run in extreme_runs(with_long=False)
            if run.settings['name'] in ('2 x 2', '8000 x 8000', 'push 1e30 N')
            and run.scene['mode'] == 'mass_spring']
    results = [perform(run, False) for run in runs]
    assert all(map(is_right, results))
    text = extreme_table(results)
    for outcome in ('runs', 'refused', 'stops'):
        assert f'| mass_spring | {outcome} | as it should |' in text
    assert '1 runs, 1 refused, 1 stops; 0 nonsense' in text
