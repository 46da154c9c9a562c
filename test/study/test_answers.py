# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The study of answers calls a real node, and its figures are those of its calls."""

import json

from cloth_sim_ros.study.answers import Times
from command import cloth_sim
import pytest


def test_each_service_is_called_as_often_as_asked_for():
    """A service that is refused or not there would count as a quick one."""
    done = cloth_sim(
        'study', 'answers', '--sizes', '6', '--calls', '3', '--modes', 'mass_spring',
        '--no-switches', '--json')
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures.pop('title').startswith('mode mass_spring, 6 x 6')
    assert figures.pop('gap between frames')['count'] > 0
    assert {name: times['count'] for name, times in figures.items()} == dict.fromkeys(
        ('apply_push', 'set_pin', 'pause', 'get_parameters'), 3)
    assert all(
        0.0 < times['wall_p50'] <= times['wall_p95'] <= times['wall_max']
        for times in figures.values())


def test_the_figures_are_percentiles():
    """The table would show a mean as a largest, or the like."""
    times = Times([0.001 * number for number in range(1, 101)], [1.0] * 100)
    figures = times.as_dict()
    assert figures['count'] == 100
    assert figures['wall_p50'] == pytest.approx(0.0505)
    assert figures['wall_p95'] == pytest.approx(0.09505)
    assert figures['wall_max'] == pytest.approx(0.1)
    assert figures['processor_max'] == 1.0
