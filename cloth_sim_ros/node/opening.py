# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a recording begins with, so that it needs nothing from before its start."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.messages.inputs import mode_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import pin_message
from cloth_sim_ros.messages.inputs import pin_target_message
from cloth_sim_ros.messages.inputs import push_message
from cloth_sim_ros.messages.inputs import wind_message
from cloth_sim_ros.messages.parameter_event import serialise_parameter_event
from cloth_sim_ros.messages.topology import serialise_topology
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from rclpy.serialization import serialize_message


def write_opening(
        recording: RecordingSession, simulation: Simulation, values: Mapping[str, Any],
        node_name: str) -> None:
    """
    Record the rest shape, and as inputs all that holds now.

    Pins are written where they differ from the parameter, and their targets where they are under
    way; pushes where they act or will act; the wind where it is not that of the parameter.

    :param values: parameter values by name
    :param node_name: with its namespace
    """
    now = simulation.time
    frame_id = values['frame_id']
    recording.write('topology', serialise_topology(simulation.scene), now)
    parameters = parameters_message(values, FIELDS, now, node_name)
    recording.write('inputs/parameters', serialise_parameter_event(parameters), now)
    inputs = [('inputs/mode', mode_message(simulation.mode, '', now, frame_id))]
    pinned = simulation.pinned_nodes()
    for row, col in np.argwhere(pinned != simulation.scene.pinned_nodes()).tolist():
        inputs.append(
            ('inputs/pin', pin_message(row, col, bool(pinned[row, col]), now, frame_id)))
    for move in simulation.pin_moves:
        inputs.append(('inputs/pin_target', pin_target_message(move, now, frame_id)))
    for applied in simulation.pushes:
        inputs.append(('inputs/push', push_message(applied.push, now, frame_id)))
    if simulation.loads.wind not in (None, simulation.scene['air.wind']):
        inputs.append(('inputs/wind', wind_message(simulation.loads.wind, now, frame_id)))
    for key, message in inputs:
        recording.write(key, serialize_message(message), now)
