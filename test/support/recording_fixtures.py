# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording with a known content, and frames made by hand."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.state import state_message
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import Unpin
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from made_snapshot import make_snapshot
import numpy as np
import pytest
from rclpy.serialization import serialize_message

ROWS, COLS = 5, 4
FRAMES = 20           # before the reset, at 50 Hz from 0.00 to 0.38 s
AFTER_RESET = 6
PUSH = Push.checked(force=(0.0, 0.0, 2.0), start=0.1, duration=0.1)
LATE_PUSH = Push.checked(force=(3.0, 0.0, 0.0), start=0.3, duration=5.0)


@dataclass
class Known:
    """A recording and what was put into it."""

    folder: Path
    records: list[np.ndarray]


@pytest.fixture(scope='session')
def known(tmp_path_factory: pytest.TempPathFactory) -> Known:
    """Record frames, two pushes, a released pin, and a reset that ends the second push."""
    recorder = Recorder(tmp_path_factory.mktemp('bags'), 'known', 'cloth_sim')
    points = PointsMessage(ROWS, COLS, 'world')
    records = []

    def write(key, message, time, offset=0.0):
        data = message if isinstance(message, bytes) else serialize_message(message)
        recorder.write(key, data, time + offset)

    def write_input(given, time):
        write(*input_message(given, time, 'world'), time)

    def write_frame(number, offset=0.0):
        made = make_snapshot(
            ROWS, COLS, time=number / 50, max_strain=0.01 * number, kinetic_energy=float(number))
        made.records['x'][:] = len(records)
        records.append(made.records.copy())
        write('points', points.serialise(made), made.time, offset)
        stats = stats_message(
            made, 'world', step_wall_time=1e-3, real_time_factor=0.0 if number == 0 else 0.5)
        write('stats', stats, made.time, offset)

    write('state', state_message(
        frame_id='world', sim_time=0.0, mode='mass_spring', available_modes=['mass_spring'],
        run_state='running', rows=ROWS, cols=COLS, dt=0.005, substeps=3, stability_limit=0.002,
        device='a device'), 0.0)
    write_input(SetMode('mass_spring'), 0.0)
    for number in range(FRAMES):
        time = number / 50
        write_frame(number)
        if number == 5:
            write_input(PushNodes(PUSH), time)
        if number == 10:
            write_input(Unpin(0, 0), time)
        if number == 15:
            write_input(PushNodes(LATE_PUSH), time)
    end = (FRAMES - 1) / 50
    write_input(Reset(), end)
    for number in range(AFTER_RESET):
        write_frame(number, end)
    recorder.close()
    return Known(recorder.path, records)


@pytest.fixture
def hanging() -> Callable[..., Frame]:
    """Return a function that makes a frame: a square metre hanging from its upper corners."""

    def make(time: float = 1.0, rows: int = 12, cols: int = 9, pushes: tuple = ()) -> Frame:
        records = np.zeros((rows, cols), POINT_DTYPE)
        records['x'] = np.linspace(-0.5, 0.5, cols)
        records['z'] = np.linspace(1.0, 0.0, rows)[:, None]
        records['normal_y'] = -1.0
        records['strain'] = np.linspace(0.04, 0.0, rows)[:, None]
        records['flags'][0, [0, -1]] = FLAG_PINNED
        return Frame(time, records, pushes)

    return make
