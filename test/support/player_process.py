# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim play` in a process of its own."""

from pathlib import Path
import signal
import subprocess
import sys
import time

from graph_client import GraphClient
from graph_client import PATIENCE
from rclpy.task import Future
from std_srvs.srv import SetBool

_START = 'import sys; from cloth_sim_ros.verb.main import main; sys.exit(main())'
PLAYER = '/cloth_sim_player'


class PlayerProcess:
    """
    Play a recording; a context manager that ends it.

    :param folder: gets the output
    :param arguments: of `cloth_sim play`
    """

    def __init__(self, folder: Path, *arguments: object) -> None:
        """Start the process."""
        self._out = folder / 'player.out'
        self._err = folder / 'player.err'
        with self._out.open('w') as out, self._err.open('w') as err:
            self.process = subprocess.Popen(
                [sys.executable, '-c', _START, 'play', *map(str, arguments)],
                stdout=out, stderr=err)

    def __enter__(self) -> 'PlayerProcess':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the process, whatever its state."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    @property
    def output(self) -> str:
        """Get what was printed so far."""
        return self._out.read_text()

    @property
    def problems(self) -> str:
        """Get what was printed as errors so far."""
        return self._err.read_text()

    def resume(self, client: GraphClient) -> None:
        """Let a player go on that was started with --paused, as soon as both know each other."""
        self._call(client, True, False)

    def pause(self, client: GraphClient) -> None:
        """Let it stop."""
        self._call(client, True)

    def send(self, number: signal.Signals) -> None:
        """Send a signal to this process and no other."""
        self.process.send_signal(number)

    def wait(self, client: GraphClient) -> int:
        """Take in messages until it has ended, and return the exit code."""
        client.spin_until(lambda: self.process.poll() is not None, 'the player ends')
        client.spin_until_quiet()
        return self.process.returncode

    def _call(self, client: GraphClient, *pauses: bool) -> None:
        # Each learns of the other's endpoints in the order they were made. The player offers its
        # service last, and answers a client that is new here, when it knows all that is older.
        # An answer to one that it does not know yet gets lost, but not the call: so the first
        # call must be one that may come several times.
        service = client.node.create_client(SetBool, f'{PLAYER}/pause')
        deadline = time.monotonic() + PATIENCE
        for data in pauses:
            asked: list[Future] = []
            while not any(future.done() for future in asked):
                if asked and not data and self.process.poll() == 0:
                    break  # it has played all before its answer came
                assert self.process.poll() is None, f'the player has ended: {self.problems}'
                assert time.monotonic() < deadline, f'the player is silent: {self.problems}'
                client.spin_for(0.02)
                if service.service_is_ready():
                    asked.append(service.call_async(SetBool.Request(data=data)))
                    end = time.monotonic() + 0.5
                    while not asked[-1].done() and time.monotonic() < end:
                        client.spin_for(0.02)
        client.node.destroy_client(service)
