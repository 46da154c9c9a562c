# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording that cannot go on."""

import resource

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from node_process import NodeProcess

SMALL_FILE = 4096


def test_a_full_disk_ends_the_recording_and_nothing_else(client, tmp_path):
    """A full disk would end the simulation, or go unnoticed."""
    with NodeProcess(tmp_path, PAUSED, '-r', '__ns:=/full_disk') as node:
        cloth = ClothUnderTest(client, PAUSED, '/full_disk/cloth_sim')
        path = cloth.call(StartRecording, 'start_recording').path
        _, hard = resource.prlimit(node.pid, resource.RLIMIT_FSIZE)
        # From here on the node can't make any file longer than this.
        resource.prlimit(node.pid, resource.RLIMIT_FSIZE, (SMALL_FILE, hard))
        cloth.client.spin_until(
            lambda: cloth.call(Step, 'step', steps=1).success
            and cloth['state'] and not cloth['state'][-1].recording, 'the end is reported')
        assert path in node.output and 'start a new one' in node.output
        resource.prlimit(node.pid, resource.RLIMIT_FSIZE, (hard, hard))
        told = cloth.wait_for('diagnostics', lambda array: any(
            'start a new one' in status.message for status in array.status))
        assert told
        assert cloth.call(StartRecording, 'start_recording').success
