# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a run is doing and how healthy it is, for people and tools that come late."""

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.messages.state import diagnostics_message
from cloth_sim_ros.messages.state import slow_pace
from cloth_sim_ros.messages.state import state_message
from cloth_sim_ros.sim.scene import Scene
from diagnostic_msgs.msg import DiagnosticArray
from diagnostic_msgs.msg import DiagnosticStatus
from made_snapshot import make_snapshot
import pytest
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message

CONTENT = {
    'mode': 'mass_spring', 'run_state': ClothState.PAUSED, 'rows': 5, 'cols': 7, 'dt': 0.005,
    'substeps': 3, 'stability_limit': 0.01, 'device': 'llvmpipe'}


@pytest.mark.parametrize(('path', 'recording'), [('', False), ('/bags/a', True)])
def test_every_value_is_in_its_place(path, recording):
    """A tool would show one value under the name of another."""
    message = state_message(
        **CONTENT, frame_id='world', sim_time=2.5, available_modes=('mass_spring',),
        recording_path=path)
    state = deserialize_message(serialize_message(message), ClothState)
    assert {name: getattr(state, name) for name in CONTENT} == CONTENT
    assert state.available_modes == ['mass_spring']
    assert (state.recording, state.recording_path) == (recording, path)
    assert (state.header.stamp.sec, state.header.stamp.nanosec) == (2, 500000000)
    assert state.header.frame_id == 'world'


# The health of a run, in words.

WALL = Time(sec=1700000000, nanosec=5)
HEALTHY = {
    'stamp': WALL, 'node_name': 'cloth_sim', 'device': 'llvmpipe', 'paused': False,
    'automatic_substeps': True,
    'real_time_factor': 1.0, 'wanted_factor': 1.0}
OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


@pytest.mark.parametrize(('substeps', 'automatic', 'faster', 'useless'), [
    (16, True, 'softer springs', 'dt'), (1, True, 'a longer dt', 'springs'),
    (16, False, 'a longer dt', 'springs')])
@pytest.mark.parametrize('mode', ['mass_spring', 'adaptive'])
def test_a_longer_dt_is_advised_where_it_helps(
        mode, substeps, automatic, faster, useless):
    """A user would take a longer dt, which then has more substeps of the same length."""
    advice = slow_pace(0.5, 1.0, substeps=substeps, automatic=automatic, mode=mode)
    assert advice.startswith('0.5 x real time, below the target 1: use fewer nodes, ')
    assert faster in advice and useless not in advice


def test_pace_advice_fits_mode_constraint():
    """There are no springs in it whose stiffness makes substeps."""
    advice = slow_pace(0.5, 1.0, substeps=16, automatic=True, mode='constraint')
    assert 'solver.tolerance' in advice and 'spring' not in advice


def diagnose(snapshot, **changes):
    """Return the status of each part by its short name."""
    message = diagnostics_message(snapshot, **{**HEALTHY, **changes})
    array = deserialize_message(serialize_message(message), DiagnosticArray)
    assert array.header.stamp == WALL, 'and not the simulated time of the snapshot'
    return {status.name.removeprefix('cloth_sim: '): status for status in array.status}


def test_a_healthy_run_is_ok_in_all_parts():
    """A run would raise an alarm for nothing, or a part would be missing."""
    found = diagnose(make_snapshot(2, 2))
    assert set(found) == {
        'GL device', 'real-time factor', 'solver', 'stability', 'pins', 'recorder',
        'program', 'time'}
    assert {status.level for status in found.values()} == {OK}
    assert {status.hardware_id for status in found.values()} == {'llvmpipe'}
    assert found['GL device'].message == 'llvmpipe'
    assert found['recorder'].message == 'not recording'
    values = {value.key: value.value for value in found['stability'].values}
    assert values['margin'] == '0.5' and values['substeps'] == '3'


@pytest.mark.parametrize(('part', 'level', 'text', 'state', 'run'), [
    ('real-time factor', WARN, 'lower real_time_factor', {}, {'real_time_factor': 0.5}),
    ('real-time factor', OK, 'paused', {}, {'real_time_factor': 0.0, 'paused': True}),
    ('real-time factor', OK, 'as fast as possible', {}, {'wanted_factor': 0.0}),
    ('real-time factor', OK, 'at the pace of /clock', {}, {
        'wanted_factor': 0.0, 'source': 'ros'}),
    ('solver', OK, 'in 7 iterations', {'solver_iterations': 7, 'solver_residual': 1e-4}, {}),
    ('solver', OK, 'in 2 iterations', {
        'solver_iterations': 2, 'solver_residual': Scene()['solver.tolerance']}, {}),
    ('solver', WARN, 'lower solver.tolerance', {
        'solver_iterations': 7, 'solver_residual': 0.5}, {}),
    ('solver', WARN, 'shorter dt',
     {'solver_iterations': 7, 'solver_residual': float('nan')}, {}),
    ('solver', WARN, 'raise solver.max_iterations',
     {'solver_iterations': 7, 'solver_residual': 1e-4, 'solver_reached': False}, {}),
    ('solver', OK, '40 edges near their limit in 3 rounds',
     {'listed_edges': 40, 'limit_rounds': 3}, {}),
    ('solver', WARN, '2 substeps of a step missed the tolerance of the strain limit after 9',
     {'limit_unreached': 2, 'limit_rounds': 9, 'solver_iterations': 7, 'solver_reached': False},
     {}),
    ('stability', OK, '0.85 times', {'stability_margin': 0.85000001}, {}),
    ('stability', WARN, 'above the safe', {'stability_margin': 0.95}, {}),
    ('stability', ERROR, 'auto_substeps', {'stability_margin': 1.1}, {}),
    ('stability', ERROR, 'lost at node (1, 2)', {}, {'problem': 'lost at node (1, 2)'}),
    ('stability', WARN, 'edges deviate', {'strain_bound': 0.0}, {}),
    ('stability', WARN, '2.5 times as long as it may be for that: use', {'air_margin': 2.5}, {}),
    ('stability', WARN, 'raise constraint.max_substeps', {'air_margin': 2.5, 'solves': 2}, {}),
    ('stability', WARN, 'use a shorter dt', {'strain_bound': 0.0, 'max_strain': 0.06}, {}),
    ('stability', WARN, 'is closing in',
     {'strain_bound': 0.0, 'max_strain': 0.06, 'settling': True}, {}),
    ('stability', OK, 'has done 0.5 J of work',
     {'strain_bound': 0.0, 'max_strain': 0.01, 'settling': True, 'settling_work': 0.5}, {}),
    ('stability', OK, 'edges rotate', {'solves': 2, 'stability_margin': 1.0}, {}),
    ('stability', WARN, 'constraint.max_substeps', {'solves': 2, 'stability_margin': 1.2}, {}),
    ('stability', WARN, 'set auto_substeps: true', {'solves': 2, 'stability_margin': 1.2},
     {'automatic_substeps': False}),
    ('pins', OK, 'no moving pin', {}, {}),
    ('pins', WARN, 'nearer targets', {'stalled_pins': 2}, {}),
    ('recorder', OK, '/bags/a', {}, {'recording_path': '/bags/a'}),
    ('recorder', ERROR, 'disk is full', {}, {'recording_error': 'the disk is full'}),
    ('program', WARN, '2 unexpected errors', {}, {'faults': 2, 'latest_fault': '~/reset: E'}),
])
def test_what_is_wrong_is_told(part, level, text, state, run):
    """A fault would go unnoticed, or be reported without advice."""
    status = diagnose(make_snapshot(2, 2, **state), **run)[part]
    assert status.level == level
    assert text in status.message
