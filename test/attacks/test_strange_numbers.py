# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whole recordings and states of numbers that are none, or enormous."""

import math

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import Push
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from made_snapshot import make_snapshot
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Header

SECONDS = 10.0
FRAMES = 3
SIDE = 4
NUMBERS = [math.nan, pytest.param(-math.inf, marks=pytest.mark.long), 3e38]
KINDS = ('nodes', 'one node', 'strains', 'stats', 'push')
_STATS = (
    'dt', 'max_strain', 'kinetic_energy', 'total_energy', 'elastic_energy', 'real_time_factor',
    'step_wall_time', 'stability_margin', 'solver_residual', 'active_fraction')


def recorded(folder, number, kind):
    """Record some frames with ``number`` in what ``kind`` says."""
    recorder = Recorder(folder, 'bag', 'cloth_sim')
    for frame in range(FRAMES):
        header = Header(stamp=Time(nanosec=frame * 20_000_000))
        records = np.zeros((SIDE, SIDE), POINT_DTYPE)
        records['x'], records['y'] = np.arange(SIDE), np.arange(SIDE)[:, None]
        stats = ClothStats(header=header)
        if kind == 'one node':
            records['x'][0, 0] = number
        for name in {'nodes': ('x', 'y', 'z', 'normal_x'), 'strains': ('strain',)}.get(kind, ()):
            records[name] = number
        for name in _STATS if kind == 'stats' else ():
            setattr(stats, name, number)
        if kind == 'push':
            recorder.write('inputs/push', serialize_message(Push(
                header=header, force=Vector3(x=number, y=number, z=number), region='sphere',
                center=Point(x=number, y=number, z=number), radius=number, start=number,
                duration=number)), frame / 50)
        snapshot = make_snapshot(SIDE, SIDE, records=records, time=frame / 50)
        cloud = PointsMessage(SIDE, SIDE, 'world').serialise(snapshot)
        recorder.write('points', cloud, frame / 50)
        recorder.write('stats', serialize_message(stats), frame / 50)
    recorder.close()
    return recorder.path


def check(outcome):
    """Fail unless a verb has worked, or refused in a line."""
    assert outcome.code in (0, 1) and outcome.seconds <= SECONDS, outcome
    assert 'Traceback' not in outcome.err, outcome
    assert outcome.code == 0 or len(outcome.err.strip().splitlines()) == 1, outcome


@pytest.mark.parametrize(('number', 'kind'), [
    *((math.nan, kind) for kind in KINDS), (3e38, 'nodes'), (3e38, 'strains'),
    *(pytest.param(number, kind, marks=pytest.mark.long) for number, kind in (
        (3e38, 'one node'), (3e38, 'stats'), (3e38, 'push'),
        *((-math.inf, kind) for kind in KINDS)))])
def test_a_recording_of_them_is_shown_or_refused(verbs, tmp_path, number, kind):
    """A run that was lost would end `cloth_sim analyze`, `render` or `export` as a traceback."""
    bag = recorded(tmp_path, number, kind)
    verbs.warm_up('info', bag)
    check(verbs.run('analyze', bag, '--out', tmp_path / 'out'))
    check(verbs.run('render', bag, '--out', tmp_path / 'picture.png', '--size', '64x64'))
    for ending in ('.obj', '.ply', '.glb', '.usda'):
        check(verbs.run('export', bag, '--output', tmp_path / f'mesh{ending}'))


@pytest.mark.parametrize('kind', [np.float16, np.float64])
@pytest.mark.parametrize('number', [*NUMBERS, 1e12])
def test_a_state_of_them_is_drawn_or_refused(verbs, tmp_path, number, kind):
    """A state that was lost would end `cloth_sim render` as a traceback."""
    with np.errstate(all='ignore'):
        np.savez(
            tmp_path / 'state.npz', positions=np.full((1, SIDE, 3), number).astype(kind),
            strain=np.full((1, SIDE), number).astype(kind), flags=np.zeros((1, SIDE), int))
    check(verbs.run(
        'render', tmp_path / 'state.npz', '--out', tmp_path / 'x.png', '--size', '64x64'))
