# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A cloud turned back into a cloth."""

from types import SimpleNamespace

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.push import Push
import numpy as np
import pytest


def test_every_field_comes_back(known):
    """A picture would show positions, normals or strain of another place."""
    entry = next(Recording(known.folder).entries('points'))
    frame = Frame.from_points(entry.time, entry.message)
    records = known.records[0]
    np.testing.assert_array_equal(frame.strain, records['strain'])
    for axis, name in enumerate('xyz'):
        np.testing.assert_array_equal(frame.positions[..., axis], records[name])
        np.testing.assert_array_equal(frame.normals[..., axis], records[f'normal_{name}'])


def test_pins_are_told_by_their_flag(hanging):
    """Pins would be drawn where there are none."""
    assert np.argwhere(hanging().pinned).tolist() == [[0, 0], [0, 8]]


def test_another_cloud_is_refused():
    """The cloud of a laser scanner would be drawn as a cloth."""
    field = SimpleNamespace(name='x', offset=0, datatype=7, count=1)
    cloud = SimpleNamespace(
        fields=[field], height=1, width=1, point_step=4, is_bigendian=False, data=bytes(4))
    with pytest.raises(ClothSimError, match='has no field y'):
        Frame.from_points(0.0, cloud)


def test_only_pushes_of_its_time_act(hanging):
    """A picture would show a push that is over, or not yet there."""
    early, late = (
        Push.checked(force=(1.0, 0.0, 0.0), start=start, duration=0.5) for start in (0.0, 0.8))
    assert hanging(1.0, pushes=(early, late)).acting_pushes == (late,)
