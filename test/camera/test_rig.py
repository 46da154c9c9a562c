# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cameras of a scene take pictures at their rate, and only what is asked for."""

from cloth_sim_ros.camera.rig import CameraRig
from cloth_sim_ros.camera.rig import DEPTH
from cloth_sim_ros.camera.rig import INFO
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from seen_cloths import ASIDE
from seen_cloths import FALLING


@pytest.fixture
def simulation():
    """Return a cloth with a camera that stands and one that is attached to a frame."""
    values = {
        **FALLING, 'cameras.names': ['front', 'hand'], 'cameras.front.rate': 30.0,
        'cameras.hand.frame': 'tool0',
        **{f'cameras.front.{name}': value for name, value in ASIDE.items()}}
    with Simulation(Scene(values)) as simulation:
        yield simulation


@pytest.fixture
def rig(simulation):
    """Return its cameras; nobody knows a frame of tf."""
    rig = CameraRig(simulation, lambda _: None)
    yield rig
    rig.close()


@pytest.mark.parametrize('frames', [30, 50, 100])
def test_a_second_has_as_many_pictures_as_the_rate_says(simulation, rig, frames):
    """With 30 frames a second, which end with steps of 5 ms, 20 had a picture."""
    front = simulation.scene.cameras[0]
    taken = []
    for _ in range(frames):
        if rig.is_due(front):
            taken.append(rig.take(front, [INFO]).time)
        simulation.advance(1.0 / frames)
    assert len(taken) == 30
    # With the first frame from its time on; a frame ends up to a step of 5 ms early.
    late = np.array(taken) - np.arange(30) / 30.0
    assert late.min() > -0.0051 and late.max() < 1.0 / frames


def test_a_moment_that_is_shown_again_has_a_picture_again(simulation, rig):
    """Whoever subscribes while the run is paused would see nothing."""
    front = simulation.scene.cameras[0]
    simulation.advance(0.1)
    rig.take(front, [INFO])
    assert rig.is_due(front)
    simulation.advance(0.005)
    assert not rig.is_due(front)
    simulation.reset()
    assert rig.is_due(front)


def test_only_what_is_asked_for_is_drawn(simulation, rig):
    """A subscriber of the depth would wait for the colours."""
    picture = rig.take(simulation.scene.cameras[0], [DEPTH])
    assert picture.depth is not None and picture.color is None and picture.labels is None


def test_an_attached_camera_waits_for_its_frame(simulation, rig):
    """A camera whose frame never comes would show the cloth from the origin."""
    hand = simulation.scene.cameras[1]
    assert rig.take(hand, [DEPTH]) is None
    placed = CameraRig(simulation, lambda model: Pose((0.0, 0.0, 3.0), (1.0, 0.0, 0.0, 0.0)))
    picture = placed.take(hand, [INFO])
    assert picture.pose.position == (0.0, 0.0, 3.0)
    placed.close()
