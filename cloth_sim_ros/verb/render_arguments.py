# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The arguments of the verb render: what is drawn, from where, and how it looks."""

from argparse import ArgumentParser
from argparse import ArgumentTypeError
from argparse import Namespace

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.source import RecordingSource
from cloth_sim_ros.rendering.source import Source
from cloth_sim_ros.rendering.source import StateSource
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.recording_arguments import add_node_argument

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
        title=args.title, columns=args.columns)


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
