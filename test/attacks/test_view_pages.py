# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pages of a view that send nonsense, and requests that are not from its page."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
import random
import signal
import socket
import subprocess
import sys
from typing import Any
from urllib.parse import urlsplit

from hostile import NUMBERS
from hostile import WHOLE
from hostile import WORDS
import msgspec.msgpack
import pytest
from served_view import free_port
from view_page import ViewPage
from websockets.exceptions import ConnectionClosed
from websockets.exceptions import InvalidHandshake

TOWEL = Path(__file__).resolve().parents[2] / 'config' / 'towel.yaml'
MESSAGES = [150, pytest.param(20_000, marks=pytest.mark.long)]
REQUESTS = [40, pytest.param(2_000, marks=pytest.mark.long)]
PER_PAGE = 25
_FIELDS = (
    'name', 'owner', 'wxyz', 'position', 'uuid', 'updates', 'event_type', 'ray_origin',
    'ray_direction', 'screen_pos', 'modifier', 'fov', 'near', 'far', 'image_height',
    'image_width', 'look_at', 'up_direction', 'value', 'excluded_self_client')
_KINDS = (
    'ViewerCameraMessage', 'ScenePointerMessage', 'GuiUpdateMessage',
    'TransformControlsDragStartMessage', 'TransformControlsUpdateMessage',
    'TransformControlsDragEndMessage', 'ShareUrlDisconnect', 'RunJavascriptMessage',
    'GuiFormDirtyMessage', 'FileTransferPart', 'CommandTriggerMessage', 'Message', '')


@contextmanager
def view() -> Iterator[tuple[subprocess.Popen, str]]:
    """Start a view as a user does; yield its process and its address."""
    port = free_port()
    process = subprocess.Popen(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'view', str(TOWEL), '--set', 'rows=6',
         '--set', 'cols=5', '--paused', '--port', str(port)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    try:
        line = process.stdout.readline()
        yield process, line.split(' is shown at ')[1].split(';')[0]
    finally:
        process.kill()
        process.communicate()


def check_it_lives(process: subprocess.Popen, address: str) -> None:
    """Step the cloth by a page that behaves, end the view and return its output."""
    with ViewPage(address) as page:
        page.wait_for(lambda: page.text and 'Reset' in page.controls, 'the cloth')
        if 'Pause' in page.controls:
            page.give('Pause', True)
            page.wait_for(lambda: 'Run' in page.controls, 'a pause')
        page.give('Reset', True)
        page.wait_for(lambda: 't = 0.00 s' in page.text, 'the start')

        def is_stepped():
            # Again and again: threads of the viewer may let a step come before the reset.
            page.give('Step', True)
            return 't = 0.00 s' not in page.text
        page.wait_for(is_stepped, 'a step')
    process.send_signal(signal.SIGINT)
    out, errors = process.communicate(timeout=300.0)
    assert (process.returncode, out) == (130, '')
    assert 'Traceback' not in errors, errors


@pytest.mark.parametrize('count', MESSAGES)
def test_no_message_ends_the_view(count: int, seed: int):
    """A malformed message of one page would end the view for all."""
    drawn = random.Random(seed)
    with view() as (process, address):
        sent = 0
        while sent < count:
            try:
                with ViewPage(address) as page:
                    page.wait_for(lambda: page.text and 'Step' in page.controls, 'the cloth')
                    for _ in range(PER_PAGE):
                        page.send_data(_drawn_message(drawn, page))
                        sent += 1
            except ConnectionClosed:
                pass
            assert process.poll() is None, process.communicate()
        check_it_lives(process, address)


@pytest.mark.parametrize('count', REQUESTS)
def test_no_request_without_the_key_is_served(count: int, seed: int):
    """Somebody who tries ports and names would reach the cloth."""
    drawn = random.Random(seed)
    with view() as (process, address):
        own = urlsplit(address)
        token = own.path[1:]
        for _ in range(count):
            guess = drawn.choice(['', 'x', token[:-1], token[1:], token.swapcase(), '..', '%2e'])
            origin = drawn.choice(['http://evil.example', f'http://{own.netloc}', 'null'])
            try:
                with ViewPage(f'http://{own.netloc}/{guess}', {'Origin': origin}):
                    raise AssertionError(f'served with {guess!r} from {origin}')
            except InvalidHandshake as refused:
                assert '403' in str(refused)
            _send_noise(own.hostname, own.port, drawn.randbytes(drawn.choice([0, 1, 100, 9000])))
        check_it_lives(process, address)


def _send_noise(host: str, port: int, data: bytes) -> None:
    with socket.create_connection((host, port), 60.0) as connected:
        try:
            connected.sendall(data)
        except OSError:
            pass  # it was shut in the middle


def _drawn_message(drawn: random.Random, page: ViewPage) -> bytes | str:
    choice = drawn.random()
    if choice < 0.05:
        return drawn.randbytes(drawn.choice([0, 1, 50, 5000]))
    if choice < 0.08:
        return drawn.choice(WORDS)
    message = {'type': drawn.choice(_KINDS)}
    for name in drawn.sample(_FIELDS, drawn.randrange(6)):
        message[name] = _drawn_value(drawn)
    kind = message['type']
    if kind.startswith('Transform') and drawn.random() < 0.8:
        message = {'type': kind, 'name': '/handles/0_1', 'owner': ''}
        if 'Update' in kind:
            message.update(wxyz=_drawn_list(drawn, 4), position=_drawn_list(drawn, 3))
    elif kind == 'GuiUpdateMessage' and drawn.random() < 0.8:
        control = drawn.choice(sorted(page.controls.values(), key=lambda each: each['label']))
        message = {
            'type': kind, 'uuid': control['uuid'],
            'updates': {drawn.choice(['value', 'value', 'value', 'removed', 'update_cb']):
                        _drawn_value(drawn)}}
    elif kind == 'ScenePointerMessage' and drawn.random() < 0.8:
        message = {
            'type': kind, 'event_type': 'click', 'ray_origin': _drawn_list(drawn, 3),
            'ray_direction': _drawn_list(drawn, 3), 'screen_pos': [[0.5, 0.5]],
            'modifier': None}
    return msgspec.msgpack.encode(message)


def _drawn_list(drawn: random.Random, count: int) -> list[Any]:
    if drawn.random() < 0.3:
        return [_drawn_value(drawn) for _ in range(drawn.randrange(6))]
    return [drawn.choice(NUMBERS) for _ in range(count)]


def _drawn_value(drawn: random.Random) -> Any:
    return drawn.choice((
        drawn.choice(NUMBERS), drawn.choice(WHOLE), drawn.choice(WORDS), True, None, [], {},
        [1, 2], [1.0, 2.0, 3.0], {'value': drawn.choice(NUMBERS)}, b'bytes'))
