# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Shared memory that the clouds fit into, and that of killed processes given back."""

from collections.abc import MutableMapping
from dataclasses import dataclass
import fcntl
from importlib.abc import MetaPathFinder
import os
from pathlib import Path
import re
import resource
import shutil
import stat
import sys
import time

from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.messages.geometry import surface_bytes
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.snapshot import POINT_DTYPE

VARIABLE = 'FASTRTPS_DEFAULT_PROFILES_FILE'
_MIB = 1 << 20
# Segment [bytes] and profile of Fast DDS. Twice the segment must be free: others need some, too.
# Nobody could use more than 32 MiB: a reader's queue has 512 places, and a part at most 64 KiB.
_PROFILES = (
    (_MIB, 'fastdds_large_messages_1_mib.xml'),
    (4 * _MIB, 'fastdds_large_messages_4_mib.xml'),
    (16 * _MIB, 'fastdds_large_messages_16_mib.xml'),
    (32 * _MIB, 'fastdds_large_messages.xml'))
# A reader that runs late by so many frames still gets them all.
_FRAMES = 3
_FAST_DDS = ('', 'rmw_fastrtps_cpp', 'rmw_fastrtps_dynamic_cpp')
# What Fast DDS takes by itself [bytes]: of larger messages, some are lost. A reliable subscriber
# misses those that newer ones replace before all parts have come.
_DEFAULT_SEGMENT = 512 << 10
# Below this [bytes] no segment fits beside what others need, and shared memory is left out.
_LEAST = 2 * _DEFAULT_SEGMENT
# Two pages.
_TRACING_ROOM = 2 * resource.getpagesize()
_UDP_PROFILE = 'fastdds_large_messages_udp.xml'
TRANSPORTS = 'FASTDDS_BUILTIN_TRANSPORTS'
_MOST_PROFILE_BYTES = _MIB


@dataclass(frozen=True)
class SharedMemory:
    """
    The shared memory of Fast DDS in this process.

    :param segment: how large it is [bytes]
    :param lack: why it is not larger, with the way out; empty when it is large enough
    :param is_full: True when that is for lack of room in /dev/shm
    """

    segment: int
    lack: str = ''
    is_full: bool = False

    def warning(self, message: int) -> str:
        """
        Return what to warn of; empty when all is well.

        :param message: size of the largest that is sent [bytes]; 0 when none are
        """
        # UDP delivers messages of the default segment's size.
        if self.lack and message > (self.segment or _DEFAULT_SEGMENT):
            return (
                f'messages have up to {message / 1e6:.2g} MB but Fast DDS only '
                f'{self.segment / 1e6:.2g} MB of shared memory, so subscribers will miss some, '
                f'and most where they subscribe best-effort: {self.lack}')
        return self.lack if self.is_full else ''


# Sizes of a pixel [bytes]: its point, the largest part, and colour, depth, label and point.
_PIXEL_POINT_BYTES = 12
_PICTURE_BYTES = 3 + 4 + 1 + _PIXEL_POINT_BYTES


def cloud_bytes(nodes: int) -> int:
    """Return how large the cloud of ``nodes`` nodes is [bytes]."""
    return nodes * POINT_DTYPE.itemsize


def frame_bytes(rows: int, cols: int) -> int:
    """Return how large the cloud and the markers of a frame are together [bytes]."""
    return cloud_bytes(rows * cols) + surface_bytes(rows, cols)


def picture_bytes(width: int, height: int) -> int:
    """Return how large all parts of a picture are together [bytes]."""
    return width * height * _PICTURE_BYTES


def picture_cloud_bytes(width: int, height: int) -> int:
    """Return how large the cloud of a picture is [bytes], the largest of its messages."""
    return width * height * _PIXEL_POINT_BYTES


