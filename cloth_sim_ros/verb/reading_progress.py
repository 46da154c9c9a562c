# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A progress bar over the messages of recordings."""

from collections.abc import Iterable
from collections.abc import Iterator

from cloth_sim_ros.analysis.recording import Entry
from tqdm import tqdm


class ReadingProgress:
    """
    Shows how much has been read, of all recordings it is given together.

    The bar goes away at the end, and before an error is told.

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
