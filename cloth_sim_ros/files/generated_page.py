# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A page of the docs whose figures a command writes, between text that people write."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cloth_sim_ros.files.errors import ClothSimError
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.regular_file import read_regular

# Max. size of a page [bytes]; chosen: a thousand times the largest one.
_PAGE_LIMIT = 2**25


class GeneratedPage:
    """
    A page that text is written into: between two lines where it has them, else all of it.

    ``written`` is the text between them; empty without them.

    :param begin: line before the text that is written
    :param end: line after it
    :raises ClothSimError: if the file can't be read, its folder is not there, or it has one of
        both lines alone
    """

    def __init__(self, path: Path, begin: str, end: str) -> None:
        """Read what stands around the text, before minutes of measuring."""
        self._path = path
        self._begin, self._end = begin, end
        with self._errors_named():
            path.parent.stat()
            page = (
                read_regular(path, _PAGE_LIMIT).decode() if path.exists()
                else f'{begin}\n{end}\n')
            if (begin in page) != (end in page):
                raise ClothSimError(
                    f'{shown(str(path))} has one of the two lines that the written text stands '
                    f'between: write both, {begin} and {end}')
        self._before, found, rest = page.partition(begin)
        self.written, _, self._after = rest.partition(end)
        self._has_place = bool(found)

    def write(self, text: str) -> None:
        """
        Write the text.

        :raises ClothSimError: if the file can't be written
        """
        if self._has_place:
            text = f'{self._before}{self._begin}\n\n{text}\n{self._end}{self._after}'
        with self._errors_named():
            self._path.write_text(text, encoding='utf-8')

    @contextmanager
    def _errors_named(self) -> Iterator[None]:
        try:
            yield
        except (OSError, UnicodeDecodeError) as error:
            raise ClothSimError(
                f'{shown(str(self._path))} can not be written: {error}: choose another file'
            ) from None