def use_profile(
        frame: int, environment: MutableMapping[str, str] = os.environ,
        free: int | None = None) -> SharedMemory:
    """
    Name a profile with enough shared memory to Fast DDS, unless the user has chosen otherwise.

    It is read when the first ROS node is made, and so has to be named before.

    :param frame: size of what is sent at a time [bytes]
    :param free: room in /dev/shm [bytes]; by default what there is
    """
    implementation = environment.get('RMW_IMPLEMENTATION', '')
    if implementation not in _FAST_DDS:
        return SharedMemory(_DEFAULT_SEGMENT, (
            f'{implementation} does not use Fast DDS profiles: give it larger buffers, or set '
            'RMW_IMPLEMENTATION=rmw_fastrtps_cpp'))
    room = _free_memory() if free is None else free
    if VARIABLE in environment:
        lack = leave_out_memory(environment, room)
        return SharedMemory(0, lack, is_full=True) if lack else _memory_of(environment[VARIABLE])
    transports = environment.get(TRANSPORTS, 'DEFAULT')
    if transports != 'DEFAULT':
        return SharedMemory(_DEFAULT_SEGMENT, '' if transports.startswith('LARGE_DATA') else (
            f'{TRANSPORTS} is {transports}: unset it, or set LARGE_DATA'))
    return _fitting(frame, environment, room)


def _fitting(frame: int, environment: MutableMapping[str, str], free: int) -> SharedMemory:
    """Name the profile that suits ``frame``, or the largest that there is room for."""
    suitable = [profile for profile in _PROFILES if profile[0] >= _FRAMES * frame]
    wanted, name = (suitable or _PROFILES[-1:])[0]
    fitting = [
        profile for profile in _PROFILES if profile[0] <= wanted and 2 * profile[0] <= free]
    segment = _DEFAULT_SEGMENT
    if free < _LEAST:
        environment[VARIABLE] = str(shared_directory('config') / _UDP_PROFILE)
        return SharedMemory(0, _lack(free, 2 * wanted, 'is left out'), is_full=True)
    if fitting:
        segment, name = fitting[-1]
        environment[VARIABLE] = str(shared_directory('config') / name)
    # A reader that keeps up takes the parts of a frame out while the others come in.
    if segment == wanted or fitting and segment >= frame:
        return SharedMemory(segment)
    return SharedMemory(segment, _lack(free, 2 * wanted, 'is smaller'), is_full=True)


def _lack(free: int, needed: int, outcome: str) -> str:
    return (
        f'/dev/shm has {free / _MIB:.3g} MiB free and {needed // _MIB} MiB are needed for the '
        f'shared memory of Fast DDS, which {outcome}: free some, or raise --shm-size of a '
        'container')


def leave_out_memory(
        environment: MutableMapping[str, str] = os.environ, free: int | None = None) -> str:
    """
    Have Fast DDS do without shared memory where there is no room for it.

    A profile with transports of its own is not changed by that; Fast DDS then prints that it
    could not make a segment, and uses the other transports.

    :param free: room in /dev/shm [bytes]; by default what there is
    :return: what to warn of; empty when there is room, or something else was chosen
    """
    room = _free_memory() if free is None else free
    if room >= _LEAST or environment.get('RMW_IMPLEMENTATION', '') not in _FAST_DDS:
        return ''
    if environment.setdefault(TRANSPORTS, 'UDPv4') not in ('DEFAULT', 'UDPv4'):
        return ''
    environment[TRANSPORTS] = 'UDPv4'
    return _lack(room, _LEAST, 'is left out')


class _NoRoomForTracing(MetaPathFinder):
    """Refuses to load ROS."""

    def find_spec(self, fullname: str, path: object = None, target: object = None) -> None:
        if fullname.partition('.')[0] == 'rclpy':
            raise ClothSimError(
                f'{SHARED_MEMORY} is full, and loading ROS would end this process, as its tracing '
                f'(LTTng) needs {_TRACING_ROOM} bytes there: free some, or raise --shm-size of a '
                'container')


def refuse_ros_without_memory(free: int | None = None, folder: Path | None = None) -> None:
    """
    Let imports of ROS raise ClothSimError where they would end the process.

    The tracing of ROS maps two files in /dev/shm when it is loaded and reads them on a thread of
    its own. Without room for their pages, that is a SIGBUS.

    :param free: room in /dev/shm [bytes]; by default what there is
    :param folder: where the files lie
    """
    room = _free_memory() if free is None else free
    if room < _TRACING_ROOM and not _has_tracing_files(folder or SHARED_MEMORY):
        sys.meta_path.insert(0, _NoRoomForTracing())


