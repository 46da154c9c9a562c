# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One configurable value: its name, unit, range, default and text, said once."""

from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError

# Of a list.
MOST_ELEMENTS = 100_000
_NAMES = {
    bool: 'true or false', int: 'a whole number', float: 'a number', str: 'a word',
}


@dataclass(frozen=True)
class Field:
    """
    A parameter of the scene or of the node.

    :param name: ROS parameter name, dots group
    :param kind: bool, int, float or str; of the elements when ``is_array``
    :param default: used when nothing is given; a tuple when ``is_array``
    :param text: one line for people
    :param unit: SI unit, empty when there is none
    :param low: smallest value allowed
    :param high: largest value allowed
    :param choices: the values allowed, for words
    :param words: what may be given, for words that cannot be counted
    :param is_array: True for a list of ``kind``
    :param is_pair: True for one value, or a list of two: of warp and of weft
    :param live: True when a running node accepts a new value
    """

    name: str
    kind: type
    default: Any
    text: str
    unit: str = ''
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    words: str = ''
    is_array: bool = False
    is_pair: bool = False
    live: bool = False

    def check(self, value: Any) -> Any:
        """Return ``value`` in this field's type; ClothSimError says what is wrong with it."""
        if self.is_pair and isinstance(value, Sequence) and not isinstance(value, str):
            return self._check_pair(value)
        if not self.is_array:
            return self._check_one(value)
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise ClothSimError(
                f'{self.name} must be a list, got {shown(value)}: write {self._list_with(value)}')
        if len(value) > MOST_ELEMENTS:
            raise ClothSimError(
                f'{self.name} has {len(value)} elements: give at most {MOST_ELEMENTS}')
        return tuple(self._check_one(element) for element in value)

    def _check_pair(self, values: Sequence[Any]) -> tuple[Any, ...]:
        if len(values) != 2:
            raise ClothSimError(
                f'{self.name} takes one value, or one for warp and one for weft, got '
                f'{len(values)}: write a number or [warp, weft]')
        return tuple(self._check_one(value) for value in values)

    def _check_one(self, value: Any) -> Any:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if self.kind is float and is_number:
            value = _as_float(value)
        if self.choices and value not in self.choices:
            raise ClothSimError(
                f'{self.name} must be one of {", ".join(self.choices)}, got {shown(value)}')
        is_kind = type(value) is self.kind
        if not is_kind:
            raise ClothSimError(
                f'{self.name} must be {_NAMES[self.kind]}, got {shown(value)}{self._way_out()}')
        if self.kind is float and not math.isfinite(value):
            raise ClothSimError(f'{self.name} must be finite, got {shown(value)}{self._way_out()}')
        too_low = self.low is not None and value < self.low
        too_high = self.high is not None and value > self.high
        if too_low or too_high:
            raise ClothSimError(
                f'{self.name} {shown(value)} is outside its range{self._way_out()}')
        return value

    def _list_with(self, value: Any) -> str:
        if self.kind is str and isinstance(value, str):
            return f'["{cut(value)}"]'
        return f'[...], as in {list(self.default)}' if self.default else '[...]'

    def _way_out(self) -> str:
        if self.words:
            return f': give {self.words}'
        unit = f' {self.unit}' if self.unit else ''
        if self.low is not None and self.high is not None:
            return f': give a value from {self.low:g} to {self.high:g}{unit}'
        return f': give a value in {self.unit}' if self.unit else ''


def _as_float(number: int | float) -> float:
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf
