# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is sent of grasps and colliders: their frames, and what the cloth does to them."""

from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any
from typing import Protocol

from cloth_sim_ros.messages.body_frames import body_frames
from cloth_sim_ros.messages.body_frames import body_poses
from cloth_sim_ros.messages.body_frames import collider_wrenches
from cloth_sim_ros.messages.body_frames import grasp_wrenches
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot

FRAMES, GRASPS, COLLIDERS = 'tf', 'grasps/wrenches', 'colliders/wrenches'
_PARAMETERS = {
    FRAMES: 'publish.tf', GRASPS: 'publish.wrenches', COLLIDERS: 'publish.wrenches'}


class Readers(Protocol):
    """What knows whether a topic is read."""

    def wanted(self, key: str, *, by_recording: bool = True) -> bool:
        """Tell whether anybody reads the topic ``key`` now."""


def wanted_of_bodies(
        simulation: Simulation, values: Mapping[str, Any], readers: Readers, *,
        by_recording: bool = True) -> frozenset[str]:
    """Return which of FRAMES, GRASPS and COLLIDERS are to be sent; GRASPS need the pin forces."""
    there = set()
    if simulation.grasps:
        there |= {FRAMES, GRASPS}
    if simulation.colliders:
        there |= {FRAMES, COLLIDERS}
    return frozenset(
        key for key in there if values[_PARAMETERS[key]]
        and readers.wanted(key, by_recording=by_recording))


def body_messages(
        simulation: Simulation, snapshot: Snapshot, wanted: frozenset[str], node_name: str,
        frame_id: str) -> Sequence[tuple[str, Any]]:
    """Return topics and messages of what is ``wanted``, the frames before what is in them."""
    now, grasps, colliders = snapshot.time, simulation.grasps, simulation.colliders
    messages: list[tuple[str, Any]] = []
    if FRAMES in wanted:
        poses = body_poses(node_name, grasps, colliders)
        messages.append((FRAMES, body_frames(poses, now, frame_id)))
    if GRASPS in wanted:
        wrenches = grasp_wrenches(node_name, grasps, simulation.grasp_forces(snapshot), now)
        messages += [(GRASPS, wrench) for wrench in wrenches]
    if COLLIDERS in wanted:
        wrenches = collider_wrenches(node_name, colliders, simulation.contact_forces(), now)
        messages += [(COLLIDERS, wrench) for wrench in wrenches]
    return messages
