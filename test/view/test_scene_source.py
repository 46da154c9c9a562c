# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A scene in the view is the simulation itself, on a thread of its own."""

from collections.abc import Iterator
import time

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.view.scene_source import SceneSource
import numpy as np
import pytest
from springs import SPRINGS

SCENE = Scene({**SPRINGS, 'rows': 6, 'cols': 7, 'start.jitter': 0.01})
PATIENCE = 300.0


@pytest.fixture
def source() -> Iterator[SceneSource]:
    """Start a paused scene."""
    source = SceneSource(SCENE, 'small', frame_seconds=0.02, is_paused=True)
    yield source
    source.close()


def wait_for(condition) -> None:
    """Wait until the other thread has made it so."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def test_what_is_asked_for_is_what_the_simulation_does(source: SceneSource):
    """The view would show another motion than a run with the same inputs."""
    source.step(3)
    source.push((0.0, 0.3, 1.0), (0.1, 0.0, 1.0), 0.3, 0.05)
    source.hold(3, 3)
    source.release(0, 0)
    source.step(5)
    source.set_mode('adaptive')
    source.move_pin(3, 3, (0.0, 0.1, 1.2))
    source.step(4)
    moment = source.latest()
    simulation = Simulation(SCENE)
    simulation.step(3)
    simulation.push((0.0, 0.3, 1.0), duration=0.05, region='sphere', center=(0.1, 0.0, 1.0),
                    radius=0.3)
    simulation.pin(3, 3)
    simulation.release(0, 0)
    simulation.step(5)
    simulation.set_mode('adaptive')
    simulation.move_pin(3, 3, (0.0, 0.1, 1.2))
    simulation.step(4)
    expected = simulation.snapshot()
    simulation.close()
    assert (moment.mode, moment.run_state) == ('adaptive', 'paused')
    assert moment.frame.time == expected.time
    np.testing.assert_array_equal(moment.frame.records, expected.records)


def test_time_goes_on_stands_still_and_begins_again(source: SceneSource):
    """Pause, run or reset would do nothing."""
    assert source.latest().frame.time == 0.0
    source.set_paused(False)
    wait_for(lambda: source.latest().frame.time > 0.05)
    source.set_paused(True)
    stopped = source.latest()
    assert stopped.run_state == 'paused'
    source.reset()
    assert source.latest().frame.time == 0.0
    np.testing.assert_allclose(
        source.latest().frame.positions, SCENE.start_positions(), atol=1e-6)


@pytest.mark.parametrize(('ask', 'told'), [
    (lambda source: source.push((0.0, 0.0, 1.0), (9.0, 0.0, 0.0), 0.1, 0.1), 'no free node'),
    (lambda source: source.move_pin(3, 3, (0.0, 0.0, 1.0)), 'pin it first'),
    (lambda source: (source.set_paused(False), source.step(1)), 'pause first')],
    ids=['push', 'move', 'step'])
def test_what_cannot_be_done_is_told_and_changes_nothing(source: SceneSource, ask, told: str):
    """A page would not learn of it, or the simulation end."""
    with pytest.raises(ClothSimError, match=told):
        ask(source)
    source.set_paused(True)
    source.step(1)


def test_lost_run_stops_with_the_reason_and_restarts():
    """The view would stand still without a word."""
    # So light and pushed so hard that squared distances leave the range of float32.
    scene = Scene({
        'rows': 4, 'cols': 4, 'pushes.start': [0.1], 'pushes.duration': [0.1],
        'pushes.force': [0.0, 0.0, 1e9], 'node_mass': 1e-16, 'stiffness.structural': 1e-12,
        'stiffness.shear': 0.0, 'stiffness.bend': 0.0, 'damping.structural': 0.0,
        'damping.shear': 0.0, 'damping.bend': 0.0})
    source = SceneSource(scene, 'lost', frame_seconds=0.02)
    wait_for(lambda: source.latest().run_state == 'stopped')
    assert 'push with less force' in source.latest().note
    with pytest.raises(ClothSimError, match='reset first'):
        source.set_paused(False)
    source.reset()
    assert (source.latest().run_state, source.latest().note) == ('paused', '')
    source.close()
    with pytest.raises(ClothSimError, match='has ended'):
        source.reset()


def test_a_scene_that_has_ended_is_told(source: SceneSource):
    """A page would wait for ever for a simulation that is gone."""
    source.close()
    with pytest.raises(ClothSimError, match='simulation of this view has ended'):
        source.step(1)


def test_a_scene_goes_to_no_other_time(source: SceneSource):
    """A view that asked for it anyway would end in a traceback without a way out."""
    with pytest.raises(ClothSimError, match='small cannot go to a time: view a recording'):
        source.go_to(1.0)


def test_a_scene_that_cannot_be_run_is_refused_at_once():
    """A page would be served that never shows anything."""
    with pytest.raises(ClothSimError, match='auto_substeps: true'):
        SceneSource(
            Scene({**SPRINGS, 'dt': 0.5, 'auto_substeps': False}), 'unstable', frame_seconds=0.5)


def test_a_camera_on_a_tf_frame_is_refused():
    """A camera in a hand would show the cloth from the origin, or be missing without a word."""
    scene = Scene({
        **SPRINGS, 'rows': 6, 'cols': 7, 'cameras.names': ['front', 'hand'],
        'cameras.front.position': [0.3, -1.0, 1.4], 'cameras.front.target': [0.3, 0.3, 1.0],
        'cameras.front.width': 16, 'cameras.front.height': 12, 'cameras.hand.frame': 'tool0'})
    source = SceneSource(scene, 'small', frame_seconds=0.02, is_paused=True)
    source.show_camera('front', 'color')
    with pytest.raises(ClothSimError, match="tf frame 'tool0', and a scene in the view") as told:
        source.show_camera('hand', 'color')
    assert '\n' not in str(told.value)
    source.step(1)
    assert source.latest().picture.shape == (12, 16, 3)
    source.close()
