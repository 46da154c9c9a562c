# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Replay a recording: the same messages on the same topics, at the recorded rate.

Recordings of this project are timed by simulated time, bags of `ros2 bag record` by wall time. The
player is the node /cloth_sim_player: pause and resume it with
`cloth_sim pause --node cloth_sim_player` and `cloth_sim resume --node cloth_sim_player`. Ctrl-C
stops it.

For example:
  cloth_sim play bags/drop_test
  cloth_sim play bags/drop_test --rate 0.2 --start 1.5 --loop
  cloth_sim play bags/drop_test --as replay/cloth_sim
"""

from argparse import ArgumentParser
from argparse import Namespace
import sys

from cloth_sim_ros.analysis.recording import find_node
from cloth_sim_ros.node.shared_memory import use_profile
from cloth_sim_ros.playback.played_topics import CLOCK
from cloth_sim_ros.playback.player import Player
from cloth_sim_ros.playback.player import PlayerNode
from cloth_sim_ros.playback.schedule import PlayClock
from cloth_sim_ros.playback.schedule import PlayOptions
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.verb.progress import PlayProgress
from cloth_sim_ros.verb.recording_arguments import add_recording_arguments
from cloth_sim_ros.verb.termination import StopSignals


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_recording_arguments(parser)
    parser.add_argument(
        '--rate', type=float, default=1.0, metavar='R',
        help='recorded seconds per second of wall time (default: %(default)s)')
    parser.add_argument('--loop', action='store_true', help='restart at the end')
    parser.add_argument(
        '--start', type=float, default=0.0, metavar='S',
        help='start this long after the beginning of the recording [s]; the topology, state and '
             'parameters at that time are published first')
    parser.add_argument(
        '--duration', type=float, default=float('inf'), metavar='S',
        help='recorded time to play [s] (default: all)')
    parser.add_argument(
        '--topics', nargs='+', default=(), metavar='TOPIC', help='topics to play (default: all)')
    parser.add_argument(
        '--as', metavar='NAME', dest='played_node', default='',
        help='node name under which the topics of the recorded node are published')
    parser.add_argument(
        '--clock', action='store_true',
        help='publish time on /clock: the recorded /clock, or the stamps of the frames where none '
             'is recorded; without this, no /clock is played')
    parser.add_argument(
        '--paused', action='store_true', help='start paused; continue with cloth_sim resume')
    parser.add_argument(
        '--delay', type=float, default=1.0, metavar='S',
        help='time for subscribers to discover the player before the first message [s] '
             '(default: %(default)s)')


def main(args: Namespace) -> int:
    """Play, and say how it went."""
    with StopSignals() as signals, PlayProgress() as progress:
        bag = BagReader(args.recording)
        largest = _largest_message(bag)
        if warning := use_profile(largest).warning(largest):
            progress.warn(warning)
        options = _options(args, bag)
        clock = PlayClock(options.rate)
        with PlayerNode(clock) as node:
            player = Player(
                bag, options, node, clock, stopped=lambda: signals.came, warn=progress.warn,
                progress=progress.show)
            progress.begin(*player.span)
            report = player.play()
    told, *problems = report.sentences()
    print(told)
    for problem in [*problems, *bag.problems]:
        print(f'cloth_sim play: {problem}', file=sys.stderr)
    return 0


def _largest_message(bag: BagReader) -> int:
    """Return the size of the largest first message of a topic [bytes]: those of one are alike."""
    firsts = (next(bag.messages([topic.name]), None) for topic in bag.topics if topic.count)
    return max((len(message.data) for message in firsts if message), default=0)


def _options(args: Namespace, bag: BagReader) -> PlayOptions:
    node = args.node
    if node is None:
        # A bag of a robot has a clock of its own, and no cloth.
        has_clock = CLOCK in (args.topics or [topic.name for topic in bag.topics])
        is_needed = args.played_node or (args.clock and not has_clock)
        node = find_node(bag.topics, bag.path) if is_needed else ''
    return PlayOptions(
        rate=args.rate, loop=args.loop, start=args.start, duration=args.duration,
        topics=tuple(args.topics), paused=args.paused, clock=args.clock, delay=args.delay,
        node=node, played_node=args.played_node)
