# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A ROS domain for a demo that nobody disturbs."""

from pathlib import Path
from runpy import run_path
import socket
import subprocess
import sys

SCRIPT = Path(__file__).resolve().parents[2] / 'scripts' / 'free_ros_domain.py'


def test_a_domain_with_a_listener_is_in_use():
    """Two demos on one machine would push each other's cloth."""
    script = run_path(str(SCRIPT))
    with socket.socket(type=socket.SOCK_DGRAM) as listener:
        listener.bind(('127.0.0.1', 0))
        domain = (listener.getsockname()[1] - script['FIRST_PORT']) // script['PORTS']
        sockets = Path('/proc/net/udp').read_text()
    assert domain in script['domains_in_use'](sockets)


def test_prints_a_domain_that_ros_takes():
    """The demo's node would not start."""
    done = subprocess.run([sys.executable, SCRIPT], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert 215 <= int(done.stdout) <= 232
