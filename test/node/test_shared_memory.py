# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Shared memory that the clouds fit into, and that of killed processes given back."""

import fcntl
import os
from pathlib import Path
import re
import signal
import time
from xml.etree import ElementTree

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.node.shared_memory import cloud_bytes
from cloth_sim_ros.node.shared_memory import frame_bytes
from cloth_sim_ros.node.shared_memory import leave_out_memory
from cloth_sim_ros.node.shared_memory import reclaim_dead_segments
from cloth_sim_ros.node.shared_memory import Reclaimed
from cloth_sim_ros.node.shared_memory import SHARED_MEMORY
from cloth_sim_ros.node.shared_memory import SharedMemory
from cloth_sim_ros.node.shared_memory import TRANSPORTS
from cloth_sim_ros.node.shared_memory import use_profile
from cloth_sim_ros.node.shared_memory import VARIABLE
from node_process import NodeProcess
import pytest
import quick_discovery
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import PointCloud2
from shared_memory import largest_segment
from shared_memory import segments_of
from std_srvs.srv import SetBool
from udp_sockets import udp_sockets

MIB = 1 << 20
LARGE = {
    'rows': 512, 'cols': 512, 'dt': 0.01, 'publish.rate': 100.0, 'start_paused': True,
    'publish.markers': False, 'auto_substeps': False,
    **{f'{kind}.{family}': 0.0 for kind in ('stiffness', 'damping')
       for family in ('structural', 'shear', 'bend')}}
SEEN = {
    'rows': 16, 'cols': 16, 'cameras.names': ['front'],
    'cameras.front.target': [0.0, 0.0, 0.5]}


