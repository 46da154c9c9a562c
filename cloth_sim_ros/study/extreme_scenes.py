# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Extreme scenes, by name: what `cloth_sim study extremes` runs, and the tests as well."""

from collections.abc import Callable
from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
from itertools import product
from typing import Any

from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.study.random_limits import random_scene
import numpy as np

RUNS = 'runs'
REFUSED = 'refused'
STOPS = 'stops'
OUTCOMES = (RUNS, REFUSED, STOPS)

# Function of the rest positions and a random generator; returns positions (rows, cols, 3) [m].
Start = Callable[[np.ndarray, np.random.Generator], np.ndarray]


@dataclass(frozen=True)
class Extreme:
    """
    A scene at the limits of its parameters.

    :param values: scene parameters besides the mode; 8 x 8 nodes where nothing is said
    :param group: of scenes that are reported together
    :param modes: it is run in
    :param steps: of dt that are made
    :param push: arguments of ``Simulation.push`` before the first step
    :param start: from the rest positions to others, at rest; None leaves the scene's own start
    :param speed: largest of random velocities at the start [m/s]; 0 leaves the cloth at rest
    :param expected: outcomes that are right
    :param holds_lengths: whether edges can keep their length or limit: nothing begins away from
        it, and nothing pulls beyond it
    :param is_long: whether it takes more than a few seconds
    """

    values: Mapping[str, Any]
    group: str
    modes: tuple[str, ...] = MODES
    steps: int = 20
    push: Mapping[str, Any] = field(default_factory=dict)
    start: Start | None = None
    speed: float = 0.0
    expected: tuple[str, ...] = (RUNS,)
    holds_lengths: bool = True
    is_long: bool = False


def of_all(name: str, value: float) -> dict[str, float]:
    """Return the parameter ``name`` of every family of springs, set to ``value``."""
    return {f'{name}.{family}': value for family in ('structural', 'shear', 'bend')}


# Steps of what takes thousands of substeps.
_FEW = 3
_SPRINGS = tuple(name for name, mode in AVAILABLE.items() if not mode.is_implicit)
_JAMMED = {'start.jitter': 0.5}

_SHAPES = {
    '2 x 2': Extreme({'rows': 2, 'cols': 2}, 'shape'),
    '1 x 2': Extreme({'rows': 1, 'cols': 2, 'pins': ['top_left']}, 'shape'),
    '2 x 1000': Extreme({'rows': 2, 'cols': 1000}, 'shape', steps=_FEW),
    '1000 x 2': Extreme({'rows': 1000, 'cols': 2}, 'shape', steps=_FEW),
    'side 100 km': Extreme({'width': 1e5, 'height': 1e5}, 'shape'),
    'side 0.1 mm': Extreme({'width': 1e-4, 'height': 1e-4}, 'shape', expected=(RUNS, REFUSED)),
    '100 km x 1 m': Extreme({'width': 1e5}, 'shape', expected=OUTCOMES),
    '8000 x 8000': Extreme({'rows': 8000, 'cols': 8000}, 'shape', expected=(REFUSED,)),
    '1024 x 1024, flat': Extreme(
        {'rows': 1024, 'cols': 1024, 'dt': 1e-5, **of_all('damping', 1e-5)}, 'shape',
        ('mass_spring',), steps=2, is_long=True),
    # The solver of mode adaptive does not fit into the buffers of some devices.
    '1024 x 1024, flat, with a limit': Extreme(
        {'rows': 1024, 'cols': 1024, 'dt': 1e-5, **of_all('damping', 1e-5)}, 'shape',
        ('adaptive',), steps=2, is_long=True, expected=(RUNS, REFUSED)),
    '1024 x 1024, each off by half a spacing': Extreme(
        {'rows': 1024, 'cols': 1024, 'dt': 1e-5, **of_all('damping', 1e-5)}, 'shape', _SPRINGS,
        steps=2, is_long=True, holds_lengths=False, expected=OUTCOMES,
        start=lambda rest, random: rest + random.uniform(-5e-4, 5e-4, rest.shape)),
}