def _has_tracing_files(folder: Path) -> bool:
    """Return whether the files of all users and of this one are there, with their pages."""
    own = f'-{os.getuid()}'
    found = [path for path in folder.glob('lttng-ust-wait-*') if path.stat().st_blocks]
    return len({path.name.endswith(own) for path in found}) == 2


def _memory_of(profile: str) -> SharedMemory:
    """Return the segment size of a profile chosen by the user."""
    if not profile:
        return SharedMemory(_DEFAULT_SEGMENT, f'{VARIABLE} is empty: unset it')
    try:
        text = read_regular(profile, _MOST_PROFILE_BYTES).decode(errors='replace')
    except (OSError, ClothSimError):
        text = ''
    found = re.search(r'<segment_size>\s*(\d+)', text)
    if found:
        segment, most = int(found[1]), _PROFILES[-1][0]
        return SharedMemory(segment, '' if segment >= most else (
            f'give {profile} a segment_size of up to {most}'))
    return SharedMemory(_DEFAULT_SEGMENT, (
        f'{VARIABLE} names {profile}, which has no segment_size: unset it, or give the profile '
        f'one as config/{_PROFILES[-1][1]} does'))


def _free_memory() -> int:
    try:
        return shutil.disk_usage('/dev/shm').free
    except OSError:
        return 0


# Shared memory that killed processes left behind, given back to the machine.
#
# The rule is that of Fast DDS: beside each segment lies a lock file, on which its process holds an
# exclusive lock (flock) for as long as it lives. Who gets that lock knows that the process is
# dead.

SHARED_MEMORY = Path('/dev/shm')
# Fast DDS 2 and 3. Segments have random names, which no process ever takes a second time.
_LOCK = re.compile(r'(fast(?:rtps|dds)_[0-9a-f]{16})_el')
# A process that has just made its lock file may not have locked it yet [s].
_YOUNG = 5.0


@dataclass(frozen=True)
class Reclaimed:
    """
    The memory that was released.

    :param segments: how many there were
    :param size: of all of them [bytes]
    """

    segments: int = 0
    size: int = 0

    def __str__(self) -> str:
        """Return one sentence; empty when there was nothing."""
        if not self.segments:
            return ''
        plural = '' if self.segments == 1 else 's'
        return (
            f'reclaimed {self.size / 1e6:.3g} MB of shared memory in {SHARED_MEMORY}: '
            f'{self.segments} segment{plural} of Fast DDS whose process was killed')


def reclaim_dead_segments(folder: Path = SHARED_MEMORY, young: float = _YOUNG) -> Reclaimed:
    """
    Remove the segments of this user's dead processes.

    Segments of living processes and of other users are left alone, and so are ports, which Fast
    DDS itself resets when a process next uses them.

    :param folder: where the segments lie
    :param young: age below which a segment is left alone [s]
    """
    sizes = []
    try:
        names = os.listdir(folder)
    except OSError:
        return Reclaimed()
    for name in names:
        found = _LOCK.fullmatch(name)
        if found:
            size = _reclaim(folder / found[1], folder / name, young)
            sizes += [] if size is None else [size]
    return Reclaimed(len(sizes), sum(sizes))


def _reclaim(segment: Path, lock: Path, young: float) -> int | None:
    """Return the size of a dead segment that was removed; None where there was none to remove."""
    try:
        handle = os.open(lock, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        locked = os.fstat(handle)
        if not _is_own(locked) or time.time() - locked.st_mtime < young:
            return None
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        # Somebody else may have removed it since it was opened.
        if not os.path.samestat(os.lstat(lock), locked):
            return None
        size = _remove_segment(segment)
        # Last, so that whoever is killed before this line leaves it to the next.
        os.unlink(lock)
        return size
    except OSError:
        return None  # it is locked, and so its process lives, or it has gone meanwhile
    finally:
        os.close(handle)


def _remove_segment(segment: Path) -> int | None:
    try:
        found = os.lstat(segment)
    except FileNotFoundError:
        return None  # a living reader of the dead process has removed it
    if not _is_own(found):
        return None
    os.unlink(segment)
    return found.st_size


def _is_own(found: os.stat_result) -> bool:
    return found.st_uid == os.geteuid() and stat.S_ISREG(found.st_mode)
