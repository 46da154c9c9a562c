# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What killed processes leave in the shared memory is given back, and nothing else."""

import fcntl
import os
import signal
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.node.dead_segments import reclaim_dead_segments
from cloth_sim_ros.node.dead_segments import Reclaimed
from cloth_sim_ros.node.dead_segments import SHARED_MEMORY
from cloth_sim_ros.node.large_messages import VARIABLE
from node_process import NodeProcess
import pytest
from shared_memory import segments_of

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


@pytest.mark.parametrize('age', [0.0, 4.0, -100.0])
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
        deadline = time.monotonic() + 60
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
        assert left, 'the test has to find what they leave'
        wait_or_make_old(left, wait)
        # Living readers remove some by themselves; this one nobody has opened.
        unknown = f'fastrtps_{os.urandom(8).hex()}'
        left |= {segment(SHARED_MEMORY, unknown), SHARED_MEMORY / unknown}
        with NodeProcess(tmp_path / 'next', SMALL, '-r', '__ns:=/next') as following:
            first = client.watch(ClothStats, '/next/cloth_sim/stats')
            client.spin_until(lambda: first.messages, 'the next node publishes')
            assert not {path for path in left if path.exists()}
            assert 'of shared memory in /dev/shm' in following.output
            assert all(path.exists() for path in own)
            stats.clear()
            client.spin_until(lambda: len(stats.messages) > 10, 'the neighbour goes on')
    assert not {path for path in own if path.exists()}
