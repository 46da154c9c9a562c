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

"""What a run came to, by its recording alone."""

from dataclasses import dataclass

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.analysis.recording import Recording


@dataclass
class RunOutcome:
    """
    Peaks are those of the recorded frames.

    :param end: time of the last frame [s]
    :param dt: [s]
    :param substeps: of a dt, mean over the frames that moved on
    :param max_strain: largest of any structural or shear spring
    :param kinetic_energy: largest [J]
    :param stability_margin: largest; above 1 the substep is longer than is stable
    :param wall_seconds: spent on the steps
    :param device: GL_RENDERER
    :param stopped: True when the next state was not finite
    """

    end: float = 0.0
    dt: float = 0.0
    substeps: float = 0.0
    max_strain: float = 0.0
    kinetic_energy: float = 0.0
    stability_margin: float = 0.0
    wall_seconds: float = 0.0
    device: str = ''
    stopped: bool = False


def read_outcome(recording: Recording) -> RunOutcome:
    """Read ``recording`` once; ClothSimError when it holds no frame."""
    outcome = RunOutcome()
    frames, moved, substeps, steps = 0, 0, 0, 0
    for entry in recording.entries('stats', 'state'):
        message = entry.message
        if entry.key == 'state':
            outcome.device = message.device
            outcome.stopped = message.run_state == ClothState.STOPPED
            continue
        outcome.end, outcome.dt = entry.time, message.dt
        outcome.max_strain = max(outcome.max_strain, message.max_strain)
        outcome.kinetic_energy = max(outcome.kinetic_energy, message.kinetic_energy)
        outcome.stability_margin = max(outcome.stability_margin, message.stability_margin)
        frames += 1
        if message.steps > steps:
            outcome.wall_seconds += message.step_wall_time * (message.steps - steps)
            moved += 1
            substeps += message.substeps
        steps = message.steps
    if not frames:
        raise recording.no_frame()
    outcome.substeps = substeps / max(moved, 1)
    return outcome
