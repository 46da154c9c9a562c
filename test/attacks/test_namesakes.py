# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Two nodes of one name: each request gets an answer, and both say what is wrong."""

import signal

from cloth_sim_interfaces.srv import ApplyPush
from graph_client import GraphClient
from node_process import NodeProcess
from std_srvs.srv import SetBool

SCENE = {'rows': 4, 'cols': 4}
NAME = '/twice/cloth_sim'
TOLD = f'another node is also named {NAME}: both execute each request'


def test_both_warn_and_every_request_is_answered(tmp_path):
    """A user would not learn why a cloth is pushed that nobody looks at, or a node would hang."""
    nodes = [NodeProcess(tmp_path / name, SCENE, '-r', '__ns:=/twice') for name in 'ab']
    with GraphClient() as client, nodes[0] as first, nodes[1] as second:
        client.spin_until(
            lambda: all(TOLD in node.output for node in nodes), 'both nodes warn')
        client.service(ApplyPush, f'{NAME}/apply_push')
        assert client.call_until_answered(SetBool, f'{NAME}/pause', data=True).success
        for number in range(20):
            assert client.call(SetBool, f'{NAME}/pause', data=number % 2 == 0).success
            refused = client.call(ApplyPush, f'{NAME}/apply_push', duration=-1.0)
            assert not refused.success and 'duration' in refused.message
        assert first.running and second.running
        assert all(node.output.count(TOLD) == 1 for node in nodes), 'once is enough'
        second.send(signal.SIGKILL)
        second.wait()
        # The one that is left answers as ever.
        for _ in range(5):
            assert client.call(SetBool, f'{NAME}/pause', data=True).success
