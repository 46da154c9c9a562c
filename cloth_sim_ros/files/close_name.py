# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which name was probably meant by a mistyped one."""

from collections.abc import Iterable

from cloth_sim_ros.files.errors import ClothSimError
from cloth_sim_ros.files.errors import MOST_SHOWN
from cloth_sim_ros.files.errors import shown

# A name may have one slip, and one more for every six characters: chosen. So holes, two slips from
# cols, is another name.
_FOR_EACH = 6
_MOST_EDITS = 3


def close_name(name: str, known: Iterable[str]) -> str | None:
    """Return the closest of ``known`` within a few edits of ``name``; None if there is none."""
    # A name longer than a message shows is not a typing error, and takes long to compare.
    if len(name) > MOST_SHOWN:
        return None
    most = min(1 + len(name) // _FOR_EACH, _MOST_EDITS)
    near = [(edits(name, each), each) for each in known if abs(len(each) - len(name)) <= most]
    least, closest = min(near, default=(most + 1, ''))
    return closest if least <= most else None


def refuse_unknown(kind: str, names: Iterable[str], known: Iterable[str]) -> None:
    """
    Raise ClothSimError for the first of ``names`` that is not among ``known``.

    :param kind: what the names are names of, in one word
    """
    known = list(known)
    for name in names:
        if name not in known:
            close = close_name(name, known)
            raise ClothSimError(
                f'there is no {kind} {shown(name)}: '
                + (f'did you mean {close}?' if close else f'take one of {", ".join(known)}'))


def edits(name: str, other: str) -> int:
    """
    Return by how many slips the two differ.

    A slip is a character too many, one missing, another one, or two that changed places (the
    optimal string alignment).
    """
    before: list[int] = []
    last = list(range(len(other) + 1))
    for row, char in enumerate(name, 1):
        here = [row]
        for col, wanted in enumerate(other, 1):
            cost = min(last[col] + 1, here[col - 1] + 1, last[col - 1] + (char != wanted))
            if row > 1 and col > 1 and (char, name[row - 2]) == (other[col - 2], wanted):
                cost = min(cost, before[col - 2] + 1)
            here.append(cost)
        before, last = last, here
    return last[-1]
