# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""Shared memory that large clouds fit into, brought along by the process that sends them."""

from collections.abc import MutableMapping
import os
from pathlib import Path
import shutil

from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.snapshot import POINT_DTYPE

VARIABLE = 'FASTRTPS_DEFAULT_PROFILES_FILE'
_MIB = 1 << 20
# Segment [bytes] and profile of Fast DDS. Twice the segment must be free: others need some, too.
_PROFILES = (
    (128 * _MIB, 'fastdds_large_messages.xml'), (16 * _MIB, 'fastdds_large_messages_16_mib.xml'))
_FAST_DDS = ('', 'rmw_fastrtps_cpp', 'rmw_fastrtps_dynamic_cpp')
# What Fast DDS takes by itself [bytes]: larger messages are lost to best-effort subscribers.
_DEFAULT_SEGMENT = 512 << 10


def use_profile(
        environment: MutableMapping[str, str] = os.environ, free: int | None = None) -> str:
    """
    Name a profile with enough shared memory to Fast DDS, unless the user has chosen otherwise.

    It is read when ROS starts, and so has to be named before. Who calls again changes nothing.

    :param free: room in /dev/shm [bytes]; by default what there is
    :return: why there is not enough, with the way out; empty when there is
    """
    implementation = environment.get('RMW_IMPLEMENTATION', '')
    if implementation not in _FAST_DDS:
        return (
            f'{implementation} takes no profile of Fast DDS: give it larger buffers, or set '
            'RMW_IMPLEMENTATION=rmw_fastrtps_cpp')
    if VARIABLE in environment:
        return _lack_of(environment[VARIABLE])
    transports = environment.get('FASTDDS_BUILTIN_TRANSPORTS', 'DEFAULT')
    if transports != 'DEFAULT':
        return '' if transports.startswith('LARGE_DATA') else (
            f'FASTDDS_BUILTIN_TRANSPORTS is {transports}: unset it, or set LARGE_DATA')
    free = _free_memory() if free is None else free
    for segment, name in _PROFILES:
        if free >= 2 * segment:
            environment[VARIABLE] = str(shared_directory('config') / name)
            return ''
    return (
        f'/dev/shm has {free // _MIB} MiB free and {2 * segment // _MIB} are needed: make room, '
        'in a container with --shm-size')


def lost_clouds(nodes: int, lack: str) -> str:
    """
    Return what to say of clouds that best-effort subscribers will miss; empty when of none.

    :param nodes: of the cloth
    :param lack: what use_profile returned
    """
    size = nodes * POINT_DTYPE.itemsize
    if not lack or size <= _DEFAULT_SEGMENT:
        return ''
    return (
        f'a cloud has {size / 1e6:.2g} MB and Fast DDS {_DEFAULT_SEGMENT / 1e6:.2g} MB of shared '
        f'memory, so best-effort subscribers will miss some; subscribe reliably, or mend this: '
        f'{lack}')


def _lack_of(profile: str) -> str:
    """Return what a profile lacks that somebody has chosen."""
    if not profile:
        return f'{VARIABLE} is empty: unset it'
    try:
        text = Path(profile).read_text(encoding='utf-8', errors='replace')
    except OSError:
        text = ''
    if 'segment_size' in text:
        return ''
    name = _PROFILES[-1][1]
    return (
        f'{VARIABLE} names {profile}, which has no segment_size: unset it, or give the profile '
        f'one as config/{name} does')


def _free_memory() -> int:
    try:
        return shutil.disk_usage('/dev/shm').free
    except OSError:
        return 0
