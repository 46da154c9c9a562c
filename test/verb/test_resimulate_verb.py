# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim resimulate` as a user runs it, without a node."""

from collections.abc import Callable
import json
from pathlib import Path

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.messages.inputs import serialise_parameter_event
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.verb.main import main
from command import cloth_sim
from made_again import Director
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterEvent
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message

SCENE = {'rows': 6, 'cols': 7}


@pytest.fixture
def bag(tmp_path) -> Path:
    """Record a short run with a push and a switch of the mode."""
    with Director(tmp_path, SCENE) as director:
        director.step(4)
        director.simulation.push((0.0, 0.0, 1.0), duration=0.1)
        director.simulation.set_mode('adaptive')
        director.step(6)
    return director.path


@pytest.fixture
def again(capsys) -> Callable[..., tuple[int, list[str], str]]:
    """Return a function that runs the verb and returns exit code, lines and errors."""
    def run(*arguments: str | Path) -> tuple[int, list[str], str]:
        capsys.readouterr()
        code = main(['resimulate', *map(str, arguments)])
        out, errors = capsys.readouterr()
        return code, out.splitlines(), errors

    return run


def test_a_cloth_by_weight_and_points_is_made_again(tmp_path, again):
    """The run again would have the default weight or pins, or add them to those given."""
    scene = Path(__file__).parents[2] / 'config' / 'towel.yaml'
    assert main([
        'run', str(scene), '--set', 'rows=10', '--set', 'cols=6', '--set', 'total_mass=0.25',
        '--set', 'pin_points.positions=[-0.22, 0.45, 1, 0.22, 0.05, 1]', '--seconds', '0.1',
        '--record', str(tmp_path), '--set', 'recording.name=towel', '--out',
        str(tmp_path / 'state.npz')]) == 0
    with np.load(tmp_path / 'state.npz') as state:
        assert np.argwhere(state['flags'] & FLAG_PINNED).tolist() == [[0, 0], [4, 5]]
    assert again(tmp_path / 'towel')[:2] == (0, ['6 of 6 frames bitwise identical'])


def test_a_batch_run_is_made_again(tmp_path, again):
    """A run without a node could not be made again, or not without ROS."""
    scene = Path(__file__).parents[2] / 'config' / 'curtain.yaml'
    assert main([
        'run', str(scene), '--set', 'rows=12', '--set', 'pushes.start=[0.1, 0.22]', '--seconds',
        '0.3', '--record', str(tmp_path), '--set', 'recording.name=batch']) == 0
    assert again(tmp_path / 'batch')[:2] == (0, ['16 of 16 frames bitwise identical'])
    blocked = (
        'import sys\n'
        'for name in ("rclpy", "cloth_sim_interfaces", "sensor_msgs"): sys.modules[name] = None')
    done = cloth_sim('resimulate', str(tmp_path / 'batch'), before=blocked)
    assert (done.returncode, done.stdout) == (
        0, '16 of 16 frames bitwise identical\n'), done.stderr


def test_other_settings_are_said_and_recorded(bag, again, tmp_path):
    """A user would take another experiment for the recorded one, or not find the new run."""
    code, lines, _ = again(bag, '--set', 'mode=constraint', '--out', tmp_path / 'new')
    assert code == 0
    assert lines[0] == '1 of 3 frames bitwise identical'
    assert lines[1].startswith('first difference: frame 2 (t = 0.02 s), node (')
    assert 'bits may differ: mode set to other values' in lines
    assert lines[-2].startswith('left out: 1 recorded switches of the mode, because --set mode')
    new = tmp_path / 'new' / f'{bag.name}_again'
    assert lines[-1] == f'recorded into {new}'
    assert [frame.time for frame in read_frames(Recording(new))] == [0.0, 0.02, 0.05]
    code, lines, _ = again(bag, '--out', tmp_path / 'new')
    assert lines[-1] == f'recorded into {new}_1'


def test_a_run_that_does_not_come_out_again_is_a_failure(tmp_path, again):
    """A script would not notice that a run no longer has its bits."""
    with Director(tmp_path, SCENE) as director:
        director.step(4)
        now = director.simulation.snapshot()
        positions = now.positions.copy()
        positions[2, 3, 1] += 1.0
        director.set_state_unrecorded(positions, now.velocities)
        director.step(0)
    code, lines, _ = again(director.path)
    assert code == 1
    assert lines[0] == '2 of 3 frames bitwise identical'
    assert lines[1].startswith('first difference: frame 3 (t = 0.02 s), node (2, 3), 1 m apart; y')
    assert lines[-1].startswith('this run should be bitwise identical')


def test_both_runs_are_compared(bag, again, tmp_path):
    """A user would have to look for the new recording to compare it."""
    changes = ['--set', 'mode=constraint']
    code, lines, _ = again(bag, *changes, '--compare', '--out', tmp_path / 'new')
    assert code == 0
    assert any(line.startswith('compared ') for line in lines)
    compared = tmp_path / 'new' / f'{bag.name}_again_compared'
    assert (compared / 'comparison.json').is_file()
    first, = json.loads((compared / 'comparison.json').read_text())
    assert isinstance(first, dict)
    before = set(tmp_path.rglob('*'))
    code, lines, _ = again(bag, *changes, '--compare')
    assert code == 0 and any(line.startswith('node distance') for line in lines)
    assert set(tmp_path.rglob('*')) == before


