# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""What each pin feels, as one message a pin."""

from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.snapshot import Snapshot
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Wrench
from geometry_msgs.msg import WrenchStamped
from std_msgs.msg import Header

# More would keep the node from stepping; subscribers must have room for all of a frame.
MOST_PINS = 1024


def wrench_messages(snapshot: Snapshot, frame_id: str) -> list[WrenchStamped]:
    """
    Return the force of the cloth on the holder of each pin [N], row by row.

    It is the opposite of Snapshot.pin_forces: what a force sensor in the gripper measures, with
    the gripper's own weight taken off. A node is a point, so the torque is 0. The frame of a
    message names the pin; its axes are parallel to those of ``frame_id``.

    :param snapshot: with its pin_forces
    """
    time = stamp(snapshot.time)
    return [
        WrenchStamped(
            header=Header(stamp=time, frame_id=f'{frame_id}/pin_{row}_{col}'),
            wrench=Wrench(force=Vector3(x=-x, y=-y, z=-z)))
        for (row, col), (x, y, z) in zip(
            snapshot.pin_forces.nodes.tolist(), snapshot.pin_forces.forces.tolist())]


def too_many_pins(pins: int) -> str:
    """Return why ~/pins/wrenches stays silent with so many pins; empty when it does not."""
    if pins <= MOST_PINS:
        return ''
    return (
        f'~/pins/wrenches is for {MOST_PINS} pins or fewer and there are {pins}, so it stays '
        'silent: release some, or set publish.wrenches: false')
