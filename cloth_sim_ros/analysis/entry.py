# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One message of a recording."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Entry:
    """
    One message of a recording.

    :param key: the topic behind the name of the node, such as points or inputs/push
    :param time: [s] simulated, continuing across resets
    :param message: decoded
    :param resets: of the run, before this message
    """

    key: str
    time: float
    message: Any
    resets: int = 0
