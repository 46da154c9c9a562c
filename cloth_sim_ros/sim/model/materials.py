# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The stiffness of springs, given by a scene, or derived from a material or fabric."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import NO_PRESET

# How stiff the springs of a scene are: as given, or derived from its material.
#
# A lattice with springs k_row and k_col along rows and columns and k_shear along both diagonals of
# cells dx x dy, of length l, is a sheet with (docs/explanation/numerics.md derives it)
#
#     K_warp = k_row dx / dy + 2 k_shear dx^3 / (dy l^2)     G = C12 = 2 k_shear dx dy / l^2
#     K_weft = k_col dy / dx + 2 k_shear dy^3 / (dx l^2)
#
# in N/m, forces per width. For square cells these are k_row + k_shear, k_col + k_shear and
# k_shear.

# Along rows and along columns: places in what has two values.
WARP, WEFT = range(2)
# Fields that are 0 in a scene with a material.
MATERIAL_SPRINGS = ('stiffness.structural', 'stiffness.shear')
MATERIAL = ('material.warp', 'material.weft', 'material.shear')
SOURCE = "Wang, O'Brien, Ramamoorthi 2011, DOI 10.1145/2010324.1964966"
_CEILING = 'at least this stiff: the fit ends there'
_STIFFENS = 'stiffens: value at the largest strain'
# Micronewton metres in a newton metre [1].
_MICRO = 1e-6


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
            f'{largest:.3g}, cells that are nearer to squares, or springs (material.preset: none)')
    return {
        'structural': (left[WARP] / ratio, left[WEFT] * ratio),
        'shear': shear * 0.5 * (ratio + 1.0 / ratio)}


def _written(value: float | tuple[float, float]) -> str:
    if isinstance(value, tuple):
        return f'[{", ".join(f"{part:g}" for part in value)}]'
    return f'{value:g}'


# Fabrics that were measured: mass, stiffness and rigidity by name.
#
# The numbers are those of Wang, O'Brien and Ramamoorthi, "Data-driven elastic models for cloth:
# modeling and measurement", 2011, DOI 10.1145/2010324.1964966. They measured curves; a fabric here
# has one value of each. docs/how_to/choose_a_fabric.md lists the omissions.


@dataclass(frozen=True)
class Fabric:
    """
    A fabric as a linear sheet.

    :param fabric: description, and its name in the source
    :param density: mass per area [kg/m2]
    :param warp: stiffness along the rows [N/m]
    :param weft: along the columns [N/m]
    :param shear: in shear [N/m]
    :param rigidity: of bends along warp and weft [N m]; measured at 45 degrees too
    :param note: how to take the numbers
    """

    fabric: str
    density: float
    warp: float
    weft: float
    shear: float
    rigidity: tuple[float, float]
    note: str

    @property
    def values(self) -> dict[str, Any]:
        """Return the parameters of a scene."""
        return {
            'areal_density': self.density, 'material.warp': self.warp,
            'material.weft': self.weft, 'material.shear': self.shear,
            'bending.rigidity': list(self.rigidity)}


def _fabric(
        fabric: str, density: float, stretch: tuple[float, float], shear: float,
        bending: tuple[float, float], note: str) -> Fabric:
    warp, weft = bending
    return Fabric(fabric, density, *stretch, shear, (_MICRO * warp, _MICRO * weft), note)


# Stretch is that of small strain in woven fabrics, and that of the largest strain measured in
# those that stiffen several times over, as knits do.
FABRICS: Mapping[str, Fabric] = {
    't_shirt': _fabric(
        't-shirt, 60/40 cotton-polyester (gray-interlock)', 0.187, (140.0, 414.0), 9.0,
        (23.0, 14.0), f'{_STIFFENS}, from 17 and 34'),
    'underwear': _fabric(
        'underwear knit, 95 % cotton (ivory-rib-knit)', 0.276, (106.0, 255.0), 21.0,
        (46.0, 32.0), f'{_STIFFENS}, from 43 and 65'),
    'denim': _fabric(
        'jeans, 11 oz denim', 0.324, (205.0, 1014.0), 13.0, (64.0, 97.0), 'woven'),
    'tablecloth': _fabric(
        'tablecloth, polyester (white-dots)', 0.128, (2002.0, 2027.0), 5.0, (52.0, 31.0),
        _CEILING),
    'trousers': _fabric(
        'trousers, 65/35 cotton-polyester (royal-target)', 0.220, (2017.0, 2035.0), 26.0,
        (125.0, 125.0), _CEILING),
    'blanket': _fabric(
        'blanket, polyester (pink-ribbon)', 0.228, (152.0, 245.0), 8.0, (117.0, 60.0),
        'stiffens to 210 and 360'),
    'ponte_roma': _fabric(
        'jacket, ponte roma', 0.284, (144.0, 269.0), 8.0, (36.0, 37.0),
        f'{_STIFFENS}, from 31 and 44'),
    'polyester_jacket': _fabric(
        'jacket, polyester (tango-red)', 0.113, (227.0, 405.0), 4.0, (14.0, 20.0),
        f'{_STIFFENS}, from 43 and 171'),
    'sweater': _fabric(
        'sweater (navy-sparkle)', 0.224, (126.0, 305.0), 4.0, (59.0, 46.0),
        f'{_STIFFENS}, from 12 and 3'),
    'swimsuit': _fabric(
        'swimsuit, nylon (white-swim)', 0.204, (69.0, 170.0), 15.0, (60.0, 51.0),
        f'{_STIFFENS}, from 48 and 105'),
}


def with_material(given: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return ``given``, completed by the values of its ``material.preset``.

    A mass of the whole cloth takes the place of the fabric's, and springs that of its stretch.
    """
    name = given.get('material.preset', NO_PRESET)
    # What is no fabric is left to the check of the field.
    if not isinstance(name, str) or name not in FABRICS:
        return dict(given)
    values = FABRICS[name].values
    if given.get('total_mass'):
        del values['areal_density']
    if any(given.get(spring) for spring in MATERIAL_SPRINGS):
        values = {key: value for key, value in values.items() if not key.startswith('material.')}
    return {**values, **given}
