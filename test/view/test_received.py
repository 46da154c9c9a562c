# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a page sends wrongly is its own error: the view, and other pages, go on."""

from collections.abc import Iterator
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.view.scene_source import SceneSource
import msgspec.msgpack
import numpy as np
import pytest
from served_view import served
from springs import SPRINGS
from view_page import ViewPage

SCENE = Scene({**SPRINGS, 'rows': 4, 'cols': 5})
NAN, INFINITE = float('nan'), float('inf')
UP = (1.0, 0.0, 0.0, 0.0)
HANDLE = '/handles/0_0'
CLICK = {'event_type': 'click', 'ray_origin': (0.1, 0.1, 2.0), 'ray_direction': (0.0, 0.0, -1.0),
         'screen_pos': ((0.5, 0.5),), 'modifier': None}
WRONG: dict[str, tuple[str, dict[str, Any]]] = {
    'a short position': (
        'TransformControlsUpdateMessage', {'name': HANDLE, 'wxyz': UP, 'position': [1, 2]}),
    'no number': (
        'TransformControlsUpdateMessage',
        {'name': HANDLE, 'wxyz': UP, 'position': [NAN, 0.0, 0.0]}),
    'a huge number': (
        'TransformControlsUpdateMessage',
        {'name': HANDLE, 'wxyz': UP, 'position': [1e300, 0.0, 0.0]}),
    'a text as position': (
        'TransformControlsUpdateMessage', {'name': HANDLE, 'wxyz': UP, 'position': 'abc'}),
    'a short rotation': (
        'TransformControlsUpdateMessage', {'name': HANDLE, 'wxyz': [1], 'position': [1, 2, 3]}),
    'a number as name': ('TransformControlsDragStartMessage', {'name': 5}),
    'a list as name': ('TransformControlsDragEndMessage', {'name': [HANDLE]}),
    'no name': ('TransformControlsDragStartMessage', {}),
    'an unknown field': ('TransformControlsDragStartMessage', {'name': HANDLE, 'more': 1}),
    'a camera of nothing': ('ViewerCameraMessage', {}),
    'a click to nowhere': ('ScenePointerMessage', {**CLICK, 'ray_direction': (0.0, 0.0, 0.0)}),
    'a click from nowhere': ('ScenePointerMessage', {**CLICK, 'ray_origin': None}),
    'an infinite click': (
        'ScenePointerMessage', {**CLICK, 'ray_direction': (0.0, INFINITE, 0.0)}),
    'an unknown kind': ('NoSuchMessage', {}),
    'a message to pages': ('RunJavascriptMessage', {'source': 'alert(1)'}),
    'an upload': ('FileTransferStartUpload', {
        'source_component_uuid': '', 'transfer_uuid': '', 'filename': '', 'mime_type': '',
        'part_count': 1, 'size_bytes': 1}),
    'an unknown control': ('GuiUpdateMessage', {'uuid': 'none', 'updates': {'value': 1}}),
    'updates of nothing': ('GuiUpdateMessage', {'uuid': 'none', 'updates': 7}),
}
RAW = {
    'no message': b'\xc1\x00', 'nothing': b'', 'a number': msgspec.msgpack.encode(7),
    'no type': msgspec.msgpack.encode({'name': HANDLE}),
    'a number as type': msgspec.msgpack.encode({'type': 5}),
    'deep lists': b'\x91' * 50_000, 'a text': 'text'}
# What a page may set, and values that a control of that kind does not have.
CONTROLS: list[tuple[str, Any]] = [
    ('Force [N]', NAN), ('Force [N]', 'abc'), ('Force [N]', None), ('Force [N]', [1.0]),
    ('Force [N]', True), ('Mode', 'no mode'), ('Mode', 5), ('Mode', ['adaptive']),
    ('Handles to drag pins', 'x'), ('Handles to drag pins', 3), ('Step', 'x'), ('Step', {})]


