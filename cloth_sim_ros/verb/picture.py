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
Draw the cloth of a recording at several times, side by side, into a PNG file.

The colour of the cloth is its strain. Pinned nodes are red; pushes that act are blue arrows.
Without --at, six moments are chosen, so that the pushes are seen. Needs no node.

For example:
  cloth_sim picture bags/cloth_2026_01_31-12_00_00 --out cloth.png
  cloth_sim picture bags/drop_test --out drop.png --at 0.5,1,2 --view 30 10
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.analysis.camera import Camera
from cloth_sim_ros.analysis.frames import default_times
from cloth_sim_ros.analysis.frames import frames_at
from cloth_sim_ros.analysis.picture import write_picture
from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.analysis.summary import Summary
from cloth_sim_ros.verb.recording_arguments import add_recording_arguments
from cloth_sim_ros.verb.recording_arguments import list_of_times
from cloth_sim_ros.verb.recording_arguments import open_recording

_PANELS = 6


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_recording_arguments(parser)
    parser.add_argument('--out', required=True, metavar='FILE.png', help='file to write')
    parser.add_argument(
        '--at', type=list_of_times, metavar='T,T,...', help='times to show [s]')
    parser.add_argument(
        '--view', nargs=2, type=float, metavar=('AZIMUTH', 'ELEVATION'),
        default=(Camera.azimuth, Camera.elevation),
        help='where the camera stands [deg]: from x towards y, and above the horizon '
             '(default: %(default)s)')
    parser.add_argument('--title', help='heading; says what is shown by default')


def main(args: Namespace) -> int:
    """Draw, and say where."""
    recording = open_recording(args)
    summary = summarise(recording)
    frames = frames_at(recording, args.at or default_times(recording, _PANELS))
    write_picture(
        frames, args.out, title=_title(summary) if args.title is None else args.title,
        note=summary.device, camera=Camera(*args.view))
    print(args.out)
    return 0


def _title(summary: Summary) -> str:
    modes = ', '.join(summary.modes) or 'mode unknown'
    return f'{summary.rows} x {summary.cols} nodes, {modes}'
