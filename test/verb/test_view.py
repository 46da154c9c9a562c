# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim view` as a user starts it."""

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import re
import signal
import subprocess
import sys

from cloth_sim_ros.verb.main import main
from command import cloth_sim
import pytest
from served_view import free_port
from view_page import ViewPage

ROOT = Path(__file__).resolve().parents[2]
TOWEL = ROOT / 'config' / 'towel.yaml'
SMALL = ('--set', 'rows=10', '--set', 'cols=6')


@contextmanager
def started(*arguments: object) -> Iterator[tuple[str, ViewPage]]:
    """Start a view, and yield the line that it begins with and a page of it; Ctrl-C ends it."""
    port = free_port()
    view = subprocess.Popen(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'view', *map(str, arguments), '--port',
         str(port)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        # In the background of a shell SIGINT is ignored, by all that is started there.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    try:
        line = view.stdout.readline()
        address = re.search(rf'http://127\.0\.0\.1:{port}/[\w-]{{20,}}', line)
        assert address, view.communicate()
        with ViewPage(address[0]) as page:
            yield line, page
        view.send_signal(signal.SIGINT)
        out, errors = view.communicate(timeout=300.0)
        assert (view.returncode, out, errors) == (130, '', '')
    finally:
        view.kill()
        view.wait()


def shown_time(page: ViewPage) -> float:
    """Return the simulated time that the page tells [s]."""
    return float(re.search(r't = ([\d.]+) s', page.text)[1])


def test_a_scene_is_simulated_for_the_view():
    """A user without ROS could not see a cloth move."""
    with started(TOWEL, *SMALL, '--set', 'total_mass=0.3') as (line, page):
        assert line.startswith('towel is shown at http://127.0.0.1:')
        page.wait_for(lambda: '**towel**, running' in page.text, 'the scene')
        # However few of its frames a busy machine shows.
        page.wait_for(lambda: shown_time(page) >= 0.1, 'time that goes on')
        assert '2 pins' in page.text


def test_a_recording_is_shown_without_ros():
    """Somebody without ROS could not look at a recording."""
    with started(ROOT / 'bags' / 'example', '--paused') as (line, page):
        page.wait_for(lambda: '**example**, paused' in page.text, 'the recording')


@pytest.mark.parametrize(('arguments', 'told'), [
    (['--set', 'rows=3'], '--set changes a scene: give a scene file (.yaml) to show'),
    (['nothing.yaml'], 'nothing.yaml cannot be read'),
    (['nothing'], 'nothing'),
    ([str(TOWEL), '--set', 'rows=0'], 'rows 0 is outside its range'),
    ([str(TOWEL), '--port', '0'], '--port must be from 1 to 65535'),
    ([str(TOWEL), '--fps', '0'], '--fps must be above 0'),
    (['--node', 'nobody', '--timeout', '0.5'], 'no message arrives on /nobody/state within 0.5 s'),
    (['--node', 'a b', '--timeout', '0.5'], 'is not a node name'),
], ids=lambda value: ' '.join(value)[-30:] if isinstance(value, list) else '')
def test_what_is_wrong_is_told(capsys, arguments: list[str], told: str):
    """A mistake would end in a traceback, or in a page that stays empty."""
    port = [] if '--port' in arguments else ['--port', str(free_port())]
    assert main(['view', *arguments, *port]) == 1
    error = capsys.readouterr().err.splitlines()[-1]
    assert error.startswith('cloth_sim view: ') and told in error


def test_without_viser_one_sentence_tells_the_way_out():
    """The optional package would be missed with a traceback."""
    done = cloth_sim(
        'view', str(TOWEL), before='import sys; sys.modules["viser"] = None')
    assert done.returncode == 1
    assert done.stderr == (
        'cloth_sim view: viser, which shows the cloth in a browser, is missing: run '
        '`./scripts/setup.sh --view`, or `pip install viser`\n')


def test_scenes_and_recordings_need_no_ros(tmp_path: Path):
    """The view would need what it does not use."""
    blocked = (
        'import sys\n'
        'for name in ("rclpy", "sensor_msgs", "cloth_sim_interfaces", "std_srvs"):\n'
        '    sys.modules[name] = None')
    done = cloth_sim('view', 'nothing.yaml', before=blocked, cwd=tmp_path)
    assert 'nothing.yaml cannot be read' in done.stderr
    done = cloth_sim(
        'view', str(tmp_path), before=blocked, env={**os.environ, 'AMENT_PREFIX_PATH': ''})
    assert done.returncode == 1 and 'ROS 2 was not found' not in done.stderr