def test_a_best_effort_subscriber_gets_every_cloud(client, tmp_path, monkeypatch):
    """RViz, Foxglove or a program with sensor quality would miss most clouds of a large cloth."""
    monkeypatch.delenv(VARIABLE)
    clouds = set()
    with NodeProcess(tmp_path, LARGE, '-r', '__ns:=/large') as node:
        stats = client.watch(ClothStats, '/large/cloth_sim/stats')
        subscription = client.node.create_subscription(
            PointCloud2, '/large/cloth_sim/points',
            lambda cloud: clouds.add(cloud.header.stamp.nanosec // 10_000_000),
            QoSProfile(depth=20, reliability=ReliabilityPolicy.BEST_EFFORT))
        client.spin_until(lambda: stats.messages and 0 in clouds, 'the first cloud')
        # The node knows its clients in the order in which they were made.
        client.service(Step, '/large/cloth_sim/step')
        client.call_until_answered(SetBool, '/large/cloth_sim/pause', data=True)
        for number in range(1, 7):
            assert client.call(Step, '/large/cloth_sim/step', steps=1).success
            # Whoever is held up for several frames loses some, which is not what is asked.
            client.spin_until(lambda: number in clouds, f'cloud {number}')
        client.spin_until(lambda: stats.messages[-1].steps == 6, 'the last statistics')
        assert clouds == set(range(7))
        assert largest_segment(node.pid) > 512 * 512 * 44
        client.node.destroy_subscription(subscription)


@pytest.mark.parametrize('side, free, mebibytes', [
    (32, 64 * MIB, 1), (35, 64 * MIB, 1), (36, 64 * MIB, 4), (64, 64 * MIB, 4),
    (128, 64 * MIB, 16),
    (256, 64 * MIB, 32), (1024, 64 * MIB, 32), (256, 64 * MIB - 1, 16), (256, 32 * MIB - 1, 4),
    (256, 2 * MIB, 1)])
def test_takes_the_profile_that_fits(side, free, mebibytes):
    """A small cloth would hold memory for large ones, or a container have none at all."""
    environment = {}
    memory = use_profile(frame_bytes(side, side), environment, free)
    file = Path(environment[VARIABLE])
    segment = ElementTree.parse(file).find('.//{*}segment_size')
    assert int(segment.text) == memory.segment == mebibytes * MIB


def test_the_profiles_differ_in_their_memory_alone():
    """A fix in one of them would be missing in the others."""
    texts = set()
    for side in (1, 64, 128, 256):
        environment = {}
        use_profile(frame_bytes(side, side), environment, 64 * MIB)
        root = ElementTree.parse(environment[VARIABLE]).getroot()
        sizes = [root.find(f'.//{{*}}{name}') for name in ('segment_size', 'maxMessageSize')]
        # Fast DDS takes no part that is larger than the whole.
        assert int(sizes[0].text) == 4 * int(sizes[1].text)
        for size in sizes:
            size.text = ''
        texts.add(re.sub(r'\s', '', ElementTree.tostring(root, encoding='unicode')))
    assert len(texts) == 1


@pytest.mark.parametrize('environment, lack', [
    ({}, '/dev/shm has 2 MiB free and 64 MiB are needed'),
    ({'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp'},
     'rmw_cyclonedds_cpp does not use Fast DDS profiles'),
    ({'RMW_IMPLEMENTATION': 'rmw_fastrtps_cpp', VARIABLE: ''}, f'{VARIABLE} is empty'),
    ({VARIABLE: str(quick_discovery.PROFILE)}, 'which has no segment_size'),
    ({VARIABLE: '/nowhere.xml'}, 'which has no segment_size'),
    ({'FASTDDS_BUILTIN_TRANSPORTS': 'UDPv4'}, 'FASTDDS_BUILTIN_TRANSPORTS is UDPv4'),
    ({'FASTDDS_BUILTIN_TRANSPORTS': 'LARGE_DATA'}, '')], ids=str)
def test_what_the_user_has_chosen_stays(environment, lack):
    """A user's own profile would be replaced, or clouds be lost without a word."""
    given = dict(environment)
    told = use_profile(frame_bytes(1000, 1000), environment, 2 * MIB - 1).warning(44_000_000)
    assert environment == given
    assert lack in told and bool(lack) == bool(told)


def test_a_small_profile_of_the_user_is_told(tmp_path):
    """Large clouds would be lost though the profile has shared memory."""
    profile = tmp_path / 'own.xml'
    profile.write_text('<segment_size> 1000000 </segment_size>')
    memory = use_profile(1, {VARIABLE: str(profile)})
    assert memory.segment == 1_000_000
    assert f'give {profile} a segment_size' in memory.warning(1_000_001)
    assert memory.warning(1_000_000) == ''


@pytest.mark.parametrize('cloud, memory, told', [
    (524_288, SharedMemory(524_288, 'too little'), ''),
    (524_289, SharedMemory(524_288, 'too little'), 'where they subscribe best-effort: too little'),
    (1, SharedMemory(524_288, 'too little', is_full=True), 'too little'),
    (44_000_000, SharedMemory(524_288), '')])
def test_only_what_matters_is_spoken_of(cloud, memory, told):
    """A small cloth would be started with a warning, or a large one, or a full disk, without."""
    assert memory.warning(cloud).endswith(told) and bool(memory.warning(cloud)) == bool(told)


@pytest.mark.parametrize('free', [0, 2 * MIB - 1, 16 * MIB])
def test_a_full_memory_is_told_with_numbers(free):
    """The profile would be dropped in silence, and the clouds of a large cloth be lost."""
    told = use_profile(frame_bytes(256, 256), {}, free).warning(cloud_bytes(256**2))
    assert f'/dev/shm has {free / MIB:.0f} MiB free and 64 MiB are needed' in told
    assert 'free some, or raise --shm-size of a container' in told


@pytest.mark.parametrize('free', [0, MIB - 1])
def test_without_room_shared_memory_is_left_out(free):
    """Fast DDS would try, and print errors; other processes would find no room for theirs."""
    environment = {}
    memory = use_profile(frame_bytes(4, 4), environment, free)
    root = ElementTree.parse(environment[VARIABLE]).getroot()
    assert [kind.text for kind in root.iterfind('.//{*}type')] == ['UDPv4']
    assert memory.segment == 0 and 'is left out: free some' in memory.warning(1)
    assert 'so subscribers will miss some' in memory.warning(600_000)
    assert leave_out_memory(environment := {}, free) and environment == {TRANSPORTS: 'UDPv4'}
    own = {VARIABLE: '/nowhere.xml'}
    assert 'is left out' in use_profile(1, own, free).lack and own[TRANSPORTS] == 'UDPv4'


@pytest.mark.parametrize('environment', [
    {}, {TRANSPORTS: 'LARGE_DATA'}, {'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp'}])
def test_with_room_or_a_choice_nothing_is_left_out(environment):
    """Verbs would speak of memory that is there, or undo what the user has chosen."""
    given = dict(environment)
    assert leave_out_memory(environment, 0 if given else MIB) == '' and environment == given


@pytest.mark.parametrize('name, values, told', [
    ('clouds', {'rows': 128, 'cols': 128}, '0.72 MB'),
    ('no_clouds', {'rows': 128, 'cols': 128, 'publish.points': False}, ''),
    ('pictures', {**SEEN, 'cameras.front.width': 640, 'cameras.front.height': 480}, '3.7 MB'),
    ('small_pictures', {**SEEN, 'cameras.front.width': 64, 'cameras.front.height': 48}, '')])
def test_the_node_warns(name, values, told, client, tmp_path):
    """A user whose own profile is too small would look for the missing clouds elsewhere."""
    with NodeProcess(tmp_path, {**LARGE, **values}, '-r', f'__ns:=/warns_{name}') as node:
        # It serves only after it has said what there is to say.
        client.call_until_answered(SetBool, f'/warns_{name}/cloth_sim/pause', data=True)
    warned = re.search(r'messages have up to (.*) but Fast DDS only 0.52 MB', node.output)
    assert (warned[1] if warned else '') == told, node.output


def test_local_profile_listens_on_loopback_only(client, tmp_path):
    """A host that knows the address would reach a node that was meant for this machine."""
    profile = shared_directory('config') / 'fastdds_localhost.xml'
    with NodeProcess(tmp_path, {'rows': 4, 'cols': 4}, '-r', '__ns:=/closed', environment={
            VARIABLE: str(profile)}) as node:
        # It serves this machine as ever.
        assert client.call_until_answered(
            SetBool, '/closed/cloth_sim/pause', data=True).success
        # Sockets that only send have a port from the ephemeral range.
        listening = [(host, port) for host, port in udp_sockets(node.pid) if port < 32768]
    assert listening and {host for host, _ in listening} == {'127.0.0.1'}


# What killed processes leave in the shared memory is given back, and nothing else.

DEAD = 'fastrtps_0123456789abcdef'
# More than the age below which a segment counts as that of a process about to start [s].
OLD = 6.0
SMALL = {'rows': 4, 'cols': 4, 'start_paused': True}


def segment(folder, name, size=1000, age=OLD):
    """Make a segment and its lock file as Fast DDS does, and return the lock file."""
    (folder / name).write_bytes(bytes(size))
    lock = folder / f'{name}_el'
    lock.touch()
    then = time.time() - age
    os.utime(lock, (then, then))
    return lock


def names_in(folder):
    """Return what is left."""
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize('name', [DEAD, 'fastdds_fedcba9876543210'])
def test_a_dead_segment_is_removed_and_told(name, tmp_path):
    """After some crashes there would be no shared memory left."""
    segment(tmp_path, name, size=134_000_000)
    reclaimed = reclaim_dead_segments(tmp_path)
    assert reclaimed == Reclaimed(1, 134_000_000)
    assert 'reclaimed 134 MB of shared memory' in str(reclaimed)
    assert names_in(tmp_path) == []
    assert str(reclaim_dead_segments(tmp_path)) == ''


@pytest.mark.parametrize('lock_type', [fcntl.LOCK_EX, fcntl.LOCK_SH])
def test_the_segment_of_a_living_process_stays(lock_type, tmp_path):
    """A node would lose its topics when another one starts."""
    lock = segment(tmp_path, DEAD)
    with lock.open() as handle:
        fcntl.flock(handle, lock_type)
        assert reclaim_dead_segments(tmp_path) == Reclaimed()
        assert names_in(tmp_path) == [DEAD, f'{DEAD}_el']
    assert reclaim_dead_segments(tmp_path).segments == 1


@pytest.mark.parametrize('age', [0.0, 2.0, -100.0])
def test_a_young_segment_stays(age, tmp_path):
    """A process that is about to lock its new segment would lose it."""
    segment(tmp_path, DEAD, age=age)
    assert reclaim_dead_segments(tmp_path) == Reclaimed()
    assert names_in(tmp_path) == [DEAD, f'{DEAD}_el']


@pytest.mark.skipif(os.geteuid() != 0, reason='only root makes files of other users')
@pytest.mark.parametrize('owned', ['segment', 'lock'])
def test_the_segment_of_another_user_stays(owned, tmp_path):
    """A node of root would remove what others use."""
    lock = segment(tmp_path, DEAD)
    os.chown(lock if owned == 'lock' else tmp_path / DEAD, 12345, 12345)
    assert reclaim_dead_segments(tmp_path) == Reclaimed()
    assert DEAD in names_in(tmp_path)


@pytest.mark.parametrize('name', [
    'fastrtps_port7411', 'sem.fastrtps_0123456789abcdef', 'fastrtps_0123456789ABCDEF',
    'fastrtps_0123456789abcdef0', 'fast_datasharing_0123456789abcdef', 'mine'])
def test_everything_else_stays(name, tmp_path):
    """Memory of other programs would be removed."""
    segment(tmp_path, name)
    assert reclaim_dead_segments(tmp_path) == Reclaimed()
    assert names_in(tmp_path) == [name, f'{name}_el']


def test_links_are_not_followed(tmp_path):
    """A link of that name would have another file removed, or held up a start."""
    folder, outside = tmp_path / 'shm', tmp_path / 'outside'
    folder.mkdir()
    outside.write_text('data')
    lock = segment(folder, DEAD)
    (folder / DEAD).unlink()
    (folder / DEAD).symlink_to(outside)
    (folder / 'fastrtps_1111111111111111_el').symlink_to(outside)
    os.mkfifo(folder / 'fastrtps_2222222222222222_el')
    os.utime(folder / 'fastrtps_2222222222222222_el', (0, 0))
    assert reclaim_dead_segments(folder) == Reclaimed()
    assert outside.read_text() == 'data'
    assert not lock.exists() and len(names_in(folder)) == 3


def test_a_machine_without_shared_memory_is_no_problem(tmp_path):
    """The node would not start there."""
    assert reclaim_dead_segments(tmp_path / 'nowhere') == Reclaimed()


def killed_nodes(folder, count):
    """Start ``count`` nodes one after the other, kill each, and return their segments."""
    left = set()
    for number in range(count):
        node = NodeProcess(folder / f'killed_{number}', SMALL, '-r', f'__ns:=/killed_{number}')
        deadline = time.monotonic() + 300.0
        while not (segments := segments_of(node.pid, exclusively=True)):
            assert node.running and time.monotonic() < deadline, node.output
            time.sleep(0.05)
        node.send(signal.SIGKILL)
        node.wait()
        left |= segments
    return left


def wait_or_make_old(segments, wait):
    """Let segments become old, or say of them that they are."""
    if wait:
        time.sleep(OLD)
        return
    then = time.time() - OLD
    for path in segments:
        lock = path.with_name(f'{path.name}_el')
        if lock.exists():
            os.utime(lock, (then, then))


@pytest.mark.parametrize(('count', 'wait'), [
    (1, False), *(pytest.param(count, True, marks=pytest.mark.long) for count in (3, 20))])
def test_killed_nodes_leave_nothing_behind(count, wait, client, tmp_path, monkeypatch):
    """Each node that is killed would take memory away, until none is left for large clouds."""
    monkeypatch.delenv(VARIABLE)
    running = {**SMALL, 'start_paused': False}
    with NodeProcess(tmp_path / 'neighbour', running, '-r', '__ns:=/neighbour') as neighbour:
        stats = client.watch(ClothStats, '/neighbour/cloth_sim/stats')
        client.spin_until(lambda: stats.messages, 'the neighbour publishes')
        own = segments_of(neighbour.pid, exclusively=True)
        left = killed_nodes(tmp_path, count)
        assert left, 'segments have to be left'
        wait_or_make_old(left, wait)
        with NodeProcess(tmp_path / 'next', SMALL, '-r', '__ns:=/next'):
            first = client.watch(ClothStats, '/next/cloth_sim/stats')
            client.spin_until(lambda: first.messages, 'the next node publishes')
            assert not {path for path in left if path.exists()}
            assert all(path.exists() for path in own)
            stats.clear()
            client.spin_until(lambda: len(stats.messages) > 10, 'the neighbour goes on')
    assert not {path for path in own if path.exists()}


def test_a_node_says_what_it_has_reclaimed(client, tmp_path):
    """Who looks for the memory that was missing would not learn where it went."""
    def starts_and_says_so(number: int) -> bool:
        unknown = f'fastrtps_{os.urandom(8).hex()}'
        segment(SHARED_MEMORY, unknown)
        with NodeProcess(tmp_path / str(number), SMALL) as node:
            client.spin_until(lambda: 'nodes in mode' in node.output, 'the node has started')
            assert not (SHARED_MEMORY / unknown).exists()
            return 'of shared memory in /dev/shm' in node.output

    # A node that another test starts meanwhile may be the one that finds it.
    assert any(starts_and_says_so(number) for number in range(5))
