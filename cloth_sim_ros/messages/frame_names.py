# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The names of the frames of pins, grasps, colliders and cameras."""

import re


def grasp_frame(node_name: str, name: str) -> str:
    """Return the name of the frame of the grasp ``name``."""
    return f'{frame_prefix(node_name)}_grasp_{name}'


def collider_frame(node_name: str, name: str) -> str:
    """Return the name of the frame of the collider ``name``."""
    return f'{frame_prefix(node_name)}_collider_{name}'


def camera_frame(node_name: str, name: str) -> str:
    """Return the name of the optical frame of the camera ``name``."""
    return f'{frame_prefix(node_name)}_camera_{name}_optical'


def name_of_body(frame: str, kind: str) -> str:
    """
    Return the name of the grasp or collider that ``frame`` is named after; '' when of none.

    :param kind: grasp or collider
    """
    return frame.partition(f'_{kind}_')[2]


def frame_prefix(node_name: str) -> str:
    """Return what all frames of a node begin with; unlike names of nodes they have no slashes."""
    return node_name.strip('/').replace('/', '_')


# The names of the frames of pins.

_PIN = re.compile(r'_pin_(\d{1,9})_(\d{1,9})$')


def pin_frame(node_name: str, row: int, col: int) -> str:
    """Return the name of a pin's frame."""
    return f'{frame_prefix(node_name)}_pin_{row}_{col}'


def node_of_pin(frame: str) -> tuple[int, int] | None:
    """Return row and col of the pin that ``frame`` is named after; None when it is of no pin."""
    found = _PIN.search(frame)
    return (int(found[1]), int(found[2])) if found else None
