# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The rows of the validation table.

Fabric constants of a row are the same in all modes, and no value is fitted to its truth.
"""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.validation import air
from cloth_sim_ros.validation import belt
from cloth_sim_ros.validation import cusick
from cloth_sim_ros.validation import hard_sheet
from cloth_sim_ros.validation import layers
from cloth_sim_ros.validation import loops
from cloth_sim_ros.validation import motions
from cloth_sim_ros.validation import pendulums
from cloth_sim_ros.validation import slope
from cloth_sim_ros.validation import strips
from cloth_sim_ros.validation import waves
from cloth_sim_ros.validation.robot_paths import DRAG
from cloth_sim_ros.validation.robot_paths import FLING
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.row import Measure
from cloth_sim_ros.validation.row import Row

_SPRINGS = ('mass_spring', 'adaptive')
_HARD = ('constraint',)
_CUSICK = 'test of Cusick 1968, DOI 10.1080/19447026808662375; range published for {}'
_ROBOT = 'Blanco-Mulero et al. 2024, DOI 10.1109/LRA.2024.3360814'
_VIBRATION = 'steps of 5 to 1.25 ms do not resolve the vibration of hard edges, see below'
_COARSE = 'second order in the grid: too few columns for so sharp a bend'
_FALLS = ((0.10, 0.001), (0.187, 0.02), (0.324, 0.05))


def _with(function: Callable[..., Figure], *given: Any) -> Measure:
    """Return a measurement of a function that takes more after the nodes."""
    return lambda context, mode, nodes: function(context, mode, nodes, *given)


def _of_belt(friction: float) -> Measure:
    def measure(context: Context, mode: str, nodes: int) -> Figure:
        return belt.ratio_of_tensions(context, mode, friction)
    return measure


def _drop(context: Context, mode: str, nodes: int) -> Figure:
    return strips.hung(context, mode, nodes, 0.5)[1]


def _chord(context: Context, mode: str, nodes: int) -> Figure:
    return strips.hung(context, mode, nodes, 64.0)[0]


def _loop(kind: str, load: float) -> Measure:
    def measure(context: Context, mode: str, nodes: int) -> Figure:
        return loops.height(context, mode, nodes, kind, load)
    return measure


def _drape(fabric: str, shortfall: str = '') -> Row:
    _, kind, _ = cusick.FABRICS[fabric]
    return Row(
        f'drapes.{fabric}', f'drape coefficient of {fabric} as it was measured',
        _CUSICK.format(kind), '%', 0.0, _with(cusick.coefficient, fabric),
        (25, 49), is_long=True, shortfall=shortfall)


ROWS: tuple[Row, ...] = (
    Row('strips.stretch', 'a hanging strip: longer by its weight', 'w L^2 / (2 E)', 'mm', 0.005,
        strips.stretch, (9, 17)),
    Row('strips.sag', 'a clamped strip, w L^3 / B = 0.5: drop of the tip over its length',
        'heavy elastica', '', 0.01, _drop, (9, 17)),
    Row('strips.hang', 'a clamped strip, w L^3 / B = 64: angle of the chord', 'heavy elastica',
        'degrees', 0.01, _chord, (17, 33)),
    Row('strips.frequency', 'a clamped strip: first mode', '1.875^2 sqrt(B / m) / (2 pi L^2)',
        'Hz', 0.01, strips.frequency, (17, 33)),
    Row('loops.heart', "Peirce's heart loop, w L^3 / B = 8: height over length",
        'elastica', '', 0.01, _loop('heart', 8), (17, 33), shortfall=_COARSE),
    Row('loops.pear', 'pear loop, w L^3 / B = 128: height over length', 'elastica', '', 0.01,
        _loop('pear', 128), (17, 33), shortfall=_COARSE),
    Row('loops.sharp', 'heart loop, w L^3 / B = 64: height over length', 'elastica', '', 0.01,
        _loop('heart', 64), (17, 33, 65), is_long=True,
        shortfall=_COARSE),
    Row('waves.chain', 'a standing wave of 8 half waves on a chain',
        'asin(w h / 2) / (pi h), w = 2 sqrt(k / m) sin(q / 2)', 'Hz', 5e-5,
        _with(waves.frequency, 8, 0.001), (33, 65), _SPRINGS),
    Row('pendulums.rod', 'a rod from 1 rad, dt 10 ms: period over that of the formula',
        '4 sqrt(L / g) K(sin(1 / 2))', '', 3e-4, _with(pendulums.period, 0.01), (2,), _HARD),
    Row('pendulums.chain', "two links from level: order in dt of the distance from Lagrange's "
        'equations', 'first order', '', 0.1, pendulums.order_of_chain, (3,), _HARD),
    Row('sheets.mean', 'a hard sheet from level, at 0.2 s: order in dt of the distance from '
        'DOP853, root mean square', 'first order', '', 0.1, hard_sheet.order_of_mean, (8, 16),
        _HARD, shortfall=_VIBRATION),
    Row('sheets.softer', 'the same with edges a tenth as hard: order of the largest distance',
        'first order', '', 0.1, hard_sheet.order_of_softer, (8, 16), _HARD),
    Row('sheets.largest', 'the same with the edges of the default: order of the largest distance',
        'first order', '', 0.1, hard_sheet.order_of_largest, (8, 16), _HARD,
        shortfall=_VIBRATION),
    Row('friction.slope', 'a cloth on a slope, mu 0.4: tangent of the angle at which it slides',
        'mu (Coulomb)', '', 1e-3, _with(slope.slip_tangent, 0.4), (8, 16)),
    Row('friction.creep', 'the same at 0.99 of that angle, for 1 s: creep', 'none', 'um/s', 1.0,
        _with(slope.creep, 0.4, 1.0), (8, 16)),
    Row('friction.capstan', 'a belt round a drum by pi, mu 0.4, that slips: ratio of its tensions',
        '((1 + mu t) / (1 - mu t))^15, t = tan(pi / 30) (Euler, Eytelwein)', '', 0.01,
        _of_belt(0.4), (23,)),
    Row('stacks.height', 'four sheets on a floor: height of the uppermost', '3.5 thicknesses',
        'mm', 1e-3, layers.height_of_stack, (8, 12)),
    Row('stacks.load', 'the same: force on the floor over the weight', '1', '', 1e-3,
        layers.load_of_stack, (8, 12)),
    *(Row(f'air.{1e3 * sigma:g}', f'a level sheet of {sigma:g} kg/m2, dt {1e3 * dt:g} ms: '
          'terminal speed', 'sqrt(2 w / (rho Cn))', 'm/s', 1e-3,
          _with(air.mean_speed, sigma, dt), (16, 32)) for sigma, dt in _FALLS),
    _drape('light', 'in mode constraint diagonals are hard by default: it hardly shears; 25 nodes '
           'are few for so soft a fabric'),
    _drape('t_shirt', 'the range is of woven cotton, and the fabric is knitted'),
    _drape('trousers', 'a polyester blend that is stiffer than the cottons of the range'),
    _drape('denim', 'bends about a diagonal with 40 uN m, where 73 were measured'),
    Row('motions.fling', 'a rag of 0.05 kg that two grippers fling: strain of the threads',
        f'little; the motion of {_ROBOT}', '%', 2.0, _with(motions.thread_strain, FLING), (26,),
        is_long=True),
    Row('motions.jitter', 'the same: L_s, 100 targets a second',
        f'L_s of the grippers; {_ROBOT}: MuJoCo 39, Bullet 16859, SoftGym 46, SOFA 1.3 um',
        'um', 1.0, _with(motions.jitter, FLING), (26,), is_long=True),
    Row('motions.drag', 'the rag that they drag slowly: strain of the threads',
        f'little; the motion of {_ROBOT}', '%', 2.0, _with(motions.thread_strain, DRAG), (26,),
        is_long=True),
)
