# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth_sim_node in a process of its own."""

from collections.abc import Mapping
import os
from pathlib import Path
import signal
import subprocess
import sys
import time
from typing import Any

import yaml

_START = 'import sys; from cloth_sim_ros.node.main import main; sys.exit(main())'
# A machine that is busy besides may let a node run for a tenth of the time.
PATIENCE = 300.0
_SHOWN = 5000  # characters


class NodeProcess:
    """
    Start a node with parameters from a file; a context manager that stops it.

    :param folder: working directory of the node, gets the parameter file and its output
    :param parameters: dotted names and values
    :param arguments: more of the command line
    :param environment: added to this process's own
    """

    def __init__(
            self, folder: Path, parameters: Mapping[str, Any] | None = None, *arguments: str,
            environment: Mapping[str, str] | None = None, start: str = _START) -> None:
        """Start the process."""
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        file = folder / 'parameters.yaml'
        file.write_text(yaml.safe_dump({'/**': {'ros__parameters': dict(parameters or {})}}))
        from_file = ('--params-file', str(file)) if parameters else ()
        self._log = folder / 'node.log'
        with self._log.open('w') as log:
            self._process = subprocess.Popen(
                [sys.executable, '-c', start, '--ros-args', *from_file, *arguments],
                cwd=folder, stdout=log, stderr=subprocess.STDOUT,
                env={**os.environ, **(environment or {})})

    def __enter__(self) -> 'NodeProcess':
        """Return itself."""
        return self

    def __exit__(self, kind: type | None, *_: object) -> None:
        """Stop the node, whatever its state; a test that fails prints what the node said."""
        if kind is not None:
            print(self.output[-_SHOWN:])
        if self._process.poll() is None:
            self.send(signal.SIGINT)
        try:
            self.wait()
        finally:
            self._process.kill()

    @property
    def output(self) -> str:
        """Get what the node has printed so far."""
        return self._log.read_text()

    @property
    def pid(self) -> int:
        """Get the number of the process."""
        return self._process.pid

    @property
    def running(self) -> bool:
        """Return whether the process is there."""
        return self._process.poll() is None

    def wait_until_it_runs(self) -> None:
        """Wait until its shaders are compiled and the cloth is there, or the node has ended."""
        while self.running and ' nodes in mode ' not in self.output:
            time.sleep(0.01)

    def send(self, number: signal.Signals) -> None:
        """Send a signal to this process and no other."""
        self._process.send_signal(number)

    def wait(self) -> int:
        """Wait for the end and return the exit code."""
        return self._process.wait(PATIENCE)
