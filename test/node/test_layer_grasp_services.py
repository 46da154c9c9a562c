# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps by service on a towel that lies folded: one layer or both, recorded and made again."""

from collections.abc import Iterator
from pathlib import Path

from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.layers import CELL
from cloth_sim_ros.verb.main import main
from cloth_under_test import ClothUnderTest
from folded_towel import FOLD
from folded_towel import FOLDED_AT
from folded_towel import FOLDING
from folded_towel import HEM
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from std_srvs.srv import Trigger

NODE = '/layers/cloth_sim'
AT_HEM = Pose(position=Point(**dict(zip('xyz', HEM))))
FOLDED_STEPS = round(FOLDED_AT / FOLDING['dt'])
WAY = (0.0, -0.05, 0.08)


@pytest.fixture(scope='module')
def towel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ClothUnderTest]:
    """Start a node whose grippers fold a towel, and listen to it."""
    values = {**FOLDING, 'start_paused': True}
    with GraphClient() as client:
        with NodeProcess(tmp_path_factory.mktemp('layers'), values, '-r', '__ns:=/layers'):
            yield ClothUnderTest(client, values, NODE)


@pytest.mark.parametrize(('layers', 'both'), [('top', False), ('all', True), ('', True)])
def test_layers_asked_for_are_held_and_made_again(towel, capsys, layers, both):
    """A client would hold other layers than it asks for, or a recording forget which."""
    towel.restore()
    path = Path(towel.call(StartRecording, 'start_recording').path)
    assert towel.call(Step, 'step', steps=FOLDED_STEPS).success
    towel.frame(FOLDED_STEPS)
    towel.clear()
    answer = towel.call(
        Grasp, 'grasp', name='hand', pose=AT_HEM, radius=1.5 * CELL, layers=layers)
    assert answer.success, answer.message
    rows = list(towel.wait_for('inputs/grasp').rows)
    assert len(rows) == answer.nodes and min(rows) == 0
    assert (max(rows) > FOLD) == both
    lifted = Pose(position=Point(**dict(zip('xyz', WAY))))
    assert towel.call(
        MoveFrame, 'move_grasp', name='hand', pose=lifted, keep_orientation=True,
        speed=0.3).success
    assert towel.call(Step, 'step', steps=200).success
    frame = towel.frame(FOLDED_STEPS + 200)
    assert towel.call(Trigger, 'stop_recording').success
    assert (frame['z'][-1, FOLD] > 0.06) == both and frame['z'][0, FOLD] > 0.06
    with Simulation(Scene(FOLDING)) as twin:
        twin.step(FOLDED_STEPS)
        twin.grasp('hand', HEM, radius=1.5 * CELL, layers=layers or 'all')
        twin.move_grasp('hand', WAY, speed=0.3)
        twin.step(200)
        assert frame.tobytes() == twin.snapshot().records.tobytes()
    assert main(['resimulate', str(path), '--node', NODE]) == 0
    assert 'frames bitwise identical' in capsys.readouterr().out


def test_other_words_are_refused(towel):
    """A mistyped word would be taken for one of them."""
    towel.restore()
    answer = towel.call(
        Grasp, 'grasp', name='hand', pose=AT_HEM, radius=1.5 * CELL, layers='upper')
    assert (answer.success, answer.code) == (False, ResultCode.INVALID_VALUE)
    assert answer.message == (
        "the layers of grasp hand must be one of all, top, got 'upper': give top for the highest "
        'layer alone')
    assert towel.call(Release, 'release', name='hand').code == ResultCode.NOT_FOUND
