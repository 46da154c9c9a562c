# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Checks of the values that a Python program passes: numbers, vectors, arrays, words, objects.

Each function returns the value in the type that the rest of the code works with, or raises a
ClothSimError that says what was requested, what came, and what to pass instead. True and False
are no numbers, text is no number, and a masked array is no array: each of them would otherwise be
taken for something that its writer did not mean.
"""

from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
import math
import operator
from os import fspath
from os import PathLike
from pathlib import Path
from typing import Any
from typing import TypeVar
import warnings

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

_Kind = TypeVar('_Kind')
# Kinds of dtype.
_NUMBERS, _INTEGERS = 'iuf', 'iu'
_XYZ = 'give x, y and z'


def integer(value: object, of: str, hint: str = 'give an int') -> int:
    """
    Return ``value`` as an int: an int, a NumPy integer, or whatever else has ``__index__``.

    :param of: its name in the error: 'the count of a grasp'
    :param hint: the way out, for the error
    """
    if not isinstance(value, (bool, np.bool_, np.ma.MaskedArray)):
        try:
            return operator.index(value)  # type: ignore[arg-type]
        except TypeError:
            pass
    raise ClothSimError(f'{of} must be a whole number, got {shown(value)}: {hint}')


def real_number(value: object, of: str, hint: str = 'give a float') -> float:
    """Return ``value`` as a float, which may be infinite or NaN; arguments as ``integer``."""
    found = _float(value)
    if found is None:
        raise ClothSimError(f'{of} must be a number, got {shown(value)}: {hint}')
    return found


def vector(
        values: object, of: str, unit: str = 'm', *, length: int = 3, verb: str = 'must be',
        hint: str = _XYZ) -> tuple[float, ...]:
    """
    Return ``values`` as so many finite floats.

    :param of: their name in the error
    :param unit: for the error; empty for none
    """
    found = vector_or_none(values, length)
    if found is None or not all(map(math.isfinite, found)):
        raise ClothSimError(
            f'{of} {verb} {length} finite numbers{f" [{unit}]" if unit else ""}, got '
            f'{_listed(values, found)}: {hint}')
    return found


def vector_or_none(values: object, length: int = 3) -> tuple[float, ...] | None:
    """Return ``values`` as so many floats, or None where they are something else."""
    if isinstance(values, (str, bytes, Mapping, np.ma.MaskedArray)):
        return None
    try:
        count = len(values)  # type: ignore[arg-type]
        # A long one is not looked through.
        found = [_float(value) for value in values] if count == length else []  # type: ignore
    except TypeError:
        return None
    numbers = tuple(each for each in found if each is not None)
    return numbers if len(numbers) == length else None


def array(
        values: object, of: str, shape: tuple[int, ...], hint: str = 'give one for each node',
        ) -> np.ndarray:
    """Return ``values`` as an array of float64 of ``shape``, which may hold NaN."""
    found = _array(values)
    if found is None or found.dtype.kind not in _NUMBERS or found.shape != shape:
        raise ClothSimError(
            f'{of} must be {shape} numbers, got {_described(values, found)}: {hint}')
    with np.errstate(over='ignore'):  # of float128, which becomes infinite
        return found.astype(float)


def vectors(values: object, of: str, hint: str = _XYZ) -> np.ndarray:
    """Return ``values`` as an array of float64, (..., 3), which may hold NaN."""
    found = _array(values)
    if found is None or found.dtype.kind not in _NUMBERS or found.shape[-1:] != (3,):
        raise ClothSimError(
            f'{of} must be (..., 3) numbers, got {_described(values, found)}: {hint}')
    with np.errstate(over='ignore'):  # of float128, which becomes infinite
        return found.astype(float)


def integers(values: object, of: str, hint: str = 'give a list of int') -> np.ndarray:
    """Return ``values``, one after the other, as an array of int64 of the shape they have."""
    if isinstance(values, Iterable) and not isinstance(
            values, (str, bytes, Mapping, Sequence, np.ndarray)):
        values = list(values)
    found = _array(values)
    # An empty list has no whole numbers in it, nor any others.
    if found is None or (found.size and found.dtype.kind not in _INTEGERS) or (
            found.size and found.max() > np.iinfo(np.int64).max):
        raise ClothSimError(
            f'{of} must be whole numbers, got {_described(values, found)}: {hint}')
    return found.astype(np.int64)


def booleans(values: object, of: str, shape: tuple[int, ...]) -> np.ndarray:
    """Return ``values`` as an array of bool of ``shape``."""
    found = _array(values)
    if found is None or found.dtype.kind != 'b' or found.shape != shape:
        raise ClothSimError(
            f'{of} must be {shape} of True and False, got {_described(values, found)}: give one '
            'for each node, as pinned_nodes() returns them')
    return found


def flag(value: object, of: str) -> bool:
    """Return ``value``, which is True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise ClothSimError(f'{of} must be True or False, got {shown(value)}: give one of them')
    return bool(value)


