# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""SIGINT at any moment, with requests under way: exit code 0, and every recording is whole."""

from collections.abc import Callable
from pathlib import Path
import random
import re
from signal import SIGINT
import time
from typing import Any

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.recording.bag_reader import BagReader
from geometry_msgs.msg import Vector3
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

NODE = '/interrupts/cloth_sim'
# What goes wrong in a library of ROS that is being shut down, or in Python.
WRONG = re.compile(r'Traceback|unexpected|Exception|Error|\[ERROR\]|\[FATAL\]')
FRAME_TOPICS = ('points', 'stats', 'pins/wrenches', 'pins/peak_wrenches')
MODES = ('mass_spring', 'constraint')


def requests(drawn: random.Random) -> dict[str, tuple[type, dict[str, Any]]]:
    """Return requests by service."""
    wanted = Parameter('real_time_factor', value=drawn.choice([0.0, 1.0])).to_parameter_msg()
    return {
        'set_mode': (SetMode, {'mode': drawn.choice(MODES), 'wait': True}),
        'set_pin': (SetPin, {'row': 5, 'col': 5, 'release': drawn.random() < 0.5}),
        'apply_push': (ApplyPush, {'force': Vector3(z=0.01), 'duration': 0.1}),
        'reset': (Trigger, {}),
        'pause': (SetBool, {'data': drawn.random() < 0.2}),
        'step': (Step, {'steps': 1000}),
        'start_recording': (StartRecording, {}),
        'stop_recording': (Trigger, {}),
        'set_parameters_atomically': (SetParametersAtomically, {'parameters': [wanted]})}


def check_recording(path: Path) -> int:
    """Return how many frames the recording has, each of which has to be whole."""
    reader = BagReader(path)
    assert reader.problems == []
    per_frame: dict[str, list[Any]] = {key: [] for key in FRAME_TOPICS}
    for key, stamps in per_frame.items():
        for raw in reader.messages([f'{NODE}/{key}']):
            stamp = reader.decode(raw).header.stamp
            stamps.append((stamp.sec, stamp.nanosec))
    frames = per_frame['stats']
    assert per_frame['points'] == frames
    wrenches = per_frame['pins/wrenches']
    assert wrenches == per_frame['pins/peak_wrenches']
    # In the first frame, forces of the step before may be unknown. The cloth has two pins or more.
    assert set(frames[1:]) <= set(wrenches) <= set(frames)
    assert all(wrenches.count(stamp) >= 2 for stamp in frames[1:][-5:])
    return len(frames)


@pytest.mark.parametrize('rounds', [5, pytest.param(30, marks=pytest.mark.long)])
def test_an_interrupt_at_any_moment_leaves_a_whole_recording(
        client: GraphClient, tmp_path: Path, rounds: int, seed: int):
    """A node under a launch file would end with a trace, or leave half a frame behind."""
    drawn = random.Random(seed)
    recorded = 0
    for number in range(rounds):
        folder = tmp_path / str(number)
        values = {
            'rows': drawn.choice([8, 48]), 'cols': 16, 'mode': drawn.choice(MODES),
            'real_time_factor': drawn.choice([0.0, 1.0]), 'recording.enabled': True}
        with NodeProcess(folder, values, '-r', '__ns:=/interrupts') as node:
            # The first one runs, so that there is a frame.
            if number and drawn.random() < 0.3:
                # Before, the process ends by the signal, and leaves nothing.
                client.spin_until(
                    lambda folder=folder: (folder / 'bags').exists(), 'it records')
                time.sleep(drawn.uniform(0.0, 1.0))
            else:
                spin_and_ask(client, drawn, lambda node=node: ' nodes in mode ' in node.output)
            node.send(SIGINT)
            code = node.wait()
            assert code == 0, (values, node.output)
            assert not WRONG.search(node.output), (values, node.output)
        for path in folder.glob('bags/*'):
            recorded += check_recording(path)
    assert recorded > 0


def spin_and_ask(client: GraphClient, drawn: random.Random, runs: Callable[[], bool]) -> None:
    """Ask the node for this and that once it runs, and return while some of it is under way."""
    client.spin_until(runs, 'the node runs')
    with client.passing():
        known = requests(drawn)
        names = drawn.sample(sorted(known), 5)
        for name in names:
            client.service(known[name][0], f'{NODE}/{name}')
        client.spin_for(drawn.uniform(0.0, 0.5))
        for _ in range(drawn.randrange(10)):
            name = drawn.choice(names)
            kind, fields = requests(drawn)[name]
            client.service(kind, f'{NODE}/{name}').call_async(kind.Request(**fields))
            client.spin_for(drawn.uniform(0.0, 0.05))