@pytest.fixture
def source() -> SceneSource:
    """Start a paused scene; the view of it ends it."""
    return SceneSource(SCENE, 'small', frame_seconds=0.02, is_paused=True)


@pytest.fixture
def address(source: SceneSource) -> Iterator[str]:
    """Serve the scene."""
    with served(source) as address:
        yield address


@pytest.fixture
def page(address: str) -> Iterator[ViewPage]:
    """Open a page that behaves."""
    with ViewPage(address) as page:
        page.wait_for(lambda: HANDLE in page.nodes, 'the cloth')
        yield page


def check_it_goes_on(page: ViewPage, source: SceneSource) -> None:
    """Step the cloth by the page."""
    steps = source.latest().frame.time
    page.give('Step', True)
    page.wait_for(lambda: source.latest().frame.time > steps, 'a step')


@pytest.mark.parametrize('what', WRONG)
def test_a_wrong_message_is_dropped_and_told(address, page, source, capfd, what):
    """One page would end the view for all, or have every page show nonsense."""
    kind, fields = WRONG[what]
    with ViewPage(address) as other:
        other.wait_for(lambda: HANDLE in other.nodes, 'the cloth')
        other.send(kind, **fields)
        other.send(kind, **fields)
        other.wait_for(lambda: other.told, 'what was wrong')
        check_it_goes_on(other, source)
        assert len(other.told) == 1 and 'dropped' in other.told[0]['props']['body']
    check_it_goes_on(page, source)
    np.testing.assert_allclose(
        page.nodes[HANDLE]['position'], SCENE.rest_positions()[0, 0], atol=0.01)
    assert page.told == []
    lines = capfd.readouterr().err.splitlines()
    assert len(lines) == 1 and lines[0].startswith('cloth_sim view: a page sent'), lines


@pytest.mark.parametrize('what', RAW)
def test_bytes_that_are_no_message_are_dropped(address, page, source, capfd, what):
    """Noise on one connection would end it with a traceback."""
    with ViewPage(address) as other:
        other.wait_for(lambda: HANDLE in other.nodes, 'the cloth')
        other.send_data(RAW[what])
        other.wait_for(lambda: other.told, 'what was wrong')
        check_it_goes_on(other, source)
    check_it_goes_on(page, source)
    assert 'Traceback' not in capfd.readouterr().err


@pytest.mark.parametrize(('label', 'value'), CONTROLS, ids=str)
def test_values_that_a_control_cannot_have_are_dropped(page, source, capfd, label, value):
    """The view would continue with a NaN force, or a mode that does not exist."""
    before = page.controls[label]['value']
    page.give(label, value)
    page.wait_for(lambda: page.told, 'what was wrong')
    assert repr(label) in page.told[0]['props']['body']
    check_it_goes_on(page, source)
    assert page.controls[label]['value'] == before or label == 'Step'
    assert 'Traceback' not in capfd.readouterr().err


@pytest.mark.parametrize('name', ['update_cb', 'removed', 'uuid', 'visible', 'sync_cb', 'value2'])
def test_only_values_of_controls_are_set(page, source, capfd, name):
    """A page would overwrite what viser keeps of a control, such as its callbacks."""
    page.send(
        'GuiUpdateMessage', uuid=page.controls['Step']['uuid'], updates={name: 5, 'value': True})
    page.wait_for(lambda: page.told, 'what was wrong')
    check_it_goes_on(page, source)
    assert 'Traceback' not in capfd.readouterr().err


@pytest.mark.parametrize('value', [0.0, -5, 1e12])
def test_numbers_being_typed_are_held_to_their_range(page, source, capfd, value):
    """A zero on the way to 0.5 would divide the strain by nothing."""
    page.give('Colour scale ends at strain [%]', value)
    page.give('Radius [m]', value)
    page.click((0.1, 0.1, 5.0), (0.0, 0.0, -1.0))
    check_it_goes_on(page, source)
    assert capfd.readouterr().err == ''
