# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
How stiff the springs of a scene are: as it says, or as they follow from its material.

A lattice with springs k_row and k_col along rows and columns and k_shear along both diagonals of
cells dx x dy, of length l, is a sheet with (docs/explanation/numerics.md derives it)

    K_warp = k_row dx / dy + 2 k_shear dx^3 / (dy l^2)     G = C12 = 2 k_shear dx dy / l^2
    K_weft = k_col dy / dx + 2 k_shear dy^3 / (dx l^2)

in N/m, forces per width. For square cells these are k_row + k_shear, k_col + k_shear and k_shear.
"""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError

# Along rows and along columns: places in what has two values.
WARP, WEFT = range(2)
# Of a scene that has a material, these are 0.
MATERIAL_SPRINGS = ('stiffness.structural', 'stiffness.shear')
MATERIAL = ('material.warp', 'material.weft', 'material.shear')


def of_direction(value: float | tuple[float, float], direction: int | None) -> float:
    """Return the part of one value or two that a direction has, or the larger one for None."""
    if not isinstance(value, tuple):
        return value
    return max(value) if direction is None else value[direction]


def spring_stiffness(
        values: Mapping[str, Any], spacing: tuple[float, float],
        shape: tuple[int, int]) -> dict[str, float | tuple[float, float]]:
    """
    Return the stiffness of each family of springs [N/m]: one value, or those of warp and weft.

    :param values: checked ones, of all scene parameters
    :param spacing: of neighbours along a row and along a column [m]
    :param shape: rows and columns of nodes
    :raises ClothSimError: for springs beside a material, and for a material that no springs have
    """
    stiffness = {
        family: values[f'stiffness.{family}'] for family in ('structural', 'shear', 'bend')}
    given = [name for name in MATERIAL if values[name] > 0.0]
    if not given:
        return stiffness
    for name in MATERIAL_SPRINGS:
        value = values[name]
        if of_direction(value, None) > 0.0:
            raise ClothSimError(
                f'{name} {_written(value)} and {given[0]} {values[given[0]]:g} both say how the '
                'cloth stretches: give one of them, and set the other to 0')
    if not values['material.warp'] > 0.0:
        raise ClothSimError(
            f'{given[0]} {values[given[0]]:g} stands without material.warp: give that too, in N/m')
    return {**stiffness, **_springs_of(values, spacing, shape)}


def _springs_of(
        values: Mapping[str, Any], spacing: tuple[float, float],
        shape: tuple[int, int]) -> dict[str, float | tuple[float, float]]:
    """Return the springs that make a sheet of the material [N/m]."""
    warp, shear = values['material.warp'], values['material.shear']
    weft = values['material.weft'] or warp
    if min(shape) < 2:
        # A chain has no diagonals.
        shear = 0.0
    ratio = spacing[0] / spacing[1]
    # What is left of each direction when the diagonals have their part.
    left = warp - shear * ratio**2, weft - shear / ratio**2
    if min(left) < 0.0:
        largest = min(warp / ratio**2, weft * ratio**2)
        raise ClothSimError(
            f'material.shear {shear:g} needs diagonals that are stiffer along the cloth than its '
            f'material, in cells of {spacing[0]:g} x {spacing[1]:g} m: take at most '
            f'{largest:.3g}, or cells that are nearer to squares')
    return {
        'structural': (left[WARP] / ratio, left[WEFT] * ratio),
        'shear': shear * 0.5 * (ratio + 1.0 / ratio)}


def _written(value: float | tuple[float, float]) -> str:
    if isinstance(value, tuple):
        return f'[{", ".join(f"{part:g}" for part in value)}]'
    return f'{value:g}'
