# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Publish a recording's messages again, in their order and at their pace."""

from pathlib import Path
from signal import SIGCONT
from signal import SIGSTOP
import subprocess
import sys
from threading import Timer
import time

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.player import PlayReport
from cloth_sim_ros.playback.player import SimulatedClock
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
from command import cloth_sim
from copied_bag import copy_bag
from copied_bag import WALL
from foreign_bag import write_bag
from player_process import PlayerProcess
import pytest
from rcl_interfaces.msg import ParameterEvent
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from shape_msgs.msg import Mesh


def test_all_in_time_is_one_sentence():
    """A user would look for a problem that there is not."""
    assert PlayReport(messages=7, rounds=1, furthest_behind=0.004).sentences() == [
        'played 7 messages, in time']


def test_lateness_is_told():
    """What looked jerky would be taken for the recording."""
    told, problem = PlayReport(
        messages=7, rounds=3, furthest_behind=60.0, slipped=59.5).sentences()
    assert told == 'played 7 messages in 3 rounds, at most 60 s late'
    assert 'this took 60 s longer' in problem
    assert 'nothing was dropped' in problem


def test_messages_that_a_reader_may_lack_are_told():
    """A recording of what was played would have gaps, and nobody would know."""
    _, problem = PlayReport(messages=7, rounds=1, overruns={'/a/points': 3}).sentences()
    assert 'a subscriber of /a/points may have lost up to 3 messages' in problem


# The clock that a recording is played with.

STAMPS = 2000
READER = f"""
import rclpy
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
rclpy.init()
node = rclpy.create_node('clock_reader')
received = []
subscription = node.create_subscription(
    Clock, '/clock', lambda message: received.append(message.clock.sec), QoSProfile(depth=1000))
print('ready', flush=True)
while not subscription.get_publisher_count():
    rclpy.spin_once(node, timeout_sec=0.1)
print('found', flush=True)
while not received or received[-1] != {STAMPS}:
    rclpy.spin_once(node, timeout_sec=0.1)
print(*received)
"""


def test_delayed_reader_gets_every_clock_stamp(client):
    """A node with use_sim_time would see time jump where its machine was busy."""
    with subprocess.Popen(
            [sys.executable, '-c', READER], stdout=subprocess.PIPE, text=True) as reader:
        try:
            reader.stdout.readline()
            clock = SimulatedClock(client.node, patience=300.0)
            client.spin_until(lambda: client.is_read('/clock'), 'the reader is found')
            assert reader.stdout.readline() == 'found\n'
            reader.send_signal(SIGSTOP)
            Timer(0.1, reader.send_signal, (SIGCONT,)).start()
            for number in range(1, STAMPS + 1):
                stats = ClothStats()
                stats.header.stamp = Time(sec=number)
                clock.read(ClothStats, serialize_message(stats))
            seconds, _ = reader.communicate(timeout=300.0)
        finally:
            reader.kill()
    assert [int(each) for each in seconds.split()] == list(range(1, STAMPS + 1))


# What is played reaches its readers as it was recorded.

FRAMES = 51


@pytest.fixture
def player(tmp_path):
    """Return a function that starts a player which waits for resume."""
    running = []

    def start(bag, *arguments):
        running.append(PlayerProcess(tmp_path, bag, '--paused', '--delay', 0, *arguments))
        return running[-1]

    yield start
    for process in running:
        process.__exit__()


def recorded(bag, **limits):
    """Return the decoded messages of a bag by their topics, in their order."""
    classes = {topic.type_name: topic.message for topic in TOPICS.values()}
    found = {}
    for raw in BagReader(bag).messages(**limits):
        found.setdefault(raw.topic, []).append(
            deserialize_message(raw.data, classes[raw.type_name]))
    return found


def listen(client, name, kind):
    """Return the list that all messages of a topic go into."""
    received = []
    client.node.create_subscription(kind, name, received.append, 1000)
    return received


def listen_to_all(client, messages):
    """Listen to the topics of ``messages``."""
    return {name: listen(client, name, type(of[0])) for name, of in messages.items()}


