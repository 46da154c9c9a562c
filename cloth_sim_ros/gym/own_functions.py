# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Functions of users, for rewards and observations of their own, and what they may return."""

from collections.abc import Callable
import inspect

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

# Positions [m] and velocities [m/s] of n cloths, (n, rows, cols, 3) float32 each, NaN where a
# shape has no node, to an array of n rows.
OwnFunction = Callable[[np.ndarray, np.ndarray], np.ndarray]


def checked_function(value: object, name: str) -> OwnFunction:
    """Return ``value``, or raise ClothSimError when it is no function of two arguments."""
    if callable(value) and not isinstance(value, type):
        try:
            inspect.signature(value).bind(None, None)
        except TypeError:
            pass
        except ValueError:  # of some that are written in C: nobody can tell
            return value
        else:
            return value
    raise ClothSimError(
        f'{name} must be a function of positions and velocities, got {shown(value)}: give one '
        'that takes both')


def asked(
        function: OwnFunction, name: str, positions: np.ndarray, velocities: np.ndarray,
        shape: tuple[int, ...] | None = None) -> np.ndarray:
    """
    Return what ``function`` does of n cloths, (n, *shape).

    :param name: of the function in errors
    :param positions: (n, rows, cols, 3) [m]
    :param velocities: (n, rows, cols, 3) [m/s]
    :param shape: of a row; None for any
    :raises ClothSimError: when it returns something else, or numbers that are not finite
    """
    count = len(positions)
    expected = f'({count}, ...)' if shape is None else f'{(count, *shape)}'
    try:
        found = np.asarray(function(positions, velocities))
    except ValueError as error:  # of rows of several lengths
        raise ClothSimError(
            f'{name} must return {expected} numbers, got none, as {error}: return one row for '
            'each cloth') from error
    is_right = found.shape[:1] == (count,) if shape is None else found.shape == (count, *shape)
    if found.dtype.kind not in 'iuf' or not is_right:
        raise ClothSimError(
            f'{name} must return {expected} numbers, got {found.shape} of {found.dtype}: return '
            'one row for each cloth')
    if not np.isfinite(found).all():
        bad = found[~np.isfinite(found)][0]
        raise ClothSimError(
            f'{name} must return finite numbers, got {bad}: leave out nodes that a shape does not '
            'have, and do not divide by 0')
    return found
