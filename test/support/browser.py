# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A headless Chromium with one page, driven by its DevTools protocol."""

import base64
import json
from pathlib import Path
import shutil
import subprocess
import time
from typing import Any
from urllib.request import urlopen

from websockets.sync.client import connect

NAMES = ('chromium', 'chromium-browser', 'google-chrome')
# WebGL on a busy processor is slow.
PATIENCE = 300.0
# WebGL on the processor, and none of the connections that a browser opens by itself.
_OPTIONS = (
    '--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--hide-scrollbars', '--mute-audio')


class Browser:
    """
    Show ``url`` in a window of ``size``; a context manager.

    :param folder: for the profile of the browser
    """

    def __init__(self, folder: Path, url: str, size: tuple[int, int] = (1280, 800)) -> None:
        """Start the browser, and attach to its page."""
        program = next(filter(None, map(shutil.which, NAMES)), None)
        assert program, f'none of {", ".join(NAMES)} is here: run `scripts/setup.sh --long`'
        self._process = subprocess.Popen(
            [program, *_OPTIONS, f'--window-size={size[0]},{size[1]}',
             f'--user-data-dir={folder}', '--remote-debugging-port=0', url],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._number = 0
        port = self._wait(lambda: self._port(folder))
        page = self._wait(lambda: next(
            (tab for tab in json.load(urlopen(f'http://127.0.0.1:{port}/json'))
             if tab['type'] == 'page'), None))
        self._socket = connect(page['webSocketDebuggerUrl'], max_size=None)
        # A window is larger than what it shows of a page.
        self._call('Emulation.setDeviceMetricsOverride', width=size[0], height=size[1],
                   deviceScaleFactor=1, mobile=False)

    def __enter__(self) -> 'Browser':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the browser."""
        self._socket.close()
        self._process.terminate()
        self._process.wait(PATIENCE)

    def text(self) -> str:
        """Return the text of the page; empty before there is any."""
        return self.evaluate('document.body ? document.body.innerText : ""') or ''

    def wait_for(self, text: str) -> None:
        """Wait until the page says ``text``."""
        self._wait(lambda: True if text in self.text() else None, f'the page says no {text!r}')

    def evaluate(self, expression: str) -> Any:
        """Return the value of a JavaScript expression."""
        return self._call('Runtime.evaluate', expression=expression,
                          returnByValue=True)['result'].get('value')

    def picture(self) -> bytes:
        """Return the page as PNG."""
        return base64.b64decode(self._call('Page.captureScreenshot', format='png')['data'])

    def press(self, label: str) -> None:
        """Click the button ``label``."""
        place = self.evaluate(
            '(() => { const b = [...document.querySelectorAll("button")].find('
            f'e => e.innerText.trim() === {json.dumps(label)}).getBoundingClientRect();'
            'return [b.x + b.width / 2, b.y + b.height / 2]; })()')
        self.click(*place)

    def click(self, x: float, y: float) -> None:
        """Click at a place of the page [px]."""
        self.drag((x, y), (x, y))

    def drag(self, begin: tuple[float, float], end: tuple[float, float]) -> None:
        """Press the mouse at ``begin``, move to ``end`` and let go [px]."""
        self._mouse('mouseMoved', *begin)
        # What is under the mouse is found when the next image is drawn.
        time.sleep(0.3)
        self._mouse('mousePressed', *begin)
        for share in (0.25, 0.5, 0.75, 1.0) if end != begin else ():
            self._mouse('mouseMoved', *(
                first + share * (last - first) for first, last in zip(begin, end)))
            time.sleep(0.1)
        self._mouse('mouseReleased', *end)

    def _mouse(self, kind: str, x: float, y: float) -> None:
        self._call('Input.dispatchMouseEvent', type=kind, x=x, y=y, button=(
            'none' if kind == 'mouseMoved' else 'left'), clickCount=1)

    def _call(self, method: str, **parameters: Any) -> Any:
        self._number += 1
        self._socket.send(json.dumps(
            {'id': self._number, 'method': method, 'params': parameters}))
        while True:
            answer = json.loads(self._socket.recv(PATIENCE))
            if answer.get('id') == self._number:
                assert 'error' not in answer, f'{method}: {answer["error"]}'
                return answer['result']

    def _wait(self, value: Any, problem: str = 'the browser does not start') -> Any:
        deadline = time.monotonic() + PATIENCE
        while (found := value()) is None:
            assert time.monotonic() < deadline, problem
            assert self._process.poll() is None, 'the browser has ended'
            time.sleep(0.1)
        return found

    @staticmethod
    def _port(folder: Path) -> str | None:
        file = folder / 'DevToolsActivePort'
        lines = file.read_text().splitlines() if file.exists() else []
        return lines[0] if len(lines) > 1 else None
