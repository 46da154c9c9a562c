# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frame rates that the paper prints, and the cloths they belong to."""

import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from cloth_sim_ros.sim.scene import FAMILIES

_FILE = Path(__file__).with_name('printed_speeds.csv')
# Section 5 names rates of "30 fps or more" real time.
REAL_TIME = 30.0
TABLE = 'Table 10'


@dataclass(frozen=True)
class PrintedSpeed:
    """
    A cloth with the frame rates that the paper prints for it.

    :param springs: edges; in method constraint those that keep their length
    :param cpu_fps: of one core; None where it prints none
    :param gpu_fps: of the compute shaders; None where it prints none
    :param speed_up: as printed
    :param source: where it is printed
    """

    method: str
    nodes: int
    springs: int
    cpu_fps: float | None
    gpu_fps: float | None
    speed_up: float | None
    source: str


@cache
def printed_speeds() -> tuple[PrintedSpeed, ...]:
    """Return all that the paper prints, in its order."""
    lines = _FILE.read_text(encoding='utf-8').splitlines()
    rows = csv.DictReader(line for line in lines if not line.startswith('#'))
    return tuple(
        PrintedSpeed(
            row['method'], int(row['nodes']), int(row['springs']), _number(row['cpu_fps']),
            _number(row['gpu_fps']), _number(row['speed_up']), row['source'])
        for row in rows)


def edge_count(rows: int, cols: int, families: tuple[str, ...] = FAMILIES) -> int:
    """Return how many edges of ``families`` a grid of ``rows`` x ``cols`` nodes has."""
    def of_pairs(down: int, right: int) -> int:
        return max(rows - down, 0) * max(cols - right, 0)

    counts = {
        'structural': of_pairs(0, 1) + of_pairs(1, 0), 'shear': 2 * of_pairs(1, 1),
        'bend': of_pairs(0, 2) + of_pairs(2, 0)}
    return sum(counts[family] for family in families)


def _number(text: str) -> float | None:
    return float(text) if text else None
