# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Run verbs by the hundred, each in a process of its own, that has all modules loaded already.

Run as a program this is the process that forks: it reads a request a line and answers each.
"""

from contextlib import redirect_stdout
from importlib import import_module
import json
import os
from pathlib import Path
import resource
import signal
import subprocess
import sys
import tempfile
import time
from typing import Any
from typing import NamedTuple

# Loaded once, so that a case takes no longer than what it reads.
MODULES = (
    'cloth_sim_ros.verb.main', 'cloth_sim_ros.verb.info', 'cloth_sim_ros.verb.analyze',
    'cloth_sim_ros.verb.render', 'cloth_sim_ros.verb.resimulate', 'cloth_sim_ros.verb.run',
    'cloth_sim_ros.verb.play', 'cloth_sim_ros.verb.export', 'cloth_sim_ros.analysis.plots',
    'PIL.Image', 'trimesh',
    'rosbags.typesys.stores.ros2_jazzy', 'zstandard', 'lz4.frame')
# Limit of the address space [bytes], so that a hostile file can't exhaust the machine.
_MOST_MEMORY = 12 << 30


class Outcome(NamedTuple):
    """
    What became of a verb.

    :param code: its exit code, or minus the signal that ended it
    :param seconds: on processors: others may keep the machine busy
    :param memory: most that was resident [bytes]
    """

    code: int
    seconds: float
    memory: int
    out: str
    err: str


class ForkedVerbs:
    """A context manager with the process that forks."""

    def __enter__(self) -> 'ForkedVerbs':
        """Start it."""
        self._process = subprocess.Popen(
            [sys.executable, str(Path(__file__))], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, text=True,
            env={**os.environ, 'OPENBLAS_NUM_THREADS': '1', 'LP_NUM_THREADS': '0'})
        return self

    def __exit__(self, *_: object) -> None:
        """End it."""
        self._process.stdin.close()
        self._process.wait(300)

    def run(self, *arguments: object, limit: float = 600.0) -> Outcome:
        """Run `cloth_sim` with ``arguments``, for ``limit`` seconds of wall time at most."""
        request = {'arguments': [str(each) for each in arguments], 'limit': limit}
        print(json.dumps(request), file=self._process.stdin, flush=True)
        return Outcome(**json.loads(self._process.stdout.readline()))

    def warm_up(self, *arguments: object) -> None:
        """Run a verb without a device, so that all others start with its imports loaded."""
        request = {'arguments': [str(each) for each in arguments], 'limit': None}
        print(json.dumps(request), file=self._process.stdin, flush=True)
        self._process.stdout.readline()


def _forked(arguments: list[str], limit: float) -> dict[str, Any]:
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begin = time.monotonic()
        child = os.fork()
        if not child:
            _become(arguments, out.fileno(), err.fileno())
        done, status, usage = os.wait4(child, os.WNOHANG)
        while not done:
            if time.monotonic() - begin > limit:
                os.kill(child, signal.SIGKILL)
            time.sleep(0.003)
            done, status, usage = os.wait4(child, os.WNOHANG)
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read().decode(errors='replace'))
    return {
        'code': os.waitstatus_to_exitcode(status), 'seconds': usage.ru_utime + usage.ru_stime,
        'memory': usage.ru_maxrss << 10, 'out': texts[0], 'err': texts[1]}


def _become(arguments: list[str], out: int, err: int) -> None:
    code = 70
    try:
        os.dup2(out, 1)
        os.dup2(err, 2)
        resource.setrlimit(resource.RLIMIT_AS, (_MOST_MEMORY, _MOST_MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        code = import_module('cloth_sim_ros.verb.main').main(arguments)
    except SystemExit as error:
        code = error.code
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


if __name__ == '__main__':
    for name in MODULES:
        import_module(name)
    for line in sys.stdin:
        request = json.loads(line)
        if request['limit'] is None:
            with redirect_stdout(sys.stderr):
                import_module('cloth_sim_ros.verb.main').main(request['arguments'])
        print(json.dumps(_forked(**request) if request['limit'] else {}), flush=True)
