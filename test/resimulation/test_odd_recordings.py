# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recordings of other versions, cut off, without a beginning or in another order."""

from pathlib import Path
import random

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import FrameTarget
from cloth_sim_interfaces.msg import GraspChange
from cloth_sim_interfaces.msg import ModeChange
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from made_again import Director
from made_again import made_again
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Header


def test_inputs_that_cannot_be_given_are_named(tmp_path):
    """A run with other settings would end at the first input that makes no sense there."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        director.step(4)
        director.simulation.pin(7, 7)
        director.simulation.move_pin(7, 7, (0.4, -0.4, 1.0), 0.5)
        director.step(20)
    with made_again(director.path, rows=5) as rerun:
        assert len(rerun.refused) == 2
        assert rerun.refused[0].startswith('at 0.02 s: there is no node (7, 7)')
        assert rerun.simulation.steps == 24


def test_what_only_another_version_knows_is_named(tmp_path):
    """A command or a mode of a later version would be passed over without a word."""
    def header():
        return Header(stamp=Time(nanosec=20_000_000))

    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        director.step(4)
        director.send('inputs/command', Command(header=header(), command='fold'))
        director.send('inputs/mode', ModeChange(header=header(), mode='rigid'))
        director.send('inputs/parameters', parameters_message(
            {'gravity': (0.0, 0.0, 0.0)}, FIELDS, 0.02, 'cloth_sim', is_change=True))
        director.step(4)
    with made_again(director.path) as rerun:
        assert [reason.partition(': ')[2][:38] for reason in rerun.refused] == [
            "this version has no command 'fold': it", "there is no mode 'rigid': choose one o",
            'this version cannot change gravity whi']
        assert rerun.check.equal == 3


def test_grasps_and_moves_that_make_no_sense_are_named(tmp_path):
    """A recording of somebody else would hold other nodes, or end in a traceback."""
    header = Header(stamp=Time(nanosec=20_000_000))
    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        director.step(4)
        for rows, cols in (([1, 2], [1]), ([], []), ([2**32 - 1], [0]), ([0], [0])):
            director.send('inputs/grasp', GraspChange(
                header=header, name='hand', grasped=True, rows=rows, cols=cols))
        director.send('inputs/grasp', GraspChange(header=header, name='hand'))
        director.send('inputs/grasp', GraspChange(header=header, name='hand', by_force=True))
        director.send('inputs/grasp_target', FrameTarget(header=header, name='hand', speed=1.0))
        director.send('inputs/collider_target', FrameTarget(header=header, name='ball'))
        director.step(4)
    with made_again(director.path) as rerun:
        found = [reason.partition(': ')[2] for reason in rerun.refused]
        assert [reason[:30] for reason in found] == [
            'a recorded grasp has 2 rows an', 'a recorded grasp has 0 rows an',
            'there is no node (4294967295, ', 'grasp hand cannot have node (0',
            "there is no grasp 'hand': gras", "there is no collider 'ball': g"]
        assert rerun.check.equal == 3


def test_truncated_recording_resimulates(tmp_path):
    """A run that crashed could not be made again."""
    with Director(tmp_path, {'rows': 64, 'cols': 64, 'pushes.start': (0.01,),
                             'pushes.duration': (0.02,), 'pushes.force': (0, 0, 1)}) as director:
        for _ in range(25):
            director.step(1)
    data = next(director.path.glob('*.mcap')).read_bytes()
    chance = random.Random(3)
    frames = []
    for number in range(8):
        cut = tmp_path / f'cut_{number}' / 'cut_0.mcap'
        cut.parent.mkdir()
        cut.write_bytes(data[:chance.randrange(len(data))])
        try:
            with made_again(cut.parent) as rerun:
                assert rerun.check.equal == rerun.check.frames
                frames.append(rerun.check.frames)
        except ClothSimError:
            frames.append(-1)
    assert max(frames) > 10, frames


def written(folder: Path, *messages) -> Path:
    """Record just these (key, message), all at the time 0."""
    recorder = Recorder(folder, 'made', 'cloth_sim')
    for key, message in messages:
        recorder.write(key, serialize_message(message), 0.0)
    recorder.close()
    return recorder.path


def test_a_recording_without_its_parameters_is_refused(tmp_path):
    """A user would not learn why, and how to record so that it works."""
    path = written(tmp_path, ('inputs/mode', ModeChange(mode='adaptive')))
    with pytest.raises(ClothSimError, match=r'not begin with the parameters.*`ros2 bag record`'):
        with made_again(path):
            pass


def test_another_node_is_refused(tmp_path):
    """A user would not learn of --node."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        director.step(1)
    with pytest.raises(ClothSimError, match='--node'):
        with made_again(director.path, 'other'):
            pass


def test_messages_in_another_order_are_refused(tmp_path):
    """Inputs would be given at the wrong time, and the run be called another one."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        director.step(10)
        director.send('inputs/mode', ModeChange(
            header=Header(stamp=Time(nanosec=10_000_000)), mode='adaptive'))
    with pytest.raises(ClothSimError, match='inputs/mode of 0.01 s after one of 0.05 s'):
        with made_again(director.path):
            pass


def test_the_middle_of_a_run_cannot_change_its_nodes(tmp_path):
    """Nodes would begin at positions of others."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}, lambda cloth: cloth.step(3)) as director:
        director.step(1)
    with pytest.raises(ClothSimError, match='8 x 9 nodes, from which 5 x 9 cannot continue'):
        with made_again(director.path, rows=5):
            pass
