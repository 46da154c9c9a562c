# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Forces on pins and grasps, for a snapshot and for the max. force of pins."""

from dataclasses import replace

from cloth_sim_ros.sim.held.force_window import forces_at
from cloth_sim_ros.sim.held.grasps import Grasps
from cloth_sim_ros.sim.held.held_impulses import Impulses
from cloth_sim_ros.sim.held.pin_forces import edge_pulls
from cloth_sim_ros.sim.held.pin_motion import Node
from cloth_sim_ros.sim.held.pin_motion import PinMotion
from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.state import State
import numpy as np


def with_forces(
        snapshot: Snapshot, mode: Mode, impulses: Impulses | None, node_mass: float, *,
        every_edge: bool, has_forces: bool) -> Snapshot:
    """
    Return ``snapshot`` with the forces on its pins, means over the last step of dt.

    :param mode: that made its last step
    :param impulses: of that step
    :param has_forces: False where they are not known, which leaves out the forces
    :param every_edge: True to add the tension of every edge too, at a cost that grows with the
        cloth
    """
    tension = None
    if every_edge:
        # A state that is not finite has no finite forces either.
        with np.errstate(invalid='ignore', over='ignore'):
            tension = mode.tension(snapshot.positions, snapshot.velocities)
    nodes = np.argwhere(snapshot.flags & FLAG_PINNED)
    return replace(
        snapshot, tension=tension,
        pin_forces=(
            forces_at(impulses, nodes, node_mass, snapshot.dt) if has_forces else None))


def pulled_too_hard(scene: Scene, state: State, mode: Mode, pins: PinMotion) -> list[Node]:
    """Return the moving pins that edges pull harder at than ``pin.max_force`` now."""
    most, nodes = scene['pin.max_force'], pins.moving
    if not (most and nodes):
        return []
    too_hard = np.linalg.norm(_pulls(scene, state, mode, np.array(nodes)), axis=-1) > most
    return [node for node, is_too_hard in zip(nodes, too_hard) if is_too_hard]


def lost_grasps(
        scene: Scene, state: State, mode: Mode, grasps: Grasps, now: float) -> list[str]:
    """Return the grasps that edges pull harder at, all nodes together, than they hold ``now``."""
    limited = [grasp for grasp in grasps.present(now) if grasp.max_force]
    pulls = (_pulls(scene, state, mode, grasp.nodes).sum(axis=0) for grasp in limited)
    return [
        grasp.name for grasp, pull in zip(limited, pulls)
        if float(np.linalg.norm(pull)) > grasp.max_force]


def _pulls(scene: Scene, state: State, mode: Mode, nodes: np.ndarray) -> np.ndarray:
    positions, velocities = state.read_positions(), state.read_velocities()
    # A state that is not finite has no finite forces either.
    with np.errstate(invalid='ignore', over='ignore'):
        return edge_pulls(
            scene, positions, velocities, mode.tension(positions, velocities, nodes), nodes)
