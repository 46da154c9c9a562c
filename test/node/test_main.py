# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How the node's command refuses to start: exit code 1 and one line, never a traceback."""

import os
import subprocess
import sys

from command import cloth_sim
from node_process import NodeProcess
import pytest
import yaml

BAD_PARAMETERS = {
    'unknown name': ({'stiffness.sheer': 1.0}, 'did you mean stiffness.shear?'),
    'unknown name of the node': ({'publish.rates': 1.0}, 'did you mean publish.rate?'),
    'word for a number': ({'width': 'wide'}, "width must be a number, got 'wide'"),
    'empty list for a number': ({'rows': []}, 'rows must be a whole number'),
    'out of range': ({'rows': 0}, 'give a value from 1 to 8192'),
    'not a number': ({'dt': float('nan')}, 'dt must be finite, got nan'),
    'too few components': ({'gravity': [0.0, -9.81]}, 'gravity needs 3 components, got 2'),
    'unknown preset': ({'preset': 'quick'}, "none, fast, balanced, accurate, stiff, got 'quick'"),
    'unknown mode': ({'mode': 'fluid'}, "one of mass_spring, constraint, adaptive, got 'fluid'"),
    'unstable': ({'dt': 0.5, 'auto_substeps': False}, 'or auto_substeps: true'),
    'too large for the device': ({'rows': 8192, 'cols': 8192}, 'use up to about'),
    'two weights': ({'total_mass': 0.3, 'areal_density': 0.2}, 'total_mass 0.3 and areal_density '
                    '0.2 each set the mass of the cloth: give one of them'),
    'pin off the cloth': ({'pin_points.positions': [0.0, 0.0, 1.4]}, 'no node is within'),
    'two sources of time': ({'time.source': 'ros', 'time.epoch': 'wall'}, 'time.source: ros takes '
                            'stamps from /clock and time.epoch: wall sets them: leave'),
    'its own clock to follow': ({'time.source': 'ros', 'publish.clock': True}, 'time.source: ros '
                                'follows /clock and publish.clock: true publishes it: set'),
    'a clock not to be used': ({'time.source': 'ros', 'use_sim_time': False}, 'time.source: ros '
                               'follows /clock and use_sim_time is false: leave'),
    'no body to follow': ({'tf.follow': ['hand=tool0']}, "tf.follow has 'hand=tool0', and needs "
                          'NAME=FRAME with one grasp or collider of the scene: give one of none'),
    'nothing to follow with': ({'tf.follow': ['a=b'], 'tf.listen': False}, 'tf.follow needs the '
                               'frames on /tf and tf.listen is false: leave'),
    'mixed list': ({'gravity': [0, 0, -9.81]}, 'write lists of numbers alike'),
}

WITHOUT_MCAP = (
    'import sys; sys.modules["mcap"] = sys.modules["rosbags"] = None; '
    'from cloth_sim_ros.node.main import main; sys.exit(main())')


# Start a node in each folder: forked, so that what it imports is there already.
IN_TURN = """
import os, sys
import cloth_sim_ros.node.process
from cloth_sim_ros.node.main import main
codes = []
for folder in sys.argv[1:]:
    child = os.fork()
    if not child:
        code = 70
        try:
            os.chdir(folder)
            log = os.open('node.log', os.O_WRONLY | os.O_CREAT)
            os.dup2(log, 1)
            os.dup2(log, 2)
            code = main(['cloth_sim_node', '--ros-args', '--params-file', 'parameters.yaml'])
        except BaseException:
            sys.excepthook(*sys.exc_info())
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
    codes.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
print(*codes)
"""


def only_line(code, output):
    """Return the only line of a node that did not start."""
    lines = output.strip().splitlines()
    assert code == 1, output
    assert len(lines) == 1, output
    assert lines[0].startswith('cloth_sim_node: ')
    return lines[0]


def refusal(node: NodeProcess) -> str:
    """Return the only line of a node that did not start."""
    with node:
        code = node.wait()
    return only_line(code, node.output)