def stamp(message):
    """Return the stamp of a message [ns]."""
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


@pytest.mark.parametrize('storage', [None, 'sqlite3'])
def test_every_message_comes_in_order_with_its_values(storage, bag, client, player, tmp_path):
    """A played recording would not be the one that was made, or not that of `ros2 bag record`."""
    source = Path(bag) if storage is None else copy_bag(Path(bag), tmp_path / 'copy', storage)
    expected = recorded(source)
    assert len(expected['/cloth_sim/points']) == FRAMES
    heard = listen_to_all(client, expected)
    # At a pace that no machine of the tests keeps up with: late, but whole.
    process = player(source, '--rate', 1000)
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    for name, messages in expected.items():
        assert heard[name] == messages, name
    assert f'played {sum(map(len, expected.values()))} messages' in process.output


def test_the_pace_is_that_of_the_recording_times_the_rate(bag, client, player, tmp_path):
    """Slow motion would not be slow, or a wall-clock bag be played as if simulated."""
    wall_bag = copy_bag(Path(bag), tmp_path / 'copy')
    begin, end = BagReader(wall_bag).span
    assert begin == WALL
    assert (end - begin) * 1e-9 == pytest.approx(3.0)
    # A machine that is busy takes longer, and none less. That no message is due later than that,
    # test_schedule_play_clock.py shows.
    for source, rate, least in [(bag, 0.5, 2.0), (wall_bag, 1.0, 3.0)]:
        process = player(source, '--rate', rate, '--topics', '/cloth_sim/stats')
        begin = time.monotonic()
        process.resume(client)
        assert process.wait(client) == 0, process.problems
        assert time.monotonic() - begin > least
        assert f'played {FRAMES} messages' in process.output


def test_a_late_start_has_what_holds_from_before(bag, client, player):
    """A viewer would have no surface to draw, and nobody the parameters."""
    begin, _ = BagReader(bag).span
    start = begin + 600_000_000
    expected = recorded(bag, begin=start)
    before = recorded(bag, end=start)
    expected.setdefault('/cloth_sim/state', [])
    for key in ('topology', 'state', 'inputs/parameters'):
        name = f'/cloth_sim/{key}'
        expected[name] = before[name] + expected.get(name, [])
    names = ['topology', 'state', 'inputs/parameters', 'points', 'inputs/mode']
    heard = listen_to_all(client, {
        f'/cloth_sim/{key}': before[f'/cloth_sim/{key}'] for key in names})
    process = player(bag, '--rate', 10, '--start', 0.6)
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    for key in names:
        name = f'/cloth_sim/{key}'
        assert heard[name] == expected.get(name, []), name
    assert stamp(heard['/cloth_sim/points'][0]) == 600_000_000


def test_who_comes_late_gets_topology_and_state(bag, client, player):
    """A viewer that is opened while playing would not show the surface."""
    expected = recorded(bag)
    process = player(bag, '--rate', 0.02)
    process.resume(client)
    points = client.watch(PointCloud2, '/cloth_sim/points')
    client.spin_until(lambda: points.messages, 'a frame is played')
    assert client.read_kept(Mesh, '/cloth_sim/topology') == expected['/cloth_sim/topology'][0]
    assert client.read_kept(ClothState, '/cloth_sim/state') == expected['/cloth_sim/state'][0]


def test_a_loop_begins_again_with_the_first_stamp(bag, client, player):
    """A short recording could not be watched, or its second round had other stamps."""
    heard = listen(client, '/cloth_sim/stats', ClothStats)
    process = player(bag, '--loop', '--rate', 20, '--start', 0.2, '--duration', 0.6)
    process.resume(client)
    client.spin_until(lambda: len(heard) > 70, 'two rounds and a part are played')
    one_round = [number * 20_000_000 for number in range(10, 41)]
    assert [stamp(stats) for stats in heard[:62]] == 2 * one_round
    process.process.terminate()
    assert process.wait(client) == 0
    assert 'rounds' in process.output


