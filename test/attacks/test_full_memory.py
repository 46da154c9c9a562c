# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A /dev/shm that is full, or smaller than what the middleware takes of it by itself."""

import os
import subprocess
import sys

from cloth_sim_ros.node.shared_memory import VARIABLE
import pytest

# In a mount namespace of its own, with a /dev/shm of this size [KiB].
_PRIVATE = ('unshare', '--mount', 'bash', '-c')
_MOUNT = 'mount -t tmpfs -o size=$0k tmpfs /dev/shm || exit 99\n'
# What a node says of itself, what a verb says of it, and how both end.
_TRIAL = _MOUNT + """
"$1" -m cloth_sim_ros.node --ros-args -p rows:=4 -p cols:=4 -r __ns:=/full &
node=$!
"$1" -m cloth_sim_ros.verb status --node full/cloth_sim --timeout 100
echo "status ended with $?"
kill -INT $node
wait $node
echo "node ended with $?"
"""
_FULL = _MOUNT + """
head -c 1M /dev/zero > /dev/shm/filler 2>/dev/null
for module in "node" "verb status" "verb pause" "verb play bags/example"; do
  "$1" -m cloth_sim_ros.$module
  echo "$module ended with $?"
done
"$1" -m cloth_sim_ros.verb run config/towel.yaml --set rows=4 --set cols=4 --seconds 0.1
echo "run ended with $?"
"""
SIZES = [8, 64, 600, *(
    pytest.param(size, marks=pytest.mark.long)
    for size in (12, 16, 24, 100, 300, 540, 548, 552, 560, 604, 608, 656, 800, 1020, 1200, 1600))]


def _in_private_memory(size: int, script: str) -> str:
    """Return what ``script`` prints where /dev/shm has ``size`` KiB."""
    environment = {key: value for key, value in os.environ.items() if key != VARIABLE}
    done = subprocess.run(
        [*_PRIVATE, script, str(size), sys.executable], env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300.0)
    return done.stdout


needs_mounts = pytest.mark.skipif(
    subprocess.run([*_PRIVATE, _MOUNT, '64'], capture_output=True).returncode != 0,
    reason='only root with the right to mount has a /dev/shm of another size')


@needs_mounts
@pytest.mark.parametrize('size', SIZES)
def test_less_room_than_a_segment_is_told(discovery: None, size: int):
    """Node and verbs would end with SIGBUS and nothing in the log."""
    told = _in_private_memory(size, _TRIAL)
    assert 'status ended with 0' in told and 'node ended with 0' in told, told
    assert '4 x 4 nodes in mode' in told, told
    assert '/dev/shm has' in told and 'raise --shm-size of a container' in told, told
    assert 'Traceback' not in told, told


@needs_mounts
def test_a_full_memory_is_refused_in_a_line():
    """Loading ROS would end every process with SIGBUS, and nobody know why."""
    told = _in_private_memory(4, _FULL)
    for module in ('node', 'verb status', 'verb pause', 'verb play bags/example'):
        assert f'{module} ended with 1' in told, told
    assert told.count('/dev/shm is full') == 4 and 'Traceback' not in told, told
    # What needs no ROS runs.
    assert 'run ended with 0' in told, told
