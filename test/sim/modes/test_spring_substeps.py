# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A dt is refused with numbers that fit together, and with one that is accepted."""

import math
import re

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.modes.spring_substeps import spring_substeps
from cloth_sim_ros.sim.scene import Scene
from hypothesis import given
from hypothesis import strategies
import pytest

_NUMBER = '([0-9.e+-]+)'
_TOO_MANY = re.compile(
    f'dt {_NUMBER} s would take {_NUMBER} substeps of the {_NUMBER} s that are safe in any shape'
    f'(?:, times refine {_NUMBER})?, more than 100000: (?:set dt <= {_NUMBER}, or )?use softer')
_TOO_LONG = re.compile(
    f'dt {_NUMBER} s in {_NUMBER} substeps is above the stability limit {_NUMBER} s of a substep '
    f'in mode mass_spring [(]node mass {_NUMBER} kg[)], and {_NUMBER} s are safe in any shape: '
    f'(?:set dt <= {_NUMBER}, or )?')
_STIFF = {'stiffness.structural': 1e9, 'node_mass': 1e-3}
_DTS = strategies.sampled_from([1e-7, 2e-4, 0.005, 0.02, 0.3, 1.0])
_SPRINGS = strategies.fixed_dictionaries({
    'stiffness.structural': strategies.floats(1.0, 1e9),
    'stiffness.shear': strategies.floats(0.0, 1e6), 'damping.bend': strategies.floats(0.0, 1e6),
    'node_mass': strategies.floats(1e-9, 1.0)})


def refusal(values: dict) -> str:
    """Return the message with which the scene is refused; empty when it is accepted."""
    try:
        spring_substeps(Scene(values), 'mass_spring')
    except ClothSimError as error:
        return str(error)
    return ''


def numbers(pattern: re.Pattern, message: str) -> list[float]:
    """Return the numbers in ``message``; 0 where one is left out."""
    found = pattern.match(message)
    assert found, message
    return [float(text or 0.0) for text in found.groups()]


@given(springs=_SPRINGS, dt=_DTS, refine=strategies.sampled_from([1, 2, 7, 1000]))
def test_too_many_substeps(springs: dict, dt: float, refine: int):
    """The count would not be that of the substep beside it, or the dt offered be refused too."""
    values = {**springs, 'dt': dt, 'refine': refine}
    message = refusal(values)
    if not message:
        return
    _, count, safe, times, offered = numbers(_TOO_MANY, message)
    assert times == (refine if refine > 1 else 0)
    assert count == float(f'{refine * math.ceil(dt / safe - 1e-9):.3g}')
    longest = safe * (100000 // refine)
    if longest < 1e-7:
        assert not offered
        return
    assert offered == pytest.approx(longest, rel=0.011)
    assert refusal({**values, 'dt': offered}) == ''


@given(springs=_SPRINGS, dt=_DTS, substeps=strategies.sampled_from([1, 3, 7, 1000]))
def test_too_long_substeps(springs: dict, dt: float, substeps: int):
    """The dt offered would be refused too, or come out of nowhere."""
    values = {**springs, 'dt': dt, 'auto_substeps': False, 'substeps': substeps}
    message = refusal(values)
    if not message:
        return
    _, _, limit, _, safe, offered = numbers(_TOO_LONG, message)
    assert dt / substeps > limit
    if safe * substeps < 1e-7:
        assert not offered
    else:
        assert offered == pytest.approx(safe * substeps, rel=0.011)
        assert refusal({**values, 'dt': offered}) == ''
    automatic = refusal({**values, 'auto_substeps': True})
    assert ('auto_substeps: true' in message) == (automatic == '')


def test_the_usual_numbers():
    """The user would be shown a substep that twice as many would be made of."""
    assert refusal({**_STIFF, 'dt': 1.0}) == (
        'dt 1 s would take 1.41e+06 substeps of the 7.07e-07 s that are safe in any shape, more '
        'than 100000: set dt <= 0.0707, or use softer springs, less damping or a larger node '
        'mass')
