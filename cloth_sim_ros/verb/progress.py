# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Progress bars on a terminal: over the messages of recordings, and over playing."""

from collections.abc import Iterable
from collections.abc import Iterator
import sys

from cloth_sim_ros.analysis.recording import Entry
from tqdm import tqdm


class ReadingProgress:
    """
    Shows how much has been read, of all recordings it is given together.

    The bar disappears at the end, and before an error is printed.

    :param name: of what is read
    """

    def __init__(self, name: str) -> None:
        """Show nothing yet."""
        self._bar = tqdm(
            total=0, desc=name, unit=' messages', mininterval=0.2, delay=0.2, leave=False,
            disable=None)
        self._walks = 0

    def __call__(self, entries: Iterable[Entry], count: int) -> Iterator[Entry]:
        """Hand ``entries``, of which there are ``count``, on."""
        self._bar.total += count
        self._walks += 1
        try:
            for entry in entries:
                self._bar.update()
                yield entry
        finally:
            self._walks -= 1
            if not self._walks:
                self._bar.close()


# How far playing has come, on a terminal.

_BAR = '{percentage:3.0f}% |{bar}| {n:.2f}/{total:.2f} s'


class PlayProgress:
    """A progress bar, shown where somebody watches; a context manager that removes it."""

    def __init__(self) -> None:
        """Show nothing yet."""
        self._bar: tqdm | None = None
        self._start = 0.0

    def __enter__(self) -> 'PlayProgress':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the terminal in order."""
        if self._bar is not None:
            self._bar.close()

    def begin(self, start: float, end: float) -> None:
        """Show a bar from ``start`` to ``end`` [s] of the recording."""
        self._start = start
        self._bar = tqdm(
            total=end - start, bar_format=_BAR, mininterval=0.1, leave=False, disable=None)

    def show(self, seconds: float) -> None:
        """Show that all up to ``seconds`` of the recording is played."""
        if self._bar is None or self._bar.disable:
            return
        done = min(seconds - self._start, self._bar.total)
        if done < self._bar.n:
            self._bar.reset()
        self._bar.update(done - self._bar.n)

    def warn(self, sentence: str) -> None:
        """Print a sentence above the bar."""
        tqdm.write(f'cloth_sim play: {sentence}', file=sys.stderr)