def test_a_pause_stops_the_messages(bag, client, player):
    """A moment could not be looked at."""
    heard = listen(client, '/cloth_sim/stats', ClothStats)
    # Round and round: it is not at its end before the pause, however long that takes to come.
    process = player(bag, '--loop')
    process.resume(client)
    client.spin_until(lambda: heard, 'it plays')
    process.pause(client)
    client.spin_until_quiet()
    count = len(heard)
    client.spin_for(0.5)
    assert len(heard) == count
    process.resume(client)
    client.spin_until(lambda: len(heard) > count + FRAMES, 'another round is played')
    process.process.terminate()
    assert process.wait(client) == 0
    one_round = [number * 20_000_000 for number in range(FRAMES)]
    rounds = -(-len(heard) // FRAMES)
    assert [stamp(stats) for stats in heard] == (rounds * one_round)[:len(heard)]


def test_what_was_cut_off_is_played_to_its_end(bag, client, player, tmp_path):
    """The recording of a run that was killed could not be watched."""
    file, = Path(bag).glob('*.mcap')
    cut = tmp_path / 'cut.mcap'
    whole = file.read_bytes()
    # In the index at the end: all messages are there, but no summary.
    cut.write_bytes(whole[:-200])
    expected = recorded(cut)
    assert expected
    heard = listen_to_all(client, expected)
    process = player(cut, '--rate', 100)
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    assert heard == expected
    assert 'truncated' in process.problems


def test_the_clock_tells_the_stamps_where_none_is_recorded(bag, client, player):
    """Nodes with use_sim_time would stand still."""
    clock = listen(client, '/clock', Clock)
    stats = listen(client, '/cloth_sim/stats', ClothStats)
    process = player(bag, '--clock', '--rate', 10)
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    assert len(clock) == FRAMES
    assert [message.clock for message in clock] == [message.header.stamp for message in stats]


def test_a_recorded_clock_is_played_and_no_other(client, player, tmp_path):
    """Two clocks would pull the time of every node back and forth."""
    recorder = Recorder(tmp_path, 'run')
    for number in range(20):
        recorder.write('clock', serialize_message(Clock(clock=Time(sec=100 + number))), number)
        recorder.write('stats', serialize_message(ClothStats(steps=number)), number)
    recorder.close()
    clock = listen(client, '/clock', Clock)
    process = player(recorder.path, '--clock', '--rate', 100)
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    assert [message.clock.sec for message in clock] == list(range(100, 120))


def test_a_recorded_clock_is_not_played_unasked(client, player, tmp_path):
    """Every node with use_sim_time would jump to the time of a recording."""
    recorder = Recorder(tmp_path, 'run')
    for number in range(20):
        recorder.write('clock', serialize_message(Clock(clock=Time(sec=100 + number))), number)
        recorder.write('stats', serialize_message(ClothStats(steps=number)), number)
    recorder.close()
    clock, stats = listen(client, '/clock', Clock), listen(client, '/cloth_sim/stats', ClothStats)
    process = player(recorder.path, '--rate', 100)
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    assert len(stats) == 20 and not clock
    assert client.node.count_publishers('/clock') == 0


def test_damaged_messages_are_left_out_and_counted(bag, client, player, tmp_path):
    """A forged length made readers fail, and bytes that are none ended the player: RCLError."""
    recorder = Recorder(tmp_path, 'run')
    good = serialize_message(ClothStats(steps=7))
    forged = good[:12] + b'\xff\xff\xff\xff' + good[16:]  # the length of header.frame_id
    clock = serialize_message(Clock(clock=Time(sec=1)))
    for number, data in enumerate((good, forged, good[:20], b'', b'\x77' * 40, good)):
        recorder.write('stats', data, number / 10)
        recorder.write('clock', clock + bytes(100 * number), number / 10)
    recorder.close()
    stats = listen(client, '/cloth_sim/stats', ClothStats)
    process = player(recorder.path, '--rate', 10, '--clock')
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    assert [message.steps for message in stats] == [7, 7]
    assert '4 messages of /cloth_sim/stats were left out, as they are damaged' in process.problems
    assert 'Traceback' not in process.problems and 'RCLError' not in process.problems


def test_a_jump_of_centuries_is_refused_at_once(tmp_path):
    """The player said nothing, and waited for 292 years."""
    recorder = Recorder(tmp_path, 'run')
    for begin in (0.0, 0.1, 2.0**63 * 1e-9 - 1.0):
        recorder.write('stats', serialize_message(ClothStats()), begin)
    recorder.close()
    result = cloth_sim('play', str(recorder.path))
    assert result.returncode == 1 and result.stdout == ''
    [line] = result.stderr.splitlines()
    assert 'goes on for 9.22e+09 s' in line and '--duration' in line
    # What comes before it can be played.
    result = cloth_sim('play', str(recorder.path), '--duration', '1', '--delay', '0')
    assert result.returncode == 0 and result.stdout.startswith('played 2 messages')


def test_a_long_gap_is_told(client, player, tmp_path):
    """A user would take a recording with a gap of an hour for a player that hangs."""
    recorder = Recorder(tmp_path, 'run')
    for begin in (0.0, 3600.0):
        recorder.write('stats', serialize_message(ClothStats()), begin)
    recorder.close()
    process = player(recorder.path)
    process.resume(client)
    client.spin_until(lambda: 'the next message' in process.problems, 'the gap is reported')
    assert 'is due in 3.6e+03 s, at 3600 s of the recording' in process.problems
    assert process.problems.count('the next message') == 1


def test_clock_is_monotonic_across_split_files(client, player, tmp_path):
    """Nodes with use_sim_time would forget all that they know at each new file."""
    recorder = Recorder(
        tmp_path, 'run', options=RecordingOptions(max_bagfile_duration=1.0))
    recorder.write('state', serialize_message(ClothState()), 0.0)
    for number in range(1, 40):
        stats = ClothStats(steps=number)
        stats.header.stamp = Time(sec=number // 10, nanosec=number % 10 * 10**8)
        recorder.write('stats', serialize_message(stats), number / 10)
    recorder.close()
    assert len(list(recorder.path.glob('*.mcap'))) == 4
    clock = listen(client, '/clock', Clock)
    process = player(recorder.path, '--clock', '--rate', 10)
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    times = [message.clock.sec + 1e-9 * message.clock.nanosec for message in clock]
    assert times == sorted(times) and len(times) == 39


def test_topics_of_the_node_can_get_another_name(bag, client, player):
    """A recording could not be watched beside the node it came from."""
    name = '/replay/cloth_sim/stats'
    renamed = listen(client, name, ClothStats)
    original = listen(client, '/cloth_sim/stats', ClothStats)
    process = player(bag, '--rate', 10, '--as', 'replay/cloth_sim')
    process.resume(client)
    assert process.wait(client) == 0, process.problems
    assert len(renamed) == FRAMES
    assert not original


def test_another_publisher_is_named(bag, client, tmp_path):
    """A user would watch a mixture of two cloths and not know why."""
    publisher = client.node.create_publisher(ClothStats, '/cloth_sim/stats', 10)
    # How soon it is found depends on what else the machine does.
    for delay in (5, 50, 250):
        with PlayerProcess(tmp_path, bag, '--rate', 10, '--delay', delay) as process:
            assert process.wait(client) == 0, process.problems
        if 'as well' in process.problems:
            break
    assert '/test_client publishes /cloth_sim/stats as well' in process.problems
    assert 'cloth_sim_player publishes' not in process.problems
    client.node.destroy_publisher(publisher)


def test_what_every_node_publishes_is_no_other_cloth(client, tmp_path):
    """A user with a bag of `ros2 bag record --all` would be advised to stop the player itself."""
    bag = write_bag(
        tmp_path / 'all', [('/parameter_events', ParameterEvent())] * 5, interval=10**8)
    with PlayerProcess(tmp_path, bag, '--delay', 0.5) as process:
        assert process.wait(client) == 0, process.problems
    assert 'as well' not in process.problems