def word(value: object, of: str, hint: str = 'give a str') -> str:
    """Return ``value``, which is a str."""
    if not isinstance(value, str):
        raise ClothSimError(f'{of} must be text, got {shown(value)}: {hint}')
    return value


def path(value: object, of: str) -> Path:
    """Return ``value``, a str or a path object, as a Path."""
    if isinstance(value, str) or isinstance(value, PathLike) and isinstance(fspath(value), str):
        if '\0' not in fspath(value):
            return Path(value)
    raise ClothSimError(f'{of} must be a path, got {shown(value)}: give a str or a pathlib.Path')


def instance(value: object, kind: type[_Kind], of: str, hint: str) -> _Kind:
    """Return ``value``, which is of ``kind``."""
    if not isinstance(value, kind):
        raise ClothSimError(
            f'{of} must be a {kind.__name__}, got {_with_article(type(value).__name__)}: {hint}')
    return value


def mapping(value: object, of: str, hint: str) -> Mapping[Any, Any]:
    """Return ``value``, which is a dict or the like with names for its keys."""
    if not isinstance(value, Mapping):
        raise ClothSimError(
            f'{of} must be a dict, got {_with_article(type(value).__name__)}: {hint}')
    for name in value:
        if not isinstance(name, str):
            raise ClothSimError(f'{of} must have names as its keys, got {shown(name)}: {hint}')
    return value


def iterable(value: object, of: str, hint: str) -> list[Any]:
    """Return ``value``, which is a list or can be walked through, as a list."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable) or (
            isinstance(value, np.ndarray) and not value.ndim):
        raise ClothSimError(f'{of} must be a list, got {shown(value)}: {hint}')
    return list(value)


def _float(value: object) -> float | None:
    """Return ``value`` as a float, an int beyond them as an infinite one; None for no number."""
    if isinstance(value, (bool, str, bytes, bytearray, np.ma.MaskedArray)):
        return None
    # Arrays of one element, and dates, would become floats as well.
    if getattr(value, 'shape', ()) != () or (
            isinstance(value, (np.ndarray, np.generic)) and value.dtype.kind not in _NUMBERS):
        return None
    try:
        return float(value)  # type: ignore[arg-type]
    except OverflowError:
        return math.inf if value > 0 else -math.inf  # type: ignore[operator]
    except (TypeError, ValueError):
        return None


def _array(values: object) -> np.ndarray | None:
    if isinstance(values, np.ma.MaskedArray):
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # of masked elements, which become NaN
            return np.asarray(values)
    except (TypeError, ValueError, OverflowError):
        return None


def _described(values: object, found: np.ndarray | None) -> str:
    if isinstance(values, np.ma.MaskedArray):
        return 'a masked array, which filled() makes a plain one'
    if found is None or not found.ndim:
        return shown(values)
    return f'{found.shape} of {found.dtype}'


def _listed(values: object, found: tuple[float, ...] | None) -> str:
    if found is not None:
        return shown(list(found))
    if isinstance(values, np.ndarray):
        return _described(values, _array(values))
    return shown(list(values) if isinstance(values, tuple) else values)


def _with_article(name: str) -> str:
    return f'{"an" if name[0].lower() in "aeiou" else "a"} {name}'
