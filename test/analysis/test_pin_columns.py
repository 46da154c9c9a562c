# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The forces at pins as columns."""

from types import SimpleNamespace

from cloth_sim_ros.analysis.entry import Entry
from cloth_sim_ros.analysis.pin_columns import LARGEST
from cloth_sim_ros.analysis.pin_columns import MOST_PINS
from cloth_sim_ros.analysis.pin_columns import PinColumns
from cloth_sim_ros.analysis.pin_columns import SUM
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Wrench
from geometry_msgs.msg import WrenchStamped
import numpy as np
from std_msgs.msg import Header


def columns_of(times, *forces):
    """Return the columns of forces, each given as time, frame and vector."""
    pins = PinColumns()
    for time, frame, (x, y, z) in forces:
        pins.read(Entry('pins/wrenches', time, WrenchStamped(
            header=Header(frame_id=frame), wrench=Wrench(force=Vector3(x=x, y=y, z=z)))))
    moments = SimpleNamespace(time=np.array(times), resets=np.zeros(len(times)))
    return pins.columns(vars(moments))


def test_pins_are_summed_and_told_apart():
    """The force of one pin would stand in the column of another, or be lost in the sum."""
    columns = columns_of(
        [0.0, 0.5, 1.0], (0.0, 'cloth_sim_pin_0_0', (3.0, 0.0, 4.0)),
        (0.0, 'cloth_sim_pin_0_12', (-1.0, 2.0, 0.0)),
        (1.0, 'cloth_sim_pin_0_12', (0.0, 0.0, 2.0)))
    np.testing.assert_array_equal(
        np.stack([columns[name] for name in SUM], axis=1),
        [(2.0, 2.0, 4.0), (np.nan,) * 3, (0.0, 0.0, 2.0)])
    np.testing.assert_array_equal(columns[LARGEST], [5.0, np.nan, 2.0])
    np.testing.assert_array_equal(columns['pin_0_0_force_z'], [4.0, np.nan, np.nan])
    np.testing.assert_array_equal(columns['pin_0_12_force_z'], [0.0, np.nan, 2.0])


def test_many_pins_have_no_columns_of_their_own():
    """An edge of 100 pins would make a table of 300 columns."""
    forces = [
        (0.0, f'cloth_sim_pin_0_{col}', (0.0, 0.0, 1.0)) for col in range(MOST_PINS + 1)]
    columns = columns_of([0.0], *forces)
    assert set(columns) == {*SUM, LARGEST}
    assert columns[SUM[2]].tolist() == [MOST_PINS + 1]


def test_frames_of_others_are_passed_over():
    """A wrench of a robot's wrist on our topic would count as a pin."""
    columns = columns_of([0.0], (0.0, 'wrist', (1.0, 0.0, 0.0)))
    assert np.isnan(columns[LARGEST]).all()
