# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Requests of a megabyte get short answers, and leave short lines in the log."""

from pathlib import Path

from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_ros.node.refusals import QUIET
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from command import cloth_sim
from geometry_msgs.msg import PointStamped
from geometry_msgs.msg import Vector3
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from std_msgs.msg import Header

LONG = 'x\x1b' * 500_000
# The most that a command line takes in one argument is 128 KiB.
ARGUMENT = 'x' * 100_000
MOST = 600
NAME = '/long/cloth_sim'
EXAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'example'


def test_a_node_answers_briefly(tmp_path):
    """A request could fill the log, the disk and the terminal of who asks."""
    scene = {**PAUSED, 'recording.directory': str(tmp_path / 'bags')}
    with GraphClient() as client, NodeProcess(tmp_path, scene, '-r', '__ns:=/long') as node:
        cloth = ClothUnderTest(client, scene, NAME)
        for kind, name, fields in (
                (SetMode, 'set_mode', {'mode': LONG}),
                (StartRecording, 'start_recording', {'name': LONG}),
                (ApplyPush, 'apply_push', {
                    'region': LONG, 'force': Vector3(z=1.0), 'duration': 1.0})):
            answer = cloth.call(kind, name, **fields)
            assert not answer.success and 0 < len(answer.message) < MOST, name
        rejected = cloth.set_parameters(mode=LONG)
        assert not rejected.successful and 0 < len(rejected.reason) < MOST
        before = len(node.output)
        far = Header(frame_id=LONG)
        for kind, topic, message in (
                (Push, f'{NAME}/push', Push(header=far, force=Vector3(z=1.0), duration=1.0)),
                (Push, f'{NAME}/push', Push(region=LONG, force=Vector3(z=1.0), duration=1.0)),
                (PinTarget, f'{NAME}/pins/target', PinTarget(header=far)),
                (PointStamped, '/clicked_point', PointStamped(header=far))):
            publisher = client.node.create_publisher(kind, topic, 10)
            client.spin_until(publisher.get_subscription_count, f'{topic} is read')
            lines = len(node.output.splitlines())
            publisher.publish(message)
            client.spin_until(
                lambda: len(node.output.splitlines()) > lines, f'{topic} is warned of')
            client.node.destroy_publisher(publisher)
            client.spin_for(QUIET)  # until the next warning of the same topic is given
        assert len(node.output) - before < 4 * (MOST + 100)


@pytest.mark.parametrize('arguments', [
    ('run', ARGUMENT), ('run', '{scene}', '--set', ARGUMENT), ('info', ARGUMENT),
    ('run', '{scene}', '--set', f'mode={ARGUMENT}'), ('run', '{scene}', '--set', f'{ARGUMENT}=1'),
    ('run', '{scene}', '--set', f'pins=[{ARGUMENT}]'),
    ('run', '{scene}', '--set', f'dt=[{ARGUMENT}'),
    ('run', '{scene}', '--set', f'rows={"9" * 90_000}'), ('run', '{scene}', '--seconds', ARGUMENT),
    ('run', '{scene}', '--record', '{folder}', '--set', f'recording.name={ARGUMENT}'),
    ('pause', '--node', ARGUMENT, '--timeout', '0.1'), ('render', '{folder}', '--size', ARGUMENT),
    ('export', '{folder}', '--at', ARGUMENT), ('export', '{folder}', '--format', ARGUMENT),
    ('export', '{folder}', '--output', ARGUMENT),
    ('export', '{example}', '--output', f'{ARGUMENT}.obj')],
    ids=lambda arguments: ' '.join(argument[:24] for argument in arguments))
def test_a_verb_answers_briefly(arguments, tmp_path):
    """A mistyped command would fill the terminal, or end in a traceback."""
    scene = tmp_path / 'scene.yaml'
    scene.write_text('/**: {ros__parameters: {rows: 4, cols: 4}}')
    result = cloth_sim(*(
        argument.replace('{scene}', str(scene)).replace('{folder}', str(tmp_path))
        .replace('{example}', str(EXAMPLE))
        for argument in arguments))
    assert result.returncode in (1, 2), result.stderr[-2000:]
    assert 'Traceback' not in result.stderr, result.stderr[-2000:]
    told = result.stderr.splitlines()[-1]
    assert len(told) < MOST, f'{len(told)}: {told[:300]}'
