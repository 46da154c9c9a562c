# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim play` ends when it should, and says what it could not play."""

from signal import SIGINT
from signal import SIGTERM

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.node.shared_memory import VARIABLE
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.verb.main import main
from graph_client import GraphClient
from player_process import PlayerProcess
import pytest
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import Writer
from rosbags.typesys import get_types_from_msg
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores
from shared_memory import largest_segment


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Record two seconds of stats at 10 Hz; return the folder."""
    recorder = Recorder(tmp_path_factory.mktemp('bags'), 'run')
    for number in range(21):
        recorder.write('stats', serialize_message(ClothStats(steps=number)), 0.1 * number)
    recorder.close()
    return str(recorder.path)


@pytest.fixture
def foreign(tmp_path):
    """Write a bag with a type that no package has; return the folder."""
    store = get_typestore(Stores.ROS2_JAZZY)
    store.register(get_types_from_msg('float64 value', 'no_such_msgs/msg/Thing'))
    with Writer(tmp_path / 'foreign', version=9) as writer:
        for number, name in enumerate(('no_such_msgs/msg/Thing', 'std_msgs/msg/Float64')):
            connection = writer.add_connection(f'/topic_{number}', name, typestore=store)
            writer.write(connection, 10, b'\x00\x01\x00\x00' + bytes(8))
    return str(tmp_path / 'foreign')


def play(capsys, *arguments):
    """Return exit code, output and errors of the verb."""
    capsys.readouterr()
    code = main(['play', *map(str, arguments), '--delay', '0'])
    return (code, *capsys.readouterr())


@pytest.mark.parametrize(('number', 'arguments'), [
    (SIGINT, ('--rate', 0.01)), (SIGTERM, ('--paused',)), *(
        pytest.param(*case, marks=pytest.mark.long) for case in (
            (SIGINT, ('--loop', '--rate', 1000)), (SIGTERM, ('--delay', 1000))))],
    ids=lambda value: value[0] if isinstance(value, tuple) else value.name)
def test_a_signal_ends_it_well(number, arguments, bag, tmp_path):
    """Ctrl-C would not end it, or give a traceback."""
    # The topic is offered only after the signals are looked after.
    with GraphClient() as client, PlayerProcess(tmp_path, bag, *arguments) as player:
        client.spin_until(
            lambda: client.node.count_publishers('/cloth_sim/stats'), 'the player is there')
        player.send(number)
        assert player.wait(client) == 0, player.problems
    assert 'Traceback' not in player.problems
    assert 'played' in player.output


def test_large_clouds_get_shared_memory(bag, tmp_path, monkeypatch):
    """Best-effort subscribers would miss most of the large clouds that are played."""
    monkeypatch.delenv(VARIABLE)
    with GraphClient() as client, PlayerProcess(tmp_path, bag, '--paused') as player:
        client.spin_until(
            lambda: client.node.count_publishers('/cloth_sim/stats'), 'the player is there')
        # As large as these small clouds need it, and no larger.
        assert 1 << 20 <= largest_segment(player.process.pid) < 2 << 20


@pytest.mark.parametrize(('arguments', 'message'), [
    (('--rate', 0), '--rate 0 is outside its range: give a value from 1e-06'),
    (('--start', 2.5), '--start 2.5 is after the end of the recording: give a time from 0 to 2'),
    (('--topics', '/nothing'), 'has no topic /nothing: choose from /cloth_sim/stats'),
    (('--as', 'no name'), '/no name/stats is not a valid topic name'),
])
def test_what_is_wrong_is_said_in_one_line(arguments, message, bag, capsys):
    """The user would get a traceback, or nothing would be played and nobody told."""
    code, output, errors = play(capsys, bag, '--topics', '/cloth_sim/stats', *arguments)
    assert code == 1
    assert not output
    assert message in errors
    assert 'Traceback' not in errors


def test_a_recording_without_messages_is_told(tmp_path, capsys):
    """It would look as if something had been played."""
    recorder = Recorder(tmp_path, 'empty')
    recorder.close()
    code, _, errors = play(capsys, recorder.path)
    assert code == 1
    assert 'contains no messages' in errors


def test_topics_of_unknown_types_are_named_and_left_out(foreign, capsys):
    """One foreign topic would keep all others from being played."""
    code, output, errors = play(capsys, foreign)
    assert code == 0
    assert '/topic_0 is left out: the message type no_such_msgs/msg/Thing is not' in errors
    assert 'played 1 messages' in output


def test_with_unknown_types_only_it_says_so(foreign, capsys):
    """It would play nothing and call that a success."""
    code, _, errors = play(capsys, foreign, '--topics', '/topic_0')
    assert code == 1
    assert 'no topic that can be played' in errors
