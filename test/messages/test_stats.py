# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One frame in plain numbers."""

from cloth_sim_ros.messages.stats import stats_message
from made_snapshot import make_snapshot
import pytest
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message

NUMBERS = {
    'solver_iterations': 11, 'solver_residual': 1e-3, 'solver_reached': False,
    'active_constraints': 12,
    'active_fraction': 0.25, 'constraint_switches': 13, 'strain_bound': 0.0, 'stalled_pins': 14}


def test_every_number_is_in_its_place():
    """A plot would show one number under the name of another."""
    snapshot = make_snapshot(2, 2, **NUMBERS)
    message = stats_message(
        snapshot, 'world', step_wall_time=0.125, real_time_factor=0.75, wanted_factor=1.5,
        too_slow=True)
    stats = deserialize_message(serialize_message(message), type(message))
    assert stats.header.frame_id == 'world'
    assert (stats.header.stamp.sec, stats.header.stamp.nanosec) == (1, 250000000)
    assert stats.sim_time == snapshot.time
    assert (stats.step_wall_time, stats.real_time_factor) == (0.125, 0.75)
    assert (stats.real_time_factor_wanted, stats.too_slow) == (1.5, True)
    own = {
        'header', 'sim_time', 'step_wall_time', 'real_time_factor', 'real_time_factor_wanted',
        'too_slow'}
    names = set(stats.get_fields_and_field_types()) - own
    assert {name: getattr(stats, name) for name in names} == {
        name: getattr(snapshot, name) for name in names}


@pytest.mark.parametrize('value', [float('nan'), float('inf')])
def test_a_run_that_blew_up_is_still_told(value):
    """The node would stop on the first number that is not finite."""
    stats = stats_message(make_snapshot(2, 2, kinetic_energy=value, finite=False), 'world')
    assert str(stats.kinetic_energy) == str(value)
