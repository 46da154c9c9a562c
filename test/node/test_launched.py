# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A node started by `ros2 launch`, where ROS has that command."""

from pathlib import Path
import shutil
import signal
import subprocess

from clock_teller import ClockTeller
from clock_teller import in_nanoseconds
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from node_process import PATIENCE
import pytest
from recorded import Recorded
from tf2_msgs.msg import TFMessage
import yaml

ROOT = Path(__file__).resolve().parents[2]
# Wheels of ROS have no launch system; a sourced ROS has.
pytest.importorskip('ros2launch')


def test_a_cloth_is_put_into_a_larger_system(client, tmp_path):
    """A user would have to write launch files first, or the cloth be of another time and place."""
    values, begin = {**SCENE, 'mode': 'mass_spring'}, 1000 * NANOSECONDS
    scene = tmp_path / 'scene.yaml'
    scene.write_text(yaml.safe_dump({'/**': {'ros__parameters': values}}))
    with (tmp_path / 'launch.log').open('w') as log:
        process = subprocess.Popen([
            shutil.which('ros2'), 'launch', str(ROOT / 'launch' / 'beside_simulator.launch.py'),
            f'params_file:={scene}', 'namespace:=hall', 'parent:=table', 'x:=0.4',
            'recording:=true'], cwd=tmp_path, stdout=log, stderr=subprocess.STDOUT)
    try:
        cloth = ClothUnderTest(client, values, '/hall/cloth_sim')
        places = client.watch(TFMessage, '/tf_static', kept=True)
        with ClockTeller(client, begin) as clock:
            clock.tell_until(lambda: any(
                state.recording for state in cloth['state']), 'it records')
            clock.run(0.2, 0.01, 1.0)
            clock.tell_until(lambda: any(
                in_nanoseconds(cloud.header.stamp) > begin for cloud in cloth['points']),
                'it runs')
        assert {cloud.header.frame_id for cloud in cloth['points']} == {'cloth'}
        assert [(each.header.frame_id, each.transform.translation.x)
                for message in places.messages for each in message.transforms
                if each.child_frame_id == 'cloth'] == [('table', 0.4)]
    finally:
        # Killed, it would leave its processes behind.
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 0, (tmp_path / 'launch.log').read_text()
    recording, = (tmp_path / 'bags').iterdir()
    assert all(time >= begin for _, time, _ in Recorded(recording).entries)