_SETTINGS = {
    'all pinned': Extreme({'pins': ['all']}, 'setting'),
    'none pinned': Extreme({'pins': ['none']}, 'setting'),
    'chain between two pins at rest distance': Extreme(
        {'rows': 1, 'cols': 12, **of_all('stiffness', 1e4)}, 'setting'),
    'zero gravity': Extreme({'gravity': [0.0, 0.0, 0.0]}, 'setting'),
    'gravity 1e4': Extreme({'gravity': [0.0, 0.0, -1e4]}, 'setting', holds_lengths=False),
    'stiffness 1e-3': Extreme(of_all('stiffness', 1e-3), 'setting'),
    'stiffness 1e6': Extreme(of_all('stiffness', 1e6), 'setting'),
    'stiffness 1e9': Extreme(of_all('stiffness', 1e9), 'setting', expected=(RUNS, REFUSED),
                             steps=_FEW),
    'mass 1e-6': Extreme({'node_mass': 1e-6}, 'setting'),
    'mass 1e3': Extreme({'node_mass': 1e3}, 'setting'),
    'dt 1e-7': Extreme({'dt': 1e-7}, 'setting'),
    'dt 1e-6': Extreme({'dt': 1e-6}, 'setting'),
    'dt 0.1': Extreme({'dt': 0.1}, 'setting'),
    'dt 1': Extreme({'dt': 1.0}, 'setting', steps=_FEW, expected=OUTCOMES),
    'dt 0.1 in one step, whatever it takes': Extreme(
        {'dt': 0.1, 'auto_substeps': False}, 'setting', _SPRINGS, expected=(REFUSED,)),
    'damping 0': Extreme(of_all('damping', 0.0), 'setting'),
    'damping 1e6': Extreme(of_all('damping', 1e6), 'setting', expected=(RUNS, REFUSED)),
    'no springs': Extreme({**of_all('stiffness', 0.0), **of_all('damping', 0.0)}, 'setting'),
    'no edges in mode constraint': Extreme(
        {'constraint.hard': []}, 'setting', ('constraint',), holds_lengths=False),
    'all families hard': Extreme(
        {'constraint.hard': ['structural', 'shear', 'bend']}, 'setting', ('constraint',)),
    'implicit springs of 1e9 N/m': Extreme(
        {**of_all('stiffness', 1e9), 'constraint.hard': [],
         'constraint.springs': ['structural', 'shear', 'bend']}, 'setting', ('constraint',)),
    'implicit springs of 1e-3 N/m': Extreme(
        {**of_all('stiffness', 1e-3), 'constraint.hard': [],
         'constraint.springs': ['structural', 'shear', 'bend']}, 'setting', ('constraint',),
        holds_lengths=False),
    'hard edges of strain 1e-5': Extreme(
        {'constraint.strain': 1e-5}, 'setting', ('constraint',)),
    'hard edges of strain 1': Extreme(
        {'constraint.strain': 1.0}, 'setting', ('constraint',), holds_lengths=False),
    'tolerance 1e-6': Extreme({'solver.tolerance': 1e-6}, 'setting', ('constraint', 'adaptive')),
    'one iteration': Extreme(
        {'solver.max_iterations': 1}, 'setting', ('constraint', 'adaptive')),
    'threshold 0.5': Extreme({'adaptive.threshold': 0.5}, 'setting'),
    'threshold 0.005': Extreme({'adaptive.threshold': 0.005}, 'setting'),
    '10 km up': Extreme({'start.z': 1e4}, 'setting', holds_lengths=False, expected=OUTCOMES),
}


def _corner(stiffness: float, mass: float, dt: float, steps: int, *, is_long: bool) -> Extreme:
    return Extreme(
        {**of_all('stiffness', stiffness), **of_all('damping', 0.0), 'node_mass': mass, 'dt': dt},
        'stiffness, mass and dt', steps=steps, expected=(RUNS, REFUSED), is_long=is_long)


def _name(stiffness: float, mass: float, dt: float) -> str:
    return f'k {stiffness:g}, m {mass:g}, dt {dt:g}'


_CORNERS = {
    _name(*values): _corner(*values, steps=2, is_long=False)
    for values in product((1e-3, 1e6), (1e-6, 1e3), (1e-6, 0.1))}
_GRID = {
    _name(*values): _corner(*values, steps=3, is_long=True)
    for values in product((1e-3, 1.0, 1e3, 1e6), (1e-6, 1e-3, 1.0, 1e3), (1e-6, 1e-4, 0.01, 0.1))
    if _name(*values) not in _CORNERS}


def _pushed(expected: tuple[str, ...] = OUTCOMES, **push: object) -> Extreme:
    return Extreme({}, 'push', steps=_FEW, push=push, expected=expected, holds_lengths=False)


