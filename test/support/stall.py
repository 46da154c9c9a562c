# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long machine and disk hold up a process that writes as a recording does."""

import os
from pathlib import Path
import threading
import time

_PERIOD = 0.02  # [s]
_BLOCK = bytes(4096)


class Stall:
    """
    Append to a file in ``folder`` and replace another, each 20 ms; a context manager.

    What that took longer is what others may have been held up for, too: by the disk, or by a
    machine that stood still for a while.
    """

    def __init__(self, folder: Path) -> None:
        """Prepare; nothing is written yet."""
        folder.mkdir(parents=True, exist_ok=True)
        self._appended = folder / 'stall.appended'
        self._replaced = folder / 'stall.replaced'
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._write, name='stall')
        self._last = 0.0
        self._longest = 0.0

    def __enter__(self) -> 'Stall':
        """Begin."""
        self._last = time.monotonic()
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """End, and remove the files."""
        self._done.set()
        self._thread.join()
        self._appended.unlink()
        self._replaced.unlink(missing_ok=True)

    @property
    def longest(self) -> float:
        """Get the longest time by which a turn has come late, or is late, so far [s]."""
        return max(self._longest, time.monotonic() - self._last - _PERIOD)

    def _write(self) -> None:
        descriptor = os.open(self._appended, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            while not self._done.wait(_PERIOD):
                os.write(descriptor, _BLOCK)
                fresh = self._replaced.with_suffix('.fresh')
                fresh.write_bytes(_BLOCK)
                fresh.replace(self._replaced)
                self._longest = self.longest
                self._last = time.monotonic()
        finally:
            os.close(descriptor)
