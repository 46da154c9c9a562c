# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim collider and cloth_sim wind."""

from collections.abc import Iterator

from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.verb.main import main
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from node_process import NodeProcess
import pytest
from transform_teller import Teller
from transform_teller import transform

NAMESPACE = '/outdoors'
NODE = f'{NAMESPACE}/cloth_sim'
SCENE = {
    **PAUSED, 'air.density': 1.225, 'colliders.names': ['table'],
    'colliders.table.shape': 'box', 'colliders.table.size': [0.2, 0.2, 0.2]}


@pytest.fixture(scope='module')
def outdoor_node(tmp_path_factory) -> Iterator[NodeProcess]:
    """Start a node with air and a collider."""
    folder = tmp_path_factory.mktemp('outdoors')
    with NodeProcess(folder, SCENE, '-r', f'__ns:={NAMESPACE}') as node:
        yield node


@pytest.fixture
def outdoors(outdoor_node, client) -> ClothUnderTest:
    """Listen to the node."""
    return ClothUnderTest(client, SCENE, NODE)


def run(capsys, *arguments):
    """Return exit code, stdout and stderr of a verb."""
    capsys.readouterr()
    code = main([*arguments, '--node', NODE, '--timeout', '120'])
    return code, *capsys.readouterr()


def test_moves_and_turns_a_collider(outdoors, capsys):
    """A table could not be moved from the command line without ros2."""
    code, out, _ = run(capsys, 'collider', 'table', '--to', '0', '0', '0.5', '--speed', '0.25')
    assert (code, out) == (
        0, 'collider table moves to (0, 0, 0.5) and arrives at 2 s\n')
    first = outdoors.wait_for('inputs/collider_target')
    assert first.keep_orientation and first.pose.position.z == 0.5
    code, _, _ = run(
        capsys, 'collider', 'table', '--to', '0', '0', '0.5', '--orientation', '0', '0', '1', '1',
        '--angular-speed', '0.5')
    assert code == 0
    outdoors.client.spin_until(
        lambda: len(outdoors['inputs/collider_target']) == 2, 'the turn is taken')
    second = outdoors['inputs/collider_target'][1]
    assert not second.keep_orientation and second.angular_speed == 0.5


@pytest.fixture
def tool(outdoors) -> Iterator[str]:
    """Tell the node where a tool stands, and return its frame."""
    teller = Teller(outdoors)
    teller.tell(transform('outdoor_tool', 'world', Pose((0.45, -0.35, 1.1))), is_fixed=True)
    yield 'outdoor_tool'
    teller.close()


def test_a_collider_is_attached_to_a_frame(outdoors, tool, capsys):
    """A finger of a robot could not carry a body without ros2."""
    code, out, _ = run(capsys, 'collider', 'table', '--follow', tool, '--speed', '0.5')
    assert (code, out) == (0, f'collider table follows {tool}\n')
    # It takes no other targets meanwhile.
    assert run(capsys, 'collider', 'table', '--to', '0', '0', '1')[0] == 1
    code, out, _ = run(capsys, 'collider', 'table', '--unfollow')
    assert (code, out) == (0, f'collider table no longer follows {tool}\n')
    assert run(capsys, 'collider', 'table', '--to', '0', '0', '1')[0] == 0


def test_a_gripper_takes_the_cloth_where_it_is(outdoors, tool, capsys):
    """A gripper of a robot could not grasp in its own frame without ros2."""
    code, out, _ = run(
        capsys, 'grasp', 'hand', '--at', '0', '0', '-0.1', '--frame', tool, '--radius', '0.12',
        '--follow', tool)
    assert (code, out) == (0, f'grasp hand holds 3 nodes and follows {tool}\n')
    assert outdoors.wait_for('inputs/grasp').pose.position.z == pytest.approx(1.0)
    assert run(capsys, 'grasp', 'hand', '--unfollow')[0] == 0
    assert run(capsys, 'grasp', 'hand', '--follow', tool)[0] == 0
    assert run(capsys, 'release', 'hand')[0] == 0


def test_sets_the_wind(outdoors, capsys):
    """The wind could not be changed from the command line without ros2."""
    code, out, _ = run(capsys, 'wind', '3', '-1', '0.5')
    assert (code, out) == (0, 'the wind is 3 -1 0.5 m/s\n')
    wind = outdoors.wait_for('inputs/wind').vector
    assert (wind.x, wind.y, wind.z) == (3.0, -1.0, 0.5)


@pytest.mark.parametrize('arguments', [
    ('collider', 'chair', '--to', '0', '0', '1'),
    ('collider', 'table', '--to', '0', '0', '1', '--speed', '0'),
    ('collider', 'table', '--to', '0', '0', '1', '--speed', '-1'),
    ('collider', 'table', '--to', '0', '0', '1', '--angular-speed', '1'),
    ('collider', 'table', '--to', '0', '0', 'nan'), ('collider', 'table', '--follow', ''),
    ('collider', 'table', '--follow', 'nowhere'),
    ('collider', 'table', '--unfollow', '--orientation', '0', '0', '0', '1'),
    ('grasp', 'hand'), ('grasp', 'hand', '--follow', 'nowhere'),
    ('grasp', 'hand', '--at', '0', '0', '1', '--frame', 'nowhere'),
    ('grasp', 'hand', '--to', '0', '0', '1', '--follow', 'world'),
    ('grasp', 'hand', '--unfollow', '--follow', 'world'),
    ('grasp', 'hand', '--unfollow', '--radius', '1'),
    ('wind', '2000', '0', '0'), ('wind', 'nan', '0', '0')])
def test_tells_why_not(outdoors, capsys, arguments):
    """A mistyped request would do something else, or end in a traceback."""
    before = {name: len(outdoors[name]) for name in ('inputs/collider_target', 'inputs/wind')}
    code, out, problem = run(capsys, *arguments)
    assert (code, out) == (1, '')
    assert len(problem.splitlines()) == 1
    assert before == {name: len(outdoors[name]) for name in before}


def test_a_scene_without_air_has_no_wind(verb):
    """The verb would wait for an answer that never comes, or say that the wind blows."""
    result = verb('wind', '3', '0', '0')
    assert (result.returncode, result.stdout) == (1, '')
    assert 'air.density' in result.stderr