_PUSHES = {
    'push 1e3 N': _pushed(force=(1e3, 0.0, 1e3), duration=0.1),
    'push 1e9 N': _pushed(force=(1e9, 0.0, 1e9), duration=0.1),
    'push 1e30 N': _pushed((STOPS,), force=(1e30, 0.0, 1e30), duration=0.1),
    'push 1e30 N for 1e-9 s': _pushed((STOPS,), force=(1e30, 0.0, 0.0), duration=1e-9),
    'push 1e-30 N': _pushed((RUNS,), force=(1e-30, 0.0, 0.0), duration=1.0),
    'push 1e6 N on four nodes': _pushed(
        force=(0.0, 0.0, 1e6), duration=0.1, region='sphere', center=(0.0, 0.0, 1.0),
        radius=0.15),
}


def _moved(target: list[float], speed: float) -> Extreme:
    return Extreme(
        {'pin_moves.start': [0.0], 'pin_moves.node': ['top_left'], 'pin_moves.target': target,
         'pin_moves.speed': [speed]}, 'pin that moves', steps=_FEW, expected=OUTCOMES,
        holds_lengths=False)


_PIN_MOVES = {
    'a pin moves to the other at 1 m/s': Extreme(
        {'pin_moves.start': [0.0], 'pin_moves.node': ['top_left'],
         'pin_moves.target': [0.4, 0.5, 1.0]}, 'pin that moves'),
    'a pin leaves at 10 m/s, beyond the cloth': _moved([-10.0, 0.5, 1.0], 10.0),
    'a pin leaves at 1e6 m/s': _moved([-1e6, 0.5, 1.0], 1e6),
}


def _started(start: Start | None, **others: Any) -> Extreme:
    return Extreme(
        {}, 'start', start=start, steps=_FEW, expected=(RUNS, STOPS), holds_lengths=False,
        **others)


_STARTS = {
    'scrambled': _started(lambda rest, random: random.uniform(-0.5, 0.5, rest.shape)),
    'all in one point': _started(lambda rest, random: np.zeros_like(rest)),
    'each off by 0.7 of the spacing': _started(
        lambda rest, random: rest + random.uniform(-0.1, 0.1, rest.shape)),
    'all on one line': _started(lambda rest, random: rest * (1.0, 0.0, 0.0)),
    'inside out': _started(lambda rest, random: rest[:, ::-1]),
    'stretched 1e5 times': _started(lambda rest, random: 1e5 * rest),
    'scrambled over 1e11 m': _started(
        lambda rest, random: random.uniform(-1e11, 1e11, rest.shape)),
    'speeds of 1e3 m/s': _started(None, speed=1e3),
    'speeds of 1e9 m/s': _started(None, speed=1e9),
    'jitter 0.5': Extreme(_JAMMED, 'start', holds_lengths=False),
}

_LASTING = {
    'jitter 0.5, for 2 s': Extreme(
        _JAMMED, 'start', ('adaptive', 'constraint'), steps=400, holds_lengths=False,
        is_long=True),
    'k 1e+06, m 1e-06, undamped, for 60000 substeps': Extreme(
        {**of_all('stiffness', 1e6), **of_all('damping', 0.0), 'node_mass': 1e-6, 'dt': 0.01,
         'gravity': [0.0, 0.0, 0.0]}, 'stiffness, mass and dt', ('mass_spring',), steps=3,
        is_long=True),
    'scheme paper, dt 0.02 in one step': Extreme(
        {'rows': 12, 'cols': 12, 'width': 11.0, 'height': 11.0, 'node_mass': 1.0,
         **of_all('stiffness', 1e3), **of_all('damping', 10.0), 'adaptive.scheme': 'paper',
         'dt': 0.02, 'auto_substeps': False, 'pushes.start': [1.0], 'pushes.duration': [0.2],
         'pushes.force': [0.0, 0.0, 5.0 * 9.81 * 142]}, 'setting', ('adaptive',), steps=500,
        holds_lengths=False, expected=(REFUSED,)),
}


def _random(seed: int, **others: Any) -> Extreme:
    values = random_scene(seed)
    seconds = values['pushes.start'][0] + 1.0
    return Extreme(
        {name: value for name, value in values.items() if name != 'mode'}, 'random scene',
        steps=round(seconds / values['dt']), expected=OUTCOMES, holds_lengths=False,
        is_long=True, **others)


_RANDOM = {
    **{f'random scene {seed}': _random(seed) for seed in range(12)},
    # Tight limits that catch an undamped cloth all but straight.
    **{f'random scene {seed}': _random(seed, modes=('adaptive',)) for seed in (20, 59)},
}

EXTREMES: dict[str, Extreme] = {
    **_SHAPES, **_SETTINGS, **_CORNERS, **_GRID, **_PUSHES, **_PIN_MOVES, **_STARTS, **_LASTING,
    **_RANDOM}
