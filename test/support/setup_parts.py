# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Run functions of scripts/setup/*.sh on their own."""

from pathlib import Path
import shlex
import signal
import subprocess

PARTS = Path(__file__).resolve().parents[2] / 'scripts' / 'setup'


def start_bash(names: str, command: str, folder: Path, **variables: str) -> subprocess.Popen:
    """Start ``command`` in a session of its own, after the parts, as scripts/setup.sh would."""
    lines = [f'{name}={shlex.quote(str(value))}' for name, value in variables.items()]
    lines += [f'. {shlex.quote(str(PARTS))}/{name}.sh' for name in names.split()]
    return subprocess.Popen(
        ['bash', '-euo', 'pipefail', '-c', '\n'.join([*lines, command])], cwd=folder,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        start_new_session=True,
        # A shell that was started with a signal ignored, by nohup for instance, can't trap it.
        preexec_fn=_listen)


def _listen() -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def run_bash(names: str, command: str, folder: Path, **variables: str) -> tuple[int, str]:
    """Run ``command`` as start_bash does; return exit code and output."""
    process = start_bash(names, command, folder, **variables)
    # A machine that is busy otherwise compiles all shaders for more than a minute.
    output = process.communicate(timeout=1200.0)[0]
    return process.returncode, output
