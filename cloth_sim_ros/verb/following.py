# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Arguments that attach a grasp or a collider to a frame of tf."""

from argparse import Namespace

from cloth_sim_interfaces.srv import FollowFrame
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.node_arguments import open_node

FOLLOW_HELP = 'attach it rigidly to this frame of /tf, as it stands to it now'
UNFOLLOW_HELP = 'detach it from its frame; it stays where it is'
FRAME_HELP = 'frame of /tf in which the point is given (default: that of the node)'


def checked_frame(name: str) -> str:
    """
    Return ``name`` if it can be followed.

    :raises ClothSimError: when it is empty, which means no frame to the node
    """
    if not name:
        raise ClothSimError(
            "--follow must be the name of a frame of /tf, got '': give one, or --unfollow")
    return name


def follow(args: Namespace, service: str) -> str:
    """
    Attach ``args.name`` to the frame ``args.follow``, or detach it; return the node's message.

    :param service: follow_grasp or follow_collider
    """
    request = FollowFrame.Request(
        name=args.name, frame='' if args.unfollow else checked_frame(args.follow),
        max_speed=args.speed or 0.0, max_angular_speed=getattr(args, 'angular_speed', None) or 0.0)
    with open_node(args) as node:
        return node.call(FollowFrame, service, request).message
