# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The recorded parameters, of this version and of others."""

from cloth_sim_ros.messages.inputs import parameter_value
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.resimulation.recorded_run import recorded_version
from cloth_sim_ros.resimulation.recorded_run import RecordedScene
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import Field
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.scene import Scene
import pytest
from rcl_interfaces.msg import Parameter
from rosbags.rosbag2 import Reader
from springs import SPRINGS

FIELDS = SCENE_FIELDS + NODE_FIELDS


@pytest.fixture
def bag(tmp_path):
    """Return the folder of a recording."""
    recorder = Recorder(tmp_path, 'made', 'cloth_sim')
    recorder.write('points', b'\x00\x01\x00\x00', 0.0)
    recorder.close()
    return recorder.path


def test_a_recording_names_its_version(bag):
    """Runs of two versions would be compared without a word."""
    assert project_version()
    assert recorded_version(bag) == recorded_version(bag / 'made_0.mcap') == project_version()


def test_other_readers_take_it(bag):
    """A recording could not be opened because of what only this project needs."""
    with Reader(bag) as reader:
        assert reader.message_count == 1


@pytest.mark.parametrize('text', [
    '', '[1, 2]', 'a: [', 'rosbag2_bagfile_information: 3', b'\xff\xfe\x00',
    'rosbag2_bagfile_information: {custom_data: null}',
    'rosbag2_bagfile_information: {custom_data: {cloth_sim_ros: 1.0}}'])
def test_foreign_metadata_name_none(bag, text):
    """A foreign recording would end as a traceback."""
    data = text if isinstance(text, bytes) else text.encode()
    (bag / 'metadata.yaml').write_bytes(data)
    assert recorded_version(bag) == ''


def test_a_recording_without_metadata_names_none(bag):
    """A recording that lost its metadata would end as a traceback."""
    (bag / 'metadata.yaml').unlink()
    assert recorded_version(bag) == ''


def recorded(mode='', without=(), **values):
    """Return the scene of a recording; __ in a name stands for a dot."""
    given = {name.replace('__', '.'): value for name, value in values.items()}
    message = parameters_message(
        {field.name: given.get(field.name, field.default) for field in FIELDS
         if field.name not in without}, FIELDS, 0.0, 'cloth_sim')
    return RecordedScene.from_parameters(message.new_parameters, mode)


def test_every_parameter_comes_back():
    """A value would change its type or its digits, and the run its bits."""
    values = {
        'rows': 7, 'dt': 1 / 300, 'pins': ('1,2', 'top_edge'), 'auto_substeps': False,
        'substeps': 9, 'pushes.start': (0.1, 1 / 3), 'pushes.duration': (0.1, 0.2),
        'pushes.force': (0.1,) * 6}
    scene = recorded(**values)
    assert scene.scene().values == Scene({**SPRINGS, **values}).values
    assert (scene.missing, scene.unknown(NODE_FIELDS)) == ((), ())
    assert scene.changed(scene.scene()) == ()


def test_the_mode_of_the_beginning_counts():
    """A run that had been switched before it was recorded would begin in another mode."""
    assert recorded(mode='adaptive').scene()['mode'] == 'adaptive'


def test_changes_are_named():
    """Other settings would be taken for the recorded ones."""
    scene = recorded(dt=0.01)
    made = scene.scene({'dt': 0.02, 'rows': 32, 'mode': 'constraint'})
    assert (made['dt'], made['rows'], made['cols']) == (0.02, 32, 32)
    assert set(scene.changed(made)) == {'dt', 'mode'}


def test_what_is_missing_takes_its_default():
    """A recording from before a parameter was there could not be run again."""
    scene = recorded(without=('adaptive.scheme', 'gravity', 'frame_id'), adaptive__threshold=0.2)
    assert [field.name for field in scene.missing] == ['gravity', 'adaptive.scheme']
    assert scene.scene()['gravity'] == (0.0, 0.0, -9.81)
    assert scene.scene()['adaptive.threshold'] == 0.2
    assert scene.other(next(field for field in FIELDS if field.name == 'frame_id')) == 'world'


def test_what_is_unknown_is_named():
    """A parameter of a later version would be passed over without a word, or end it all."""
    drag = Field('fabric.colour', float, 0.0, 'of the air')
    parameters = [Parameter(name='fabric.colour', value=parameter_value(drag, 0.3)),
                  Parameter(name='nothing')]
    scene = RecordedScene.from_parameters(parameters)
    assert scene.unknown(NODE_FIELDS) == ('fabric.colour', 'nothing')
    assert scene.scene().values == Scene().values


def test_value_of_another_version_can_be_replaced():
    """A user would not learn what to do about it."""
    scene = recorded(mode='rigid')
    with pytest.raises(ClothSimError, match=r"'rigid'; replace it with --set mode="):
        scene.scene()
    made = scene.scene({'mode': 'adaptive'})
    assert scene.as_recorded({'mode': 'adaptive', 'dt': 0.1})['dt'] == 0.005
    assert scene.changed(made) == ('mode',)


def test_values_that_are_none_of_their_kind_are_refused():
    """A parameter that changed its type would be taken for something else."""
    parameters = [Parameter(name='dt', value=parameter_value(Field('dt', str, '', ''), 'fast'))]
    with pytest.raises(ClothSimError, match="dt must be a number, got 'fast'"):
        RecordedScene.from_parameters(parameters).scene()
