# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Render recordings as a sheet of images or as a video. Needs no node and no window.

The colour of the cloth shows its strain. Balls are pins, arrows are active pushes, dots are nodes
at their strain limit; what the cloth can touch is grey. Without --at, the times are chosen so that
the pushes are visible. Several recordings get one row each, with the same camera. A state written
by `cloth_sim run --out` can replace a recording.

For example:
  cloth_sim render bags/drop_test --out drop.png --at 0.5,1,2 --azimuth 30 --elevation 10
  cloth_sim render bags/soft bags/stiff --labels soft stiff --out both.png --at 0.5,1,2
  cloth_sim render state.npz --out state.png
  cloth_sim render bags/drop_test --video drop.mp4 --speed 0.25
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.rendering.picture import write_picture
from cloth_sim_ros.rendering.video import write_video
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.recording_arguments import list_of_times
from cloth_sim_ros.verb.render_arguments import add_camera_arguments
from cloth_sim_ros.verb.render_arguments import add_source_arguments
from cloth_sim_ros.verb.render_arguments import add_style_arguments
from cloth_sim_ros.verb.render_arguments import sources_of
from cloth_sim_ros.verb.render_arguments import style_of


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_source_arguments(parser)
    sheet = parser.add_argument_group('sheet of images')
    sheet.add_argument('--out', metavar='FILE.png', help='image to write')
    sheet.add_argument('--at', type=list_of_times, metavar='T,T,...', help='times to show [s]')
    sheet.add_argument(
        '--columns', type=int, default=3, metavar='N',
        help='panels per row for a single recording (default: %(default)s)')
    video = parser.add_argument_group('video')
    video.add_argument('--video', metavar='FILE.mp4', help='video to write')
    video.add_argument(
        '--fps', type=float, default=30.0,
        help='frames per second of the video (default: %(default)s)')
    video.add_argument(
        '--speed', type=float, default=1.0,
        help='simulated seconds per second of video (default: %(default)s)')
    video.add_argument('--from', type=float, dest='begin', metavar='T', help='start time [s]')
    video.add_argument('--to', type=float, dest='end', metavar='T', help='end time [s]')
    add_camera_arguments(parser)
    add_style_arguments(parser)


def main(args: Namespace) -> int:
    """Draw, and say where."""
    if not args.out and not args.video:
        raise ClothSimError('there is nothing to write: give --out FILE.png or --video FILE.mp4')
    style = style_of(args)
    sources = sources_of(args)
    if args.out:
        write_picture(sources, args.out, times=args.at, style=style)
        print(args.out)
    if args.video:
        write_video(
            sources, args.video, style=style, fps=args.fps, speed=args.speed, begin=args.begin,
            end=args.end)
        print(args.video)
    return 0
