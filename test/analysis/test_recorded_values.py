# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages whose types a bag has defined in another way."""

from types import SimpleNamespace

from cloth_sim_ros.analysis.recorded_values import check_message
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np
import pytest

HEADER = SimpleNamespace(stamp=SimpleNamespace(sec=1, nanosec=2))
POINT = SimpleNamespace(x=0.0, y=1.0, z=2)
PUSH = {
    'header': HEADER, 'force': POINT, 'center': POINT, 'region': 'all', 'start': 0.0,
    'duration': 1.0, 'radius': 0.0}


def test_a_whole_message_is_taken():
    """No recording could be read."""
    check_message('inputs/push', SimpleNamespace(**PUSH))
    check_message('stats', SimpleNamespace(header=HEADER, dt=0.1, steps=3))
    check_message('markers', SimpleNamespace())


@pytest.mark.parametrize(('key', 'fields', 'rule'), [
    ('inputs/push', {**PUSH, 'start': 'x'}, "has 'x' as its start, where a number is expected"),
    ('inputs/push', {**PUSH, 'force': 3.0}, 'has None as its force.x'),
    ('inputs/push', {**PUSH, 'region': np.zeros(3)}, 'as its region, where a word is expected'),
    ('stats', {'header': HEADER, 'dt': 'x'}, "has 'x' as its dt"),
    ('stats', {'header': HEADER, 'max_strain': np.zeros(2)}, 'as its max_strain'),
    ('stats', {'header': SimpleNamespace()}, 'as its header.stamp.sec'),
    ('stats', {'header': SimpleNamespace(stamp=SimpleNamespace(sec=np.zeros(3), nanosec=0))},
     'as its header.stamp.sec, where a whole number is expected'),
    ('inputs/mode', {'header': HEADER, 'mode': 'adaptive', 'previous_mode': 3}, 'previous_mode'),
    ('inputs/parameters', {
        'stamp': HEADER.stamp, 'new_parameters': [SimpleNamespace(name=3)],
        'changed_parameters': []}, 'inputs/parameters, new_parameters has 3 as its name'),
    ('inputs/parameters', {'stamp': HEADER.stamp, 'new_parameters': 'abc'}, 'new_parameters')])
def test_a_message_of_another_form_is_refused(key, fields, rule):
    """A verb would end as a traceback, far from where the message was read."""
    with pytest.raises(ClothSimError) as error:
        check_message(key, SimpleNamespace(**fields))
    assert rule in str(error.value) and 'give a recording' in str(error.value)
