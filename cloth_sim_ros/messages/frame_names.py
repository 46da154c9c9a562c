# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The names of the frames of grasps and colliders."""


def grasp_frame(node_name: str, name: str) -> str:
    """Return the name of the frame of the grasp ``name``."""
    return f'{frame_prefix(node_name)}_grasp_{name}'


def collider_frame(node_name: str, name: str) -> str:
    """Return the name of the frame of the collider ``name``."""
    return f'{frame_prefix(node_name)}_collider_{name}'


def frame_prefix(node_name: str) -> str:
    """Return what all frames of a node begin with; unlike names of nodes they have no slashes."""
    return node_name.strip('/').replace('/', '_')
