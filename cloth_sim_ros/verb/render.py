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
from argparse import ArgumentTypeError
from argparse import Namespace

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.daylight import LOOKS
from cloth_sim_ros.rendering.daylight import STRAIN
from cloth_sim_ros.rendering.picture import write_picture
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.source import RecordingSource
from cloth_sim_ros.rendering.source import Source
from cloth_sim_ros.rendering.source import StateSource
from cloth_sim_ros.rendering.video import write_video
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.recording_arguments import add_node_argument
from cloth_sim_ros.verb.recording_arguments import list_of_times

_LEAST_SIDE, _MOST_SIDE = 32, 8192  # [pixel]


def add_source_arguments(parser: ArgumentParser) -> None:
    """Add the recordings and the name of their node."""
    parser.add_argument(
        'sources', nargs='+', metavar='BAG|STATE.npz',
        help='folder of a recording, or a state file')
    add_node_argument(parser)


def add_camera_arguments(parser: ArgumentParser) -> None:
    """Add where the camera stands."""
    group = parser.add_argument_group('camera')
    group.add_argument(
        '--azimuth', type=float, default=Camera.azimuth, metavar='DEG',
        help='azimuth of the camera, from x towards y (default: %(default)s)')
    group.add_argument(
        '--elevation', type=float, default=Camera.elevation, metavar='DEG',
        help='elevation of the camera above the horizon (default: %(default)s)')
    group.add_argument(
        '--fov', type=float, default=Camera.field_of_view, metavar='DEG',
        help='vertical field of view; 0 for no perspective (default: %(default)s)')
    group.add_argument(
        '--zoom', type=float, default=1.0,
        help='magnification; 1 fits everything (default: %(default)s)')
    group.add_argument(
        '--target', nargs=3, type=float, metavar=('X', 'Y', 'Z'),
        help='point at the centre of the image [m]')


def add_style_arguments(parser: ArgumentParser) -> None:
    """Add how the picture looks."""
    group = parser.add_argument_group('style')
    group.add_argument(
        '--size', type=pixels, metavar='WIDTHxHEIGHT', help='size of each panel [pixel]')
    group.add_argument(
        '--strain-max', type=float, metavar='S',
        help='strain at the end of the colour scale, 0.05 for 5 %% (default: fit to the data)')
    group.add_argument(
        '--look', choices=LOOKS, default=STRAIN,
        help='colour the cloth by its strain, or draw a fabric in daylight (default: %(default)s)')
    group.add_argument('--labels', nargs='+', metavar='NAME', help='names of the recordings')
    group.add_argument('--title', help='title (default: generated from the contents)')


def sources_of(args: Namespace) -> list[Source]:
    """Return what is to be drawn; ClothSimError for what can't be read."""
    return [
        StateSource(path) if path.endswith('.npz')
        else RecordingSource(Recording(path, args.node)) for path in args.sources]


def style_of(args: Namespace) -> Style:
    """Return the look that the arguments mean."""
    if args.labels is not None and len(args.labels) != len(args.sources):
        raise ClothSimError(
            f'--labels has {len(args.labels)} names for {len(args.sources)} recordings: give one '
            'for each')
    if args.columns < 1:
        raise ClothSimError(f'--columns must be 1 or more, got {args.columns}')
    camera = Camera(
        args.azimuth, args.elevation, args.fov, args.zoom,
        None if args.target is None else tuple(args.target))
    return Style(
        camera=camera, panel=args.size, strain_max=args.strain_max, labels=args.labels,
        title=args.title, columns=args.columns, look=args.look)


def pixels(text: str) -> tuple[int, int]:
    """Read a size, as in 640x480."""
    try:
        width, height = (int(part) for part in text.split('x'))
    except ValueError as error:
        raise ArgumentTypeError(f'{shown(text)} is not a size: write it as in 640x480') from error
    if not all(_LEAST_SIDE <= side <= _MOST_SIDE for side in (width, height)):
        raise ArgumentTypeError(
            f'a side must be from {_LEAST_SIDE} to {_MOST_SIDE} pixels, got {cut(text)}')
    return width, height


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
