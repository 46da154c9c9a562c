# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages drawn at random from what a client might send, and what no client should."""

from importlib import import_module
import random
from typing import Any

NUMBERS = (
    0.0, -0.0, 1.0, -1.0, 0.1, 0.25, 0.02, 3.0, 1e-300, 5e-324, 1e-12, 1e-6, 1e6, 1e9, 1e30,
    1e38, 1e200, 1.7e308, -1e200, float('nan'), float('inf'), -float('inf'))
WHOLE = (0, 1, 2, 3, 7, 8, 10, 255, 10**5, 10**5 + 1, 2**31 - 1, 2**31, 2**32 - 1, -1, -(2**31),
         2**63 - 1, -(2**63))
WORDS = (
    '', ' ', 'all', 'sphere', 'mass_spring', 'constraint', 'adaptive', 'world', 'map', 'cube',
    '-rf', '*', '`id`', '$(id)', '..', '../../x', '/etc/passwd', 'a\nb', 'a' * 5000, '%s%n', 'Ä',
    '\U0001f9f5', 'mode', 'rows', 'real_time_factor', 'publish.points', 'clicked_point.force',
    'clicked_point.radius', 'use_sim_time', 'no.such.parameter')
_RANGES = {
    'uint8': (0, 2**8), 'octet': (0, 2**8), 'int8': (-(2**7), 2**7), 'uint32': (0, 2**32),
    'int32': (-(2**31), 2**31), 'uint64': (0, 2**64), 'int64': (-(2**63), 2**63)}


def fill(message: Any, drawn: random.Random, wild: float = 0.3) -> Any:
    """
    Return ``message`` with its fields drawn at random.

    :param wild: how often a field is set; the others keep what a plain client leaves in them
    """
    for name, kind in message.get_fields_and_field_types().items():
        if drawn.random() < wild:
            setattr(message, name, _value(kind, drawn, wild))
    return message


def _value(kind: str, drawn: random.Random, wild: float) -> Any:
    if kind.startswith('sequence<'):
        return [_value(kind[9:-1].partition(',')[0], drawn, wild)
                for _ in range(drawn.choice((0, 1, 2, 3, 4, 20)))]
    if kind in ('double', 'float'):
        number = drawn.choice(NUMBERS)
        return number if kind == 'double' or abs(number) < 3e38 else 0.0
    if kind == 'boolean':
        return drawn.random() < 0.5
    if kind in _RANGES:
        low, high = _RANGES[kind]
        number = drawn.choice([each for each in WHOLE if low <= each < high])
        return bytes([number]) if kind == 'octet' else number
    if kind == 'string':
        return drawn.choice(WORDS)
    package, _, name = kind.partition('/')
    part = getattr(import_module(f'{package}.msg'), name)()
    return fill(part, drawn, max(wild, 0.7))