@pytest.fixture(scope='module')
def started_badly(tmp_path_factory):
    """Start nodes with bad parameters; return exit code and output of each."""
    folder = tmp_path_factory.mktemp('bad')
    for number, (parameters, _) in enumerate(BAD_PARAMETERS.values()):
        (folder / str(number)).mkdir()
        (folder / str(number) / 'parameters.yaml').write_text(
            yaml.safe_dump({'/**': {'ros__parameters': parameters}}))
    folders = [str(folder / str(number)) for number in range(len(BAD_PARAMETERS))]
    done = subprocess.run(
        [sys.executable, '-c', IN_TURN, *folders], capture_output=True, text=True, timeout=600,
        env={**os.environ, 'OPENBLAS_NUM_THREADS': '1'})
    assert done.returncode == 0, done.stderr
    return {
        case: (int(code), (folder / str(number) / 'node.log').read_text())
        for number, (case, code) in enumerate(zip(BAD_PARAMETERS, done.stdout.split()))}


@pytest.mark.parametrize('case', BAD_PARAMETERS)
def test_refuses_bad_parameters(case, started_badly):
    """A parameter file with a mistake would be run as if it had none, or end in a traceback."""
    assert BAD_PARAMETERS[case][1] in only_line(*started_badly[case])


@pytest.mark.parametrize('arguments, reason', [
    (('--params-file', 'nowhere.yaml'), 'Error opening YAML file'),
    (('-p', 'rows'), 'cannot be read'),
    (('--unknown-flag',), '--unknown-flag'),
])
def test_refuses_bad_ros_arguments(arguments, reason, tmp_path):
    """A mistyped command line would end in a traceback."""
    assert reason in refusal(NodeProcess(tmp_path, {}, *arguments))


def test_refuses_to_lose_the_recording_asked_for(tmp_path):
    """A node told to record would run on without recording."""
    (tmp_path / 'taken').write_text('a file, not a folder')
    text = refusal(NodeProcess(tmp_path, {
        'recording.enabled': True, 'recording.directory': 'taken/bags'}))
    assert 'set recording.directory' in text


def test_refuses_to_record_without_what_writes_recordings(tmp_path):
    """A node told to record would run on without recording, or end in a traceback."""
    text = refusal(NodeProcess(
        tmp_path, {'recording.enabled': True, 'recording.directory': 'bags'},
        start=WITHOUT_MCAP))
    assert 'pip install mcap rosbags' in text


def test_says_that_there_is_no_device(tmp_path):
    """A machine without a GL device would give a traceback of the GL library."""
    nowhere = str(tmp_path / 'nowhere')
    text = refusal(NodeProcess(tmp_path, environment={
        '__EGL_VENDOR_LIBRARY_DIRS': nowhere, '__EGL_VENDOR_LIBRARY_FILENAMES': nowhere}))
    assert 'there is no EGL device' in text


@pytest.mark.parametrize('module, reason', [
    ('cloth_sim_interfaces', 'src/cloth_sim_interfaces && colcon build'),
    ('rclpy', 'source /opt/ros/jazzy/setup.bash'),
])
def test_says_how_to_get_what_is_missing(module, reason, tmp_path):
    """A half installed node would end in a traceback about imports."""
    start = (
        f'import sys; sys.modules["{module}"] = None; '
        'from cloth_sim_ros.node.main import main; sys.exit(main())')
    assert reason in refusal(NodeProcess(tmp_path, start=start))


def test_says_what_ros_refuses(tmp_path):
    """Who secures the graph without keys, or without a ROS for it, would get a traceback."""
    secured = {
        'ROS_SECURITY_ENABLE': 'true', 'ROS_SECURITY_STRATEGY': 'Enforce',
        'ROS_SECURITY_KEYSTORE': str(tmp_path / 'nowhere')}
    text = refusal(NodeProcess(tmp_path, environment=secured))
    assert 'ROS cannot create a node: SECURITY ERROR' in text
    assert 'unset ROS_SECURITY_ENABLE' in text
    verb = cloth_sim('pause', env={**os.environ, **secured})
    assert verb.returncode == 1 and len(verb.stderr.splitlines()) == 1
    assert 'ROS cannot create a node: SECURITY ERROR' in verb.stderr