def test_clouds_of_other_sizes_compare_by_figures(bag, again):
    """A comparison of two resolutions would end as an error, or compare other nodes."""
    code, lines, _ = again(bag, '--set', 'rows=9', '--compare')
    assert code == 0
    assert lines[0].startswith('3 frames have another grid than the 9 x 7 of this run')
    assert sum('max strain' in line for line in lines) == 2
    assert 'cannot be compared node by node' in lines[-1]


def test_another_version_is_named(bag, again):
    """A user would look for a mistake where the simulator has changed."""
    metadata = bag / 'metadata.yaml'
    text = metadata.read_text()
    named = f'cloth_sim_ros: {project_version()}'
    assert named in text
    metadata.write_text(text.replace(named, 'cloth_sim_ros: 9.9.9'))
    code, lines, _ = again(bag, '--set', 'gravity=[0.0, 0.0, -1.0]')
    assert code == 0
    named = (
        'bits may differ: recorded by version 9.9.9 of cloth_sim_ros, this is version '
        f'{project_version()}')
    assert named in lines
    assert again(bag)[1] == ['3 of 3 frames bitwise identical', named]


def rewritten(bag: Path, change: Callable[[str, bytes], bytes | None]) -> Path:
    """Return a copy of a recording whose messages went through ``change``."""
    recorder = Recorder(bag.parent, 'rewritten', 'cloth_sim')
    for raw in Recording(bag).raw_messages():
        key = raw.topic.removeprefix('/cloth_sim').lstrip('/')
        data = change(key, bytes(raw.data))
        if data is not None:
            recorder.write(key, data, raw.time * 1e-9)
    recorder.close()
    return recorder.path


def test_what_another_version_lacks_is_named(bag, again):
    """A user would not learn that the run rests on defaults, or lacks what nobody knows here."""
    def change(key, data):
        if key != 'inputs/parameters':
            return data
        event = deserialize_message(data, ParameterEvent)
        event.new_parameters = [
            parameter for parameter in event.new_parameters
            if parameter.name != 'adaptive.scheme'] + [Parameter(name='fabric.colour')]
        return serialise_parameter_event(event)

    path = rewritten(bag, change)
    code, lines, _ = again(path)
    assert (code, lines) == (0, [
        '3 of 3 frames bitwise identical',
        "not recorded, so the default is used: adaptive.scheme 'constraint'",
        'recorded, but unknown here and left out: fabric.colour'])
    assert 'not recorded' not in ''.join(again(path, '--set', 'adaptive.scheme=constraint')[1])


def test_another_device_is_named(bag, again):
    """Bits would be expected from a device that rounds otherwise."""
    def change(key, data):
        if key != 'state':
            return data
        state = deserialize_message(data, ClothState)
        state.device = 'GPU of somebody'
        return serialize_message(state)

    lines = again(rewritten(bag, change))[1]
    assert lines[1].startswith('bits may differ: recorded on GPU of somebody, this is')


def test_a_recording_without_points_is_made_again(bag, again, tmp_path):
    """What was recorded without points would be lost."""
    path = rewritten(bag, lambda key, data: None if key == 'points' else data)
    code, lines, _ = again(path, '--out', tmp_path / 'new')
    assert code == 0
    assert lines[0] == 'no frame was recorded, so there is nothing to compare with'
    new = Recording(tmp_path / 'new' / 'rewritten_again')
    assert [frame.time for frame in read_frames(new)] == [0.0, 0.02, 0.05]


@pytest.mark.parametrize(('arguments', 'message'), [
    (['--set', 'rwos=3'], 'there is no parameter rwos: did you mean rows?'),
    (['--set', 'dt=0.0'], 'dt 0.0 is outside its range'),
    (['--set', 'publish.rate=10.0'], 'publish.rate is not a scene parameter'),
    (['--node', 'other'], 'holds no frame of the node /other'),
    (['--out', '/proc/nothing'], '/proc/nothing'),
    (['--set', 'rows=9000'], 'rows 9000 is outside its range'),
])
def test_what_is_wrong_is_said_in_one_line(bag, again, arguments, message):
    """The user would get a traceback."""
    code, _, errors = again(bag, *arguments)
    assert code == 1
    assert message in errors.splitlines()[-1]


@pytest.mark.parametrize('content', [b'', b'no bag', bytes(range(256)) * 9])
def test_what_is_no_recording_is_refused(tmp_path, again, content):
    """A foreign file would end as a traceback."""
    file = tmp_path / 'foreign_0.mcap'
    file.write_bytes(content)
    code, lines, errors = again(file)
    assert (code, lines) == (1, [])
    assert 'foreign_0.mcap' in errors
    assert again(tmp_path / 'nowhere')[0] == 1
