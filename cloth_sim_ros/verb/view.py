# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
View a cloth in the browser: that of a running node, of a scene or of a recording.

The colour of the cloth shows its strain. A panel has mode, pause, step and reset. A click on the
cloth pushes it away from the viewer, or pins a node; the arrows at a pin drag it. The page opens
at the printed address, which ends with a key that is new each time, and only on this machine
unless --host is given. Ctrl-C stops the server. Needs viser: scripts/setup.sh --view.

For example:
  cloth_sim view
  cloth_sim view --node left/cloth_sim
  cloth_sim view config/towel.yaml --set total_mass=0.3
  cloth_sim view bags/drop_test --port 8090
"""

from argparse import ArgumentParser
from argparse import Namespace
from pathlib import Path
import sys
import time

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import use_the_memory_there_is
from cloth_sim_ros.verb.scene_arguments import add_tuning_argument
from cloth_sim_ros.verb.scene_arguments import parse_change
from cloth_sim_ros.verb.scene_arguments import scene_from
from cloth_sim_ros.view.source import Source

_LOOPBACK = '127.0.0.1'
_PORT = 8080
_MOST_FPS = 100.0


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument(
        'shown', nargs='?', metavar='SHOWN',
        help='scene file (.yaml) or recording (default: the running node)')
    parser.add_argument(
        '--set', action='append', default=[], metavar='name=value', dest='changes',
        help='set a parameter of the scene; can be given several times')
    parser.add_argument(
        '--paused', action='store_true', help='start a scene or recording paused')
    parser.add_argument(
        '--port', type=int, default=_PORT, metavar='N',
        help='port of the page (default: %(default)s)')
    parser.add_argument(
        '--host', default=_LOOPBACK, metavar='ADDRESS',
        help='address to serve the page on; with 0.0.0.0, whoever on the network has the '
             'printed address can view and control the cloth (default: %(default)s)')
    parser.add_argument(
        '--fps', type=float, default=20.0, metavar='F',
        help='maximum frame rate [Hz] (default: %(default)s)')
    add_tuning_argument(parser)
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Serve the view until Ctrl-C."""
    if not 0.0 < args.fps <= _MOST_FPS:
        raise ClothSimError(
            f'--fps must be above 0 and at most {_MOST_FPS:g}, got {args.fps:g}')
    # Viser is optional; without it this says so before anything is started.
    from cloth_sim_ros.view.server import open_server
    from cloth_sim_ros.view.window import Window
    with open_server(args.host, args.port) as server:
        source = _source(args)
        try:
            window = Window(server, source)
            print(
                f'{source.name} is shown at {server.address}; Ctrl-C ends the view', flush=True)
            while True:
                begin = time.monotonic()
                window.refresh()
                time.sleep(max(begin + 1.0 / args.fps - time.monotonic(), 0.0))
        finally:
            source.close()


def _source(args: Namespace) -> Source:
    if args.shown is not None and Path(args.shown).suffix in ('.yaml', '.yml'):
        from cloth_sim_ros.view.scene_source import SceneSource
        scene, node_values = scene_from(args.shown, dict(map(parse_change, args.changes)))
        return SceneSource(
            scene, Path(args.shown).stem, frame_seconds=1.0 / node_values['publish.rate'],
            is_paused=args.paused)
    if args.changes:
        raise ClothSimError('--set changes a scene: give a scene file (.yaml) to show')
    if args.shown is not None:
        from cloth_sim_ros.view.recording_source import RecordingSource
        recording = RecordingSource(args.shown)
        for problem in recording.problems:
            print(f'cloth_sim view: {problem}', file=sys.stderr)
        recording.set_paused(args.paused)
        return recording
    from cloth_sim_ros.view.ros.node_source import NodeSource
    use_the_memory_there_is()
    return NodeSource(args.node, args.timeout)
