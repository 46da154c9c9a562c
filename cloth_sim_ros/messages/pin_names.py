# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The names of the frames of pins."""

import re

from cloth_sim_ros.messages.frame_names import frame_prefix

_PIN = re.compile(r'_pin_(\d{1,9})_(\d{1,9})$')


def pin_frame(node_name: str, row: int, col: int) -> str:
    """Return the name of a pin's frame."""
    return f'{frame_prefix(node_name)}_pin_{row}_{col}'


def node_of_pin(frame: str) -> tuple[int, int] | None:
    """Return row and col of the pin that ``frame`` is named after; None when it is of no pin."""
    found = _PIN.search(frame)
    return (int(found[1]), int(found[2])) if found else None
