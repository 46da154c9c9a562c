# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A page shows the cloth, and what is done there is done to the cloth."""

from collections.abc import Iterator
import io
from pathlib import Path

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.camera.depth_shades import depth_shades
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.view.recording_source import RecordingSource
from cloth_sim_ros.view.scene_source import SceneSource
import numpy as np
from PIL import Image
import pytest
from served_view import served
from springs import SPRINGS
from view_page import ViewPage

SCENE = Scene({**SPRINGS, 'rows': 6, 'cols': 7})
FRONT = {
    'position': [0.3, -1.0, 1.4], 'target': [0.3, 0.3, 1.0], 'width': 80, 'height': 60}
EXAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'example'


@pytest.fixture
def source() -> SceneSource:
    """Start a paused scene; the view of it ends it."""
    return SceneSource(SCENE, 'small', frame_seconds=0.02, is_paused=True)


@pytest.fixture
def page(source: SceneSource) -> Iterator[ViewPage]:
    """Open a page of the scene."""
    with served(source) as address, ViewPage(address) as page:
        page.wait_for(lambda: page.text and '/cloth/pins' in page.nodes, 'a cloth')
        yield page


def test_the_page_shows_the_cloth_and_its_pins(page: ViewPage):
    """A user would see another cloth, or none."""
    rest = SCENE.rest_positions()
    shown = np.unique(page.points(), axis=0)
    np.testing.assert_allclose(shown, np.unique(np.float32(rest.reshape(-1, 3)), axis=0))
    pins = rest[SCENE.pinned_nodes()]
    np.testing.assert_allclose(page.dots('/cloth/pins'), pins, atol=1e-6)
    page.wait_for(lambda: '/handles/0_6' in page.nodes, 'handles')
    np.testing.assert_allclose(page.nodes['/handles/0_6']['position'], pins[1], atol=1e-6)
    assert page.text.startswith('**small**, paused\n\nt = 0.00 s, largest strain 0.0 %, 2 pins')
    assert page.controls['Mode']['value'] == 'mass_spring'


def test_run_and_pause_step_and_reset(page: ViewPage, source: SceneSource):
    """A button would do nothing, or say the opposite of what it does."""
    page.give('Step', True)
    page.wait_for(lambda: source.latest().frame.time == SCENE['dt'], 'a step')
    page.give('Run', True)
    page.wait_for(lambda: 'running' in page.text and 'Pause' in page.controls, 'a run')
    page.wait_for(lambda: source.latest().frame.time > 0.1, 'time that goes on')
    page.give('Pause', True)
    page.wait_for(lambda: 'paused' in page.text and 'Run' in page.controls, 'a pause')
    page.give('Reset', True)
    page.wait_for(lambda: 't = 0.00 s' in page.text, 'the start')


def test_the_mode_is_switched(page: ViewPage, source: SceneSource):
    """The page would show another mode than the one that steps."""
    page.give('Mode', 'adaptive')
    page.wait_for(lambda: 'mode adaptive' in page.text, 'the mode')
    assert source.latest().mode == 'adaptive'


def test_a_click_pushes_along_the_look():
    """A push would go to another place, in another direction or with another force."""
    scene = Scene({**SPRINGS, 'rows': 6, 'cols': 7, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0]})
    source = SceneSource(scene, 'free', frame_seconds=0.02, is_paused=True)
    with served(source) as address, ViewPage(address) as page:
        page.wait_for(lambda: page.text, 'a cloth')
        page.give('Force [N]', 2.0)
        page.give('Radius [m]', 0.25)
        page.give('Duration [s]', 0.005)
        page.click((9.0, 9.0, 0.0), (0.0, 0.0, 1.0))
        page.click((0.15, 0.1, 0.0), (0.0, 0.0, 3.0))
        # Whichever comes first, the click or the run: the momentum stays.
        page.give('Run', True)
        page.wait_for(lambda: source.latest().frame.records['vz'].any(), 'a push')
        page.wait_for(
            lambda: source.latest().frame.time > 0.03 and 'Pause' in page.controls, 'its end')
        page.give('Pause', True)
        frame = source.latest().frame
    momentum = scene.node_mass * np.array(
        [frame.records[name].sum() for name in ('vx', 'vy', 'vz')])
    np.testing.assert_allclose(momentum, (0.0, 0.0, 2.0 * 0.005), atol=1e-6)
    highest = np.unravel_index(np.argmax(frame.records['z']), frame.strain.shape)
    assert np.linalg.norm(scene.rest_positions()[highest] - (0.15, 0.1, 1.0)) < 0.25


def test_a_click_pins_and_releases(page: ViewPage):
    """The node beside the one that was clicked would be held."""
    page.give('Click', 'pins or releases')
    rest = SCENE.rest_positions()
    # Settings and clicks are processed side by side.
    page.wait_for(lambda: page.controls['Click'], 'the choice')
    above = tuple(rest[3, 2] + (0.01, 0.01, 1.0))
    _click_until(page, above, 3)
    np.testing.assert_allclose(page.nodes['/handles/3_2']['position'], rest[3, 2], atol=1e-6)
    _click_until(page, above, 2)
    page.wait_for(lambda: '/handles/3_2' not in page.nodes, 'no handle there')


