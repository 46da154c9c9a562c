# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Show the state of a running node and the statistics of its latest frame.

For example:
  cloth_sim status
  cloth_sim status --json
  cloth_sim status --until 2.5
"""

from argparse import ArgumentParser
from argparse import Namespace
import json
import sys
from typing import Any

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import TimeBase
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from cloth_sim_ros.verb.node_client import NodeClient
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile

_FRAMES = QoSProfile(depth=10)
_KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('--json', action='store_true', help='print one JSON object')
    parser.add_argument(
        '--until', type=float, metavar='T',
        help='wait until the running node reaches this simulated time [s]')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Print the state and the stats."""
    with open_node(args) as node:
        if args.until is not None:
            _wait_until(node, args.until)
        state = _plain(_state(node)) | _time(node)
        stats: dict[str, Any] = {}
        try:
            stats = _plain(node.read(ClothStats, 'stats', _FRAMES))
        except ClothSimError as error:
            # A node may have publish.stats off; its state is known without them.
            print(f'cloth_sim status: {error}', file=sys.stderr)
    print(json.dumps({'state': state, 'stats': stats or None}) if args.json else
          _text({**state, 'epoch': f'{state["epoch"]:.3f}', **stats}))
    return 0


def _wait_until(node: NodeClient, sim_time: float) -> None:
    while True:
        seen: set[float] = set()
        stats = node.read(
            ClothStats, 'stats', _FRAMES,
            lambda stats: stats.sim_time >= sim_time or _stands_still(stats, seen))
        if stats.sim_time >= sim_time:
            return
        state = _state(node)
        if state.run_state != ClothState.RUNNING:
            raise ClothSimError(
                f'the node is {state.run_state} at {stats.sim_time:.6g} s and will not reach '
                f'{sim_time:g} s: continue it with `cloth_sim resume`')


def _stands_still(stats: ClothStats, seen: set[float]) -> bool:
    """Return whether the moment was shown before, as it is while simulated time stands still."""
    shown_before = stats.sim_time in seen
    seen.add(stats.sim_time)
    return shown_before


def _state(node: NodeClient) -> ClothState:
    return node.read(ClothState, 'state', _KEPT)


def _time(node: NodeClient) -> dict[str, Any]:
    """Return what the stamps are of, and the stamp of simulated time 0 [s]."""
    base = node.read(TimeBase, 'inputs/time_base', _KEPT)
    return {'time_source': base.source, 'epoch': base.epoch.sec + 1e-9 * base.epoch.nanosec}


def _plain(message: Any) -> dict[str, Any]:
    fields = (name for name in message.get_fields_and_field_types() if name != 'header')
    return {name: getattr(message, name) for name in fields}


def _text(values: dict[str, Any]) -> str:
    return '\n'.join(f'{name:22} {_word(value)}' for name, value in values.items())


def _word(value: Any) -> str:
    if isinstance(value, list):
        return ', '.join(value)
    return f'{value:.6g}' if isinstance(value, float) else str(value)
