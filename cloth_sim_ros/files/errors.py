# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Errors of refused input, and how much of the input their text repeats."""


class ClothSimError(ValueError):
    """A request that cannot be carried out; it has changed nothing."""


class NotFoundError(ClothSimError):
    """The object that a request names does not exist."""


class NameTakenError(ClothSimError):
    """A name is in use already."""


class WrongStateError(ClothSimError):
    """The request could be carried out at another time."""


# Inputs quoted in error messages, shortened.

# Max. length of a quoted input [characters]: enough to find it again.
MOST_SHOWN = 200
# Characters read per character shown [1]; blanks and line ends among them are dropped.
_SPARE = 4


def shown(value: object) -> str:
    """Return ``value`` as Python writes it, cut after MOST_SHOWN characters."""
    # repr() of a large value takes seconds.
    part, length = value, 0
    if isinstance(value, (str, bytes, list, tuple)):
        part, length = value[:MOST_SHOWN + 1], len(value)
    try:
        text = repr(part)
    except ValueError:
        return 'a number with too many digits'  # Python writes no more than 4300
    if length <= MOST_SHOWN + 1:
        return cut(text)
    return f'{text[:MOST_SHOWN]}... (a length of {length})'


def cut(text: object, most: int = MOST_SHOWN) -> str:
    """Return ``text`` as one line that a terminal can show, cut after ``most`` characters."""
    text = str(text)
    line = ' '.join(text[:_SPARE * most].split())
    line = ''.join(each if each.isprintable() else repr(each)[1:-1] for each in line)
    if len(line) <= most and len(text) <= _SPARE * most:
        return line
    return f'{line[:most]}... (a length of {len(text)})'
