# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Reading what was recorded, whole or cut off."""

import shutil

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from made_cloud import make_cloud
import numpy as np
import pytest


def test_messages_come_as_they_were_recorded(known):
    """A study would work on other numbers than the simulation made, or in another order."""
    clouds = [entry.message for entry in Recording(known.folder).entries('points')]
    assert len(clouds) == len(known.records)
    for cloud, records in zip(clouds, known.records):
        assert bytes(cloud.data) == records.tobytes()


def test_only_the_topics_asked_for_come(known):
    """A reader would have to sort out, and wait for, what it never asked for."""
    keys = {entry.key for entry in Recording(known.folder).entries('stats', 'inputs/push')}
    assert keys == {'stats', 'inputs/push'}


def test_time_goes_on_over_a_reset(known):
    """Plots would fold back on themselves at a reset."""
    times = [entry.time for entry in Recording(known.folder).entries('points')]
    assert times[0] == 0.0
    assert np.all(np.diff(times) >= 0.0)
    assert times[-1] == pytest.approx(0.38 + 0.1)


def test_a_file_is_as_good_as_its_folder(known):
    """Half of what a user may point at would be refused."""
    file, = known.folder.glob('*.mcap')
    assert len(list(Recording(file).entries('points'))) == len(known.records)


def test_another_node_can_be_read(tmp_path):
    """A recording of a node with a namespace could not be read."""
    recorder = Recorder(tmp_path, 'other', '/left/cloth')
    recorder.write('points', make_cloud(2, 2, 0)[0], 0.0)
    recorder.close()
    assert list(Recording(tmp_path / 'other', 'cloth_sim').entries('points')) == []
    assert len(list(Recording(tmp_path / 'other', '/left/cloth').entries('points'))) == 1
    assert Recording(tmp_path / 'other').node == '/left/cloth'


def test_raw_messages_of_all_topics_can_be_had(known):
    """A player would need a reader of its own."""
    recording = Recording(known.folder)
    raw = list(recording.raw_messages())
    assert {message.topic for message in raw} == {topic.name for topic in recording.topics}
    assert len(raw) == sum(topic.count for topic in recording.topics)
    assert [message.time for message in raw] == sorted(message.time for message in raw)
    stats = [message for message in raw if message.topic == '/cloth_sim/stats']
    decoded = [recording.decode(message).max_strain for message in stats]
    assert decoded == [entry.message.max_strain for entry in recording.entries('stats')]
    assert stats[0].type_name == 'cloth_sim_interfaces/msg/ClothStats'


@pytest.mark.parametrize('share', [0.3, 0.7, 0.99])
def test_a_recording_that_was_cut_off_is_read_up_to_there(tmp_path, share):
    """The recording of a crashed or killed run would be lost."""
    side, count = 64, 30
    recorder = Recorder(tmp_path, 'whole', 'cloth_sim')
    clouds = [make_cloud(side, side, number) for number in range(count)]
    for number, (data, _) in enumerate(clouds):
        recorder.write('points', data, number / 50)
    recorder.close()
    whole, = (tmp_path / 'whole').glob('*.mcap')
    cut = tmp_path / 'cut.mcap'
    cut.write_bytes(whole.read_bytes()[:int(share * whole.stat().st_size)])
    read = list(Recording(cut).entries('points'))
    # Chunks of 1 MiB hold 5 to 6 of these clouds.
    assert len(read) >= share * count - 7
    for entry, (_, records) in zip(read, clouds):
        stored = np.frombuffer(entry.message.data, POINT_DTYPE)
        np.testing.assert_array_equal(stored.view(np.uint32), records.ravel().view(np.uint32))


@pytest.mark.parametrize('content', [None, 'empty', 'other'])
def test_what_is_no_recording_is_refused(tmp_path, known, content):
    """A wrong path would end in a traceback, or in an empty picture."""
    path = tmp_path / 'bag'
    if content == 'empty':
        path.mkdir()
    elif content == 'other':
        path.mkdir()
        shutil.copy(known.folder / 'metadata.yaml', path / 'bag_0.mcap')
    with pytest.raises(ClothSimError, match='bag.*give'):
        list(Recording(path).entries('points'))
