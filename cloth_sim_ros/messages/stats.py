# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One frame in plain numbers."""

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.snapshot import Snapshot
from std_msgs.msg import Header


def stats_message(
        snapshot: Snapshot, frame_id: str, *, step_wall_time: float = 0.0,
        real_time_factor: float = 0.0, wanted_factor: float = 0.0,
        too_slow: bool = False) -> ClothStats:
    """
    Return the plain numbers of ``snapshot``.

    :param step_wall_time: wall time of one dt, mean over this frame [s]
    :param real_time_factor: simulated time per wall time, achieved
    :param wanted_factor: the same as asked for, 0 for as fast as possible
    :param too_slow: True when the last second fell short of that
    """
    return ClothStats(
        header=Header(stamp=stamp(snapshot.time), frame_id=frame_id),
        sim_time=float(snapshot.time),
        steps=int(snapshot.steps),
        dt=float(snapshot.dt),
        substeps=int(snapshot.substeps),
        stability_margin=float(snapshot.stability_margin),
        kinetic_energy=float(snapshot.kinetic_energy),
        elastic_energy=float(snapshot.elastic_energy),
        gravitational_energy=float(snapshot.gravitational_energy),
        total_energy=float(snapshot.total_energy),
        max_strain=float(snapshot.max_strain),
        solver_iterations=int(snapshot.solver_iterations),
        solver_residual=float(snapshot.solver_residual),
        solver_reached=bool(snapshot.solver_reached),
        active_constraints=int(snapshot.active_constraints),
        active_fraction=float(snapshot.active_fraction),
        constraint_switches=int(snapshot.constraint_switches),
        lengths_are_held=bool(snapshot.lengths_are_held),
        stalled_pins=int(snapshot.stalled_pins),
        sticking_nodes=int(snapshot.sticking_nodes),
        sliding_nodes=int(snapshot.sliding_nodes),
        deepest_node=float(snapshot.deepest_node),
        step_wall_time=float(step_wall_time),
        real_time_factor=float(real_time_factor),
        real_time_factor_wanted=float(wanted_factor),
        too_slow=bool(too_slow))
