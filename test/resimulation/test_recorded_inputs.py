# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What was accepted comes back from a recording as it was."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import get_args

from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import GraspChange
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.resimulation.recorded_inputs import recorded_input
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import ReplaceState
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from given_inputs import GIVEN
from given_inputs import handle
from given_inputs import HANDLED
import pytest
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message

# Recorders refuse it: a recording could not be run again after one.
_WITHOUT_MESSAGE = {ReplaceState}


class Accepted(InputListener):
    """Keeps what is accepted."""

    def __init__(self) -> None:
        self.inputs: list[Input] = []

    def accept(self, given, time):
        self.inputs.append(given)


@pytest.fixture
def cloth() -> Iterator[Simulation]:
    """Give a cloth which each input can act on."""
    with Simulation(Scene(HANDLED)) as simulation:
        handle(simulation)
        simulation.listener = Accepted()
        yield simulation


def and_back(given: Input) -> Input:
    """Return the message of ``given`` after it was serialised and decoded."""
    key, message = input_message(given, 0.5, 'world')
    return recorded_input(key, deserialize_message(serialize_message(message), type(message)))


@pytest.mark.parametrize(
    'kind', sorted(get_args(Input), key=str), ids=lambda kind: kind.__name__)
def test_what_was_accepted_comes_back_equal(cloth, kind):
    """A run that is made again would do something else, or leave an input out."""
    for given in GIVEN[kind](cloth):
        cloth.apply(given)
    assert cloth.listener.inputs
    for accepted in cloth.listener.inputs:
        if kind in _WITHOUT_MESSAGE:
            with pytest.raises(TypeError, match='has no message'):
                input_message(accepted, 0.5, 'world')
        else:
            assert and_back(accepted) == accepted


def test_a_loss_by_force_comes_back_equal():
    """A rerun would release by hand what the cloth has torn away."""
    assert and_back(Release('hand', by_force=True)) == Release('hand', by_force=True)


def test_a_mode_of_an_old_recording_is_read():
    """Recordings of versions without the previous mode could not be run again."""
    assert recorded_input('inputs/mode', SimpleNamespace(mode='adaptive')) == SetMode('adaptive')


def test_a_command_that_is_not_known_is_refused():
    """One of a later version would be taken for another."""
    with pytest.raises(ClothSimError, match="no command 'fold': it is ignored"):
        recorded_input('inputs/command', Command(command='fold'))


@pytest.mark.parametrize(('rows', 'cols'), [([], []), ([1, 2], [1]), ([1], [])])
def test_a_grasp_without_its_nodes_is_refused(rows, cols):
    """A grasp would take what is nearest to it in another run."""
    message = GraspChange(name='hand', grasped=True, rows=rows, cols=cols)
    with pytest.raises(ClothSimError, match='as many numbers of each, record it again'):
        recorded_input('inputs/grasp', message)
