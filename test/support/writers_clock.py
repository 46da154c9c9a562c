# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A clock that stands still while machine or disk hold up who writes as a recording does."""

import math
import os
from pathlib import Path
import threading
import time

_PERIOD = 0.02  # [s]
_BLOCK = bytes(4096)


class WritersClock:
    """
    Append to a file in ``folder`` and replace another, each 20 ms; a context manager.

    Each turn counts as 20 ms, however long it has taken: by this clock, no time goes by while the
    disk holds up a turn or the machine stands still.
    """

    def __init__(self, folder: Path) -> None:
        """Prepare; nothing is written yet."""
        folder.mkdir(parents=True, exist_ok=True)
        self._appended = folder / 'clock.appended'
        self._replaced = folder / 'clock.replaced'
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._write, name='clock')
        self._turns: list[float] = []

    def __enter__(self) -> 'WritersClock':
        """Begin."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """End, and remove the files."""
        self._done.set()
        self._thread.join()
        self._appended.unlink(missing_ok=True)
        self._replaced.unlink(missing_ok=True)

    def before(self, period: float) -> float:
        """Return the wall time [s] that was ``period`` [s] ago by this clock."""
        number = math.ceil(period / _PERIOD)
        return self._turns[-number] if len(self._turns) >= number else -math.inf

    def _write(self) -> None:
        descriptor = os.open(self._appended, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            while not self._done.wait(_PERIOD):
                os.write(descriptor, _BLOCK)
                fresh = self._replaced.with_suffix('.fresh')
                fresh.write_bytes(_BLOCK)
                fresh.replace(self._replaced)
                self._turns.append(time.time())
        finally:
            os.close(descriptor)
