# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Runs that stop, as recorded or with other settings."""

from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.model.scene_fields import MODES
from made_again import assert_same
from made_again import Director
from made_again import made_again
import pytest


class Stops(Listener):
    """Counts the stops."""

    def __init__(self) -> None:
        """Begin without one."""
        self.stops = 0

    def stop(self) -> None:
        """Count."""
        self.stops += 1


@pytest.mark.parametrize('mode', MODES)
def test_a_run_that_stops_is_made_again_up_to_there(tmp_path, mode):
    """A blow-up could not be looked into again, or come as a traceback."""
    values = {'rows': 8, 'cols': 9, 'mode': mode}
    with Director(tmp_path, values) as director:
        director.step(10)
        director.simulation.push((0.0, 0.0, 1e25), duration=0.01)
        with pytest.raises(NonFiniteStateError) as lost:
            director.step(1)
        director.stop()
    with made_again(director.path) as rerun:
        assert rerun.has_recorded_stop
        assert rerun.problem == str(lost.value)
        assert rerun.check.equal == rerun.check.frames == 2


def stop_and_go_on(director):
    """Lose the state to a push, and go on without it."""
    director.step(10)
    director.simulation.push((0.0, 0.0, 1e25), duration=0.01)
    with pytest.raises(NonFiniteStateError):
        director.step(1)
    director.stop()
    director.simulation.clear_pushes()
    director.step(10)


def test_a_run_that_stops_goes_on_as_it_did(tmp_path):
    """What was done after a stop would be lost."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        stop_and_go_on(director)
    assert_same(director.path, 3)


def test_what_began_anew_at_a_stop_is_named(tmp_path):
    """Bits would be promised that depend on the batches in which the node advanced."""
    with Director(tmp_path, {'rows': 8, 'cols': 9, 'mode': 'adaptive'}) as director:
        stop_and_go_on(director)
    with made_again(director.path) as rerun:
        assert rerun.unknown == ('at which step mode adaptive restarted when the run stopped',)
        assert (rerun.problem, rerun.check.frames) == ('', 3)


def test_a_new_blow_up_ends_the_run(tmp_path):
    """A run with other settings that blows up would end as a traceback, or be called whole."""
    with Director(tmp_path, {'rows': 8, 'cols': 9, 'node_mass': 1e6}) as director:
        director.step(10)
        director.simulation.push((0.0, 0.0, 1e20), duration=0.01)
        director.step(10)
    assert_same(director.path, 3)
    listener = Stops()
    with made_again(director.path, listener=listener, node_mass=1e-3) as rerun:
        assert 'non-finite in the step from t = 0.05 s' in rerun.problem
        assert not rerun.has_recorded_stop
        assert rerun.check.frames == 2
        assert listener.stops == 1
