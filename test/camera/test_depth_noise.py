# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A depth sensor errs by the formula of its source, and only where it is asked to."""

from cloth_sim_ros.camera.depth_noise import measured_depth
from cloth_sim_ros.sim.model.cameras import CameraModel
import numpy as np
import pytest

PLACE = {'position': [0.0, 0.0, 2.0], 'target': [0.0, 0.0, 0.0], 'width': 200, 'height': 150}
BASELINE = 0.075  # [m], of the sensor of the source


def sensor(**noise):
    """Return a camera with that noise."""
    return CameraModel.of('sensor', **PLACE, **{f'noise_{k}': v for k, v in noise.items()})


def test_there_is_none_by_default():
    """Whoever wants the truth would get noise."""
    depth = np.full((150, 200), 1.5, np.float32)
    assert measured_depth(depth, sensor(), 1.0) is depth


@pytest.mark.parametrize('distance', [0.5, 1.0, 3.0])
def test_the_error_grows_with_the_square_of_the_depth(distance):
    """A policy would trust far pixels as much as near ones."""
    camera = sensor(baseline=BASELINE, disparity=0.1, step=0.0)
    depth = np.full((150, 200), distance, np.float32)
    error = measured_depth(depth, camera, 1.0) - distance
    expected = distance**2 * 0.1 / (camera.fx * BASELINE)
    assert error.std() == pytest.approx(expected, rel=0.03)
    assert abs(error.mean()) < 4.0 * expected / np.sqrt(depth.size) + expected**2 / distance


def test_disparities_are_whole_steps():
    """Depth would be finer than a sensor tells it apart."""
    camera = sensor(baseline=BASELINE, disparity=0.5, step=0.125)
    found = measured_depth(np.full((150, 200), 2.0, np.float32), camera, 1.0)
    steps = camera.fx * BASELINE / found.astype(float) / 0.125
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-3)


def test_jumps_are_dropped():
    """The outline of a fold would be sharper than any sensor sees it."""
    depth = np.full((150, 200), 1.0, np.float32)
    depth[:, 100:] = 1.1
    depth[:50] = np.inf
    camera = sensor(baseline=BASELINE, disparity=0.0, step=0.0, edge=0.02)
    found = measured_depth(depth, camera, 1.0)
    dropped = np.isnan(found)
    assert dropped[50:, 99:101].all() and dropped[50].all() and dropped.sum() == 200 + 2 * 99
    assert np.isposinf(found[:50]).all()
    np.testing.assert_allclose(found[51:, :99], 1.0, rtol=1e-6)


def test_noise_is_that_of_seed_time_and_camera():
    """A run could not be made again, or all its pictures would have the same noise."""
    depth = np.full((150, 200), 1.5, np.float32)
    camera = sensor(baseline=BASELINE)
    first = measured_depth(depth, camera, 1.0)
    np.testing.assert_array_equal(measured_depth(depth, camera, 1.0), first)
    for other, time in ((camera, 1.02), (sensor(baseline=BASELINE, seed=1), 1.0)):
        assert (measured_depth(depth, other, time) != first).mean() > 0.3
