# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A page opens for its own address alone, and sends what it can to this view alone."""

from collections.abc import Iterator
import socket
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request
from urllib.request import urlopen

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.view import door
from cloth_sim_ros.view.scene_source import SceneSource
from cloth_sim_ros.view.server import open_server
import pytest
from served_view import free_port
from served_view import served
from springs import SPRINGS
from view_page import ViewPage
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

SCENE = Scene({**SPRINGS, 'rows': 4, 'cols': 5})
OTHER_SITES = (
    'http://evil.example', 'https://evil.example', 'null', 'http://127.0.0.1:1', 'file://',
    'http://127.0.0.1', 'http://evil.example:8080')


@pytest.fixture(scope='module')
def address() -> Iterator[str]:
    """Serve a view, and return its address."""
    source = SceneSource(SCENE, 'small', frame_seconds=0.02, is_paused=True)
    with served(source) as address:
        yield address


def status_of(address: str, **headers: str) -> int:
    """Return the status of a page that is asked for with ``headers``."""
    try:
        with urlopen(Request(address, headers=headers), timeout=60.0) as answer:
            return answer.status
    except HTTPError as error:
        assert b'open the' in error.read()
        return error.code


def websocket_status(address: str, headers: dict[str, str]) -> int:
    """Return the status of a websocket that is asked for with ``headers``; 101 when it opens."""
    url = address.replace('http://', 'ws://')
    host = headers.pop('Host', urlsplit(address).netloc)
    own = urlsplit(address)
    with socket.create_connection((own.hostname, own.port), 60.0) as connected:
        try:
            with connect(
                    url.replace(own.netloc, host), sock=connected, additional_headers=headers,
                    subprotocols=[f'viser-v{viser.__version__}'], compression=None):
                return 101
        except InvalidStatus as error:
            return error.response.status_code


def test_the_printed_address_opens_the_page(address: str):
    """The user would be shut out."""
    assert status_of(address) == 200
    assert status_of(f'{address}/') == 200
    assert status_of(f'{address}?darkMode') == 200
    with ViewPage(address, {'Origin': address.rpartition('/')[0]}) as page:
        page.wait_for(lambda: page.text, 'the cloth')


@pytest.mark.parametrize('path', [
    '/', '', '/wrong', '/index.html', '/?token', '/{token}x', '/x{token}', '//{token}'])
def test_without_the_key_nothing_opens(address: str, path: str):
    """Another user of this machine would steer the cloth, or any page that tries the port."""
    root, _, token = address.rpartition('/')
    other = root + path.format(token=token)
    assert status_of(other) == 403
    assert websocket_status(other, {}) == 403


@pytest.mark.parametrize('origin', OTHER_SITES)
def test_other_sites_are_refused(address: str, origin: str):
    """A web page that the user looks at would steer the cloth."""
    assert websocket_status(address, {'Origin': origin}) == 403


@pytest.mark.parametrize('host', [
    'evil.example:{port}', 'evil.example', '127.0.0.2:{port}', '127.0.0.1.evil.example:{port}',
    'localhost.evil.example:{port}', '[::2]:{port}', '8.8.8.8'])
def test_other_hosts_are_refused(address: str, host: str):
    """A web site whose name leads to this machine would pass for the page of the view."""
    host = host.format(port=urlsplit(address).port)
    assert websocket_status(address, {'Host': host, 'Origin': f'http://{host}'}) == 403
    assert status_of(address, Host=host) == 403


@pytest.mark.parametrize('host', ['localhost:{port}', 'LOCALHOST:9999', '[::1]:{port}'])
def test_local_names_are_taken(address: str, host: str):
    """The page would be shut to a browser that says localhost, or to a port sent on by ssh."""
    host = host.format(port=urlsplit(address).port)
    assert status_of(address, Host=host) == 200
    assert websocket_status(address, {'Host': host, 'Origin': f'http://{host.lower()}'}) == 101


def test_each_view_has_a_key_of_its_own(address: str):
    """Who knew the address of one view would know that of the next."""
    with open_server('127.0.0.1', free_port()) as server:
        assert len(server.door.token) >= 22
        assert server.address.rpartition('/')[2] != address.rpartition('/')[2]


def test_a_view_for_all_is_opened_by_its_address():
    """Another machine of the network would be shut out, or a foreign name let in."""
    port = free_port()
    with open_server('0.0.0.0', port) as server:
        token = server.door.token
        assert server.address == f'http://localhost:{port}/{token}'
        # As another machine asks: by an address that this one has.
        assert status_of(f'http://127.0.0.2:{port}/{token}') == 200
        host = f'{socket.gethostname()}:{port}'
        assert status_of(f'http://127.0.0.1:{port}/{token}', Host=host) == 200
        assert status_of(f'http://127.0.0.1:{port}/{token}', Host='evil.example') == 403
        assert status_of(f'http://127.0.0.2:{port}/') == 403


def test_a_request_to_share_reaches_nobody(address: str):
    """A message would open the view to the internet, though no button offers it."""
    with ViewPage(address) as page:
        page.wait_for(lambda: page.text, 'the cloth')
        page.send('ShareUrlRequest')
        page.wait_for(lambda: page.told, 'the refusal')
        assert 'ShareUrlRequest' in page.told[0]['props']['body']


def test_viser_has_no_way_to_share_left():
    """A message that passes the first check would still open the view to the internet."""
    with open_server('127.0.0.1', free_port()) as server:
        kinds = {kind.__name__ for kind in server._websock_server._incoming_handlers}
        assert 'GuiUpdateMessage' in kinds
        assert not {kind for kind in kinds if 'Share' in kind}


def test_a_viser_that_cannot_be_guarded_is_refused():
    """Another version would serve its page to everybody."""
    with pytest.raises(ClothSimError, match='cannot be served with a key'):
        with door.Door('127.0.0.1').guard(None, None, None):
            pass
