# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the simulation is doing, for people and tools that come late."""

from collections.abc import Sequence

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.simulation import Simulation
from std_msgs.msg import Header


def state_of(
        simulation: Simulation, *, frame_id: str, run_state: str, preparing: str = '',
        compiled: int = 0, recording_path: str = '') -> ClothState:
    """Return the state of ``simulation`` now; the rest as in state_message."""
    return state_message(
        frame_id=frame_id, sim_time=simulation.time, mode=simulation.mode,
        available_modes=simulation.available_modes, run_state=run_state,
        rows=simulation.scene.rows, cols=simulation.scene.cols, dt=simulation.dt,
        substeps=simulation.substeps, stability_limit=simulation.stability_limit,
        device=simulation.device, preparing=preparing, compiled=compiled,
        recording_path=recording_path)


def state_message(
        *, frame_id: str, sim_time: float, mode: str, available_modes: Sequence[str],
        run_state: str, rows: int, cols: int, dt: float, substeps: int, stability_limit: float,
        device: str, preparing: str = '', compiled: int = 0,
        recording_path: str = '') -> ClothState:
    """
    Return the state of the node.

    :param run_state: ClothState.PREPARING, RUNNING, PAUSED or STOPPED
    :param dt: [s]
    :param stability_limit: longest stable substep of this mode [s]
    :param device: GL_RENDERER
    :param preparing: mode that is being compiled, empty when none is
    :param compiled: its programs that are ready
    :param recording_path: folder being written to, empty when not recording
    """
    return ClothState(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id),
        mode=mode,
        preparing=preparing,
        compiled=compiled,
        available_modes=list(available_modes),
        run_state=run_state,
        rows=rows,
        cols=cols,
        dt=dt,
        substeps=substeps,
        stability_limit=float(stability_limit),
        device=device,
        recording=bool(recording_path),
        recording_path=recording_path)
