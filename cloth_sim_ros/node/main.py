# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The command `cloth_sim_node`: start the node, or say in one line why it can't start."""

from collections.abc import Sequence
import signal
import sys

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.node.dead_segments import reclaim_dead_segments
from cloth_sim_ros.node.grid_arguments import grid_of_arguments
from cloth_sim_ros.node.large_messages import frame_bytes
from cloth_sim_ros.node.large_messages import use_profile
from cloth_sim_ros.node.missing_module import way_out
from cloth_sim_ros.sim.errors import ClothSimError


def main(args: Sequence[str] | None = None) -> int:
    """Run the node until SIGINT or SIGTERM and return the exit code."""
    # Until the node can take care of it, an interrupt ends the process without a traceback.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    args = sys.argv if args is None else args
    try:
        # Before ROS starts, and first what gives room to the second.
        reclaimed = reclaim_dead_segments()
        memory = use_profile(frame_bytes(*grid_of_arguments(args)))
        # Imported here, so that a missing ROS or interface package gets an answer as well.
        from cloth_sim_ros.node.process import run_node
        run_node(args, memory, reclaimed)
    except ImportError as error:
        problem = way_out(error)
    except (ClothSimError, DeviceError) as error:
        problem = ' '.join(str(error).split())
    else:
        return 0
    print(f'cloth_sim_node: {problem}', file=sys.stderr)
    return 1