def _click_until(page: ViewPage, origin: tuple, pins: int) -> None:
    page.click(tuple(map(float, origin)), (0.0, 0.0, -1.0))
    page.wait_for(lambda: f'{pins} pins' in page.text, f'{pins} pins')


def test_a_handle_drags_its_pin(page: ViewPage, source: SceneSource):
    """A pin would stay where it is, or another one move."""
    page.wait_for(lambda: '/handles/0_0' in page.nodes, 'a handle')
    page.give('Run', True)
    page.wait_for(lambda: 'running' in page.text, 'a run')
    page.drag('/handles/0_0', (-0.3, 0.4, 1.1))
    page.wait_for(lambda: np.allclose(
        source.latest().frame.positions[0, 0], (-0.3, 0.4, 1.1), atol=1e-5), 'the pin there')
    page.wait_for(lambda: np.allclose(
        page.nodes['/handles/0_0']['position'], (-0.3, 0.4, 1.1), atol=1e-5), 'its handle')
    np.testing.assert_allclose(
        source.latest().frame.positions[0, -1], SCENE.rest_positions()[0, -1], atol=1e-6)


def test_what_cannot_be_done_is_told_on_the_page(page: ViewPage):
    """A user would click and wonder why nothing happens."""
    page.give('Run', True)
    page.wait_for(lambda: 'running' in page.text, 'a run')
    page.give('Step', True)
    page.wait_for(lambda: page.told, 'a notification')
    assert 'pause first' in page.told[0]['props']['body']


def test_a_recording_has_a_time_and_nothing_to_act_on():
    """A slider would lead to another moment, or a recording be pushed."""
    source = RecordingSource(EXAMPLE)
    source.set_paused(True)
    begin, end = source.span
    with served(source) as address, ViewPage(address) as page:
        page.wait_for(lambda: page.text, 'a moment')
        assert not {'Step', 'Reset', 'Mode', 'Click'} & set(page.controls)
        page.give('Time [s]', begin + 0.5)
        page.wait_for(lambda: f't = {begin + 0.5:.2f} s' in page.text, 'that time')
        assert source.latest().run_state == 'paused'


def test_a_chain_is_drawn_as_dots():
    """A page without triangles would be empty."""
    scene = Scene({**SPRINGS, 'rows': 1, 'cols': 9, 'start.z': 0.5})
    source = SceneSource(scene, 'chain', frame_seconds=0.02, is_paused=True)
    with served(source) as address, ViewPage(address) as page:
        page.wait_for(lambda: '/cloth/nodes' in page.nodes, 'nodes')
        np.testing.assert_allclose(
            page.dots('/cloth/nodes'), scene.rest_positions().reshape(-1, 3), atol=1e-6)


def test_the_page_shows_what_a_camera_sees():
    """A camera could only be aimed with RViz or Foxglove beside a running node."""
    scene = Scene({
        **SPRINGS, 'rows': 6, 'cols': 7, 'cameras.names': ['front', 'hand'], **{
            f'cameras.front.{key}': value for key, value in FRONT.items()},
        'cameras.hand.frame': 'tool0'})
    source = SceneSource(scene, 'small', frame_seconds=0.02, is_paused=True)
    with Simulation(scene) as simulation, Camera(scene.cameras[0]) as camera:
        first = camera.capture(simulation)
        simulation.step(40)
        later = camera.capture(simulation)

    def shows(pixels: np.ndarray) -> bool:
        control = page.controls['Seen']
        seen = np.asarray(Image.open(io.BytesIO(control['_data'])).convert('RGB')).astype(int)
        # JPEG changes these by up to 2.8 of 255; the two moments differ by 5.7 and 24.
        return control['visible'] and seen.shape == pixels.shape and (
            np.abs(seen - pixels).mean() < 4.0)

    with served(source) as address, ViewPage(address) as page:
        page.wait_for(lambda: page.text, 'a cloth')
        assert list(page.controls['Camera']['options']) == ['no camera', 'front', 'hand']
        assert not page.controls['Seen']['visible']
        page.give('Camera', 'front')
        page.wait_for(lambda: shows(first.color), 'a picture')
        page.give('Picture', 'depth')
        page.wait_for(lambda: shows(depth_shades(first.depth)), 'its depth')
        source.step(40)
        page.wait_for(lambda: shows(depth_shades(later.depth)), 'the depth after a motion')
        page.give('Camera', 'hand')
        page.wait_for(lambda: page.told, 'a notification')
        assert "camera hand is attached to the tf frame 'tool0', and" in (
            page.told[0]['props']['body'])
        page.wait_for(lambda: page.controls['Camera']['value'] == 'front', 'the old choice')
        assert shows(depth_shades(later.depth))
        page.give('Camera', 'no camera')
        page.wait_for(lambda: not page.controls['Seen']['visible'], 'an end')
