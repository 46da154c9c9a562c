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


"""
Tell what a recording holds: the cloth, what was done to it, strain, energies and pace.

Needs no node.

For example:
  cloth_sim info bags/cloth_2026_01_31-12_00_00
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.verb.recording_arguments import add_recording_arguments
from cloth_sim_ros.verb.recording_arguments import open_recording


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_recording_arguments(parser)


def main(args: Namespace) -> int:
    """Print the summary."""
    summary = summarise(open_recording(args))
    lines = {
        'cloth': f'{summary.rows} x {summary.cols} nodes',
        'mode': ', '.join(summary.modes) or 'not recorded',
        'device': summary.device or 'not recorded',
        'time': f'{summary.begin:.6g} to {summary.end:.6g} s, {summary.frames} frames',
        'dt': f'{summary.dt:.6g} s in {summary.substeps} substeps',
        'real-time factor': f'{summary.real_time_factor:.3g}, median of the frames that ran',
        'done to the cloth': f'{summary.pushes} pushes, {summary.releases} nodes released, '
                             f'{summary.pins} pinned, {summary.resets} resets',
        'max strain': f'{summary.last_strain:.3g} at the end, {summary.largest_strain:.3g} at '
                      'the most',
        'kinetic energy': f'{summary.last_kinetic_energy:.3g} J at the end, '
                          f'{summary.largest_kinetic_energy:.3g} J at the most',
        'total energy': f'{summary.first_energy:.4g} J at first, {summary.last_energy:.4g} J at '
                        'the end',
        'state': 'finite' if summary.finite else 'broke off: no longer finite',
    }
    for name, value in lines.items():
        print(f'{name:18} {value}')
    return 0
