# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Values that a Python program might pass where another kind of value is meant."""

from decimal import Decimal
import math
from typing import Any

import numpy as np

_MASKED = np.ma.masked_invalid([math.nan, 0.0, 0.0])

# By name, so that each shows which one it is where a test fails.
HOSTILE: dict[str, Any] = {
    'None': None, 'True': True, 'numpy True': np.True_, 'minus one': -1, 'one and a half': 1.5,
    'float of a whole number': 2.0, 'nan': math.nan, 'infinite': math.inf,
    'minus infinite': -math.inf,
    'huge float': 1.7e308, 'int beyond int64': 2**64, 'int beyond floats': 10**400,
    'int beyond text': 10**5000, 'numpy int': np.int64(2**62), 'numpy nan': np.float32('nan'),
    'complex': 1j, 'Decimal': Decimal('0.5'), 'Decimal nan': Decimal('nan'),
    'text': 'top', 'empty text': '', 'number as text': '1', 'numpy text': np.str_('1'),
    'bytes': b'1', 'type': int, 'object': object(), 'function': len, 'empty dict': {},
    'dict': {'rows': 4}, 'dict of numbers': {1: 2}, 'set': {1}, 'empty list': [],
    'list': [1], 'list of None': [None] * 3, 'list of text': ['a', 'b', 'c'],
    'list of True': [True, False, True], 'ragged list': [[1], [1, 2]],
    'list of nan': [math.nan] * 3, 'list of huge ints': [10**400] * 3, 'generator': None,
    'numpy scalar array': np.array(1.5), 'numpy text array': np.array('1.5'),
    'array of one': np.array([1]), 'array of bool': np.ones(3, bool),
    'array of 3 x 3': np.ones((3, 3)), 'array of objects': np.array([None, 1, 'a']),
    'masked array': _MASKED, 'masked': np.ma.masked, 'masked matrix': np.ma.masked_equal(
        np.zeros((4, 5, 3)), 0.0),
    'structured array': np.zeros(3, [('x', float)]), 'date': np.datetime64('2026-01-01'),
    'long double': np.longdouble('1e4000'), 'empty array': np.zeros((0, 2)),
}
# A new one for each call: it can be walked through once.
MADE = {'generator': lambda: (each for each in (1, 2, 3))}


def hostile(name: str) -> Any:
    """Return the value called ``name``."""
    return MADE[name]() if name in MADE else HOSTILE[name]
