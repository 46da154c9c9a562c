# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A cloud turned back into a cloth."""

from types import SimpleNamespace

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.push import Push
from made_snapshot import make_snapshot
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


def test_flags_that_are_no_whole_numbers_are_refused():
    """A cloud of another program ended `cloth_sim render` with a traceback."""
    names = ('x', 'y', 'z', 'normal_x', 'normal_y', 'normal_z', 'strain', 'flags')
    fields = [
        SimpleNamespace(name=name, offset=4 * number, datatype=7, count=1)
        for number, name in enumerate(names)]
    cloud = SimpleNamespace(
        fields=fields, height=1, width=1, point_step=32, is_bigendian=False, data=bytes(32))
    with pytest.raises(ClothSimError, match='flags of the type float32, which must be whole'):
        Frame.from_points(0.0, cloud)


def test_its_mesh_is_that_of_the_snapshot(known):
    """A mesh of a recording would be of another cloth than the one simulated."""
    entry = next(Recording(known.folder).entries('points'))
    records = known.records[0]
    mesh = Frame.from_points(entry.time, entry.message).mesh()
    expected = make_snapshot(*records.shape, records=records).mesh()
    for name in ('vertices', 'normals', 'uv', 'triangles'):
        np.testing.assert_array_equal(getattr(mesh, name), getattr(expected, name))
