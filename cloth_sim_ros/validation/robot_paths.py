# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
The ways on which the two arms of Blanco-Mulero et al. move the upper corners of a rag.

"Benchmarking the Sim-to-Real Gap in Cloth Manipulation", 2024, DOI 10.1109/LRA.2024.3360814. The
points, times, speeds and accelerations are those of the authors' code (github.com/dblanm/
benchmarking_cloth, bcm/manipulation_utils.py); what computes them here is written anew.

Print the moves of config/fling.yaml:
  python -m cloth_sim_ros.validation.robot_paths
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

# Where the two grippers are along x when the motion begins, from the middle of the rag [m].
GRIPPERS = (-0.23, 0.248)
# How long they take to close in on that from the rag's corners, before they wait [s].
CLOSE_SECONDS = 0.4

# Time [s], place [m], velocity [m/s] and acceleration [m/s2] at a point of a way.
Knot = tuple[float, float, float, float]


@dataclass(frozen=True)
class RobotPath:
    """
    The way of both grippers from where they begin, by quintic polynomials between knots.

    :param along: knots of the horizontal part, at right angles to the rag
    :param up: knots of the vertical part
    :param lead: until when the grippers close in and wait, before the first knot [s]
    """

    name: str
    along: tuple[Knot, ...]
    up: tuple[Knot, ...]
    lead: float

    @property
    def seconds(self) -> float:
        """Return how long it takes [s]."""
        return self.along[-1][0]

    def offset(self, time: float) -> np.ndarray:
        """Return how far the grippers are from the begin at ``time`` [s], (3,) [m]."""
        return np.array([0.0, _quintic(self.along, time), _quintic(self.up, time)])


# Back, forth, down and back.
FLING = RobotPath(
    'fling',
    along=(
        (0.0, 0.0, 0.0, 0.0), (1.1, -0.25, -0.7, 3.0), (2.6, 0.3, 0.0, -1.0),
        (3.9, 0.15, -0.3, -0.5), (4.4, -0.1, 0.0, 0.0)),
    up=(
        (0.0, 0.0, 0.0, 0.0), (1.1, 0.06, 0.0, 0.0), (2.6, 0.06, 0.0, 0.0),
        (3.9, -0.51051, 0.0, 0.02)),
    lead=0.6)

# Down, then slowly sideways while farther down. The authors call it quasi-static.
DRAG = RobotPath(
    'drag',
    along=((0.0, 0.0, 0.0, 0.0), (2.0, 0.0, 0.0, 0.0), (14.0, -0.6, 0.0, 0.0)),
    up=(
        (0.0, 0.0, 0.0, 0.0), (1.0, -0.05, 0.0, 0.0), (2.0, -0.05, 0.0, 0.0),
        (8.0, -0.31051, 0.0, 0.02)),
    lead=2.0)
PATHS = {path.name: path for path in (FLING, DRAG)}


def _quintic(knots: Sequence[Knot], time: float) -> float:
    """Return the place at ``time``: that of the ends before the first knot and after the last."""
    time = min(max(time, knots[0][0]), knots[-1][0])
    for (begin, *at_begin), (end, *at_end) in zip(knots, knots[1:]):
        if time <= end:
            break
    length = end - begin
    place, speed, bend = at_begin[0], length * at_begin[1], 0.5 * length**2 * at_begin[2]
    # What is missing at the end of place, speed and half the acceleration, in times of the piece.
    gap = at_end[0] - place - speed - bend
    lag = length * at_end[1] - speed - 2.0 * bend
    turn = 0.5 * length**2 * at_end[2] - bend
    share = (time - begin) / length
    return place + share * (speed + share * (bend + share * (
        10.0 * gap - 4.0 * lag + turn + share * (
            -15.0 * gap + 7.0 * lag - 2.0 * turn + share * (6.0 * gap - 3.0 * lag + turn)))))


def gripper_places(path: RobotPath, corners: np.ndarray, time: float) -> np.ndarray:
    """
    Return where both grippers are, (2, 3) [m].

    :param corners: where they hold the rag at rest, at time 0, (2, 3) [m]
    :param time: simulated [s], 0 when they begin to close in
    """
    closed = corners.copy()
    closed[:, 0] = corners[:, 0].mean() + np.array(GRIPPERS)
    share = min(max(time / CLOSE_SECONDS, 0.0), 1.0)
    return corners + share * (closed - corners) + path.offset(time - path.lead)


def timed_moves(path: RobotPath, corners: np.ndarray, rate: float) -> dict[str, list[Any]]:
    """
    Return the ``pin_moves`` of a scene in which the grippers get a new target ``rate`` times a s.

    :param corners: where they hold the rag at rest, (2, 3) [m]
    """
    moves: dict[str, list[Any]] = {'start': [], 'node': [], 'target': [], 'speed': []}
    for tick in range(round((path.lead + path.seconds) * rate)):
        begin, end = tick / rate, (tick + 1) / rate
        before, after = (gripper_places(path, corners, time) for time in (begin, end))
        for node, place, target in zip(('top_left', 'top_right'), before, after):
            length = float(np.linalg.norm(target - place))
            if length > 1e-9:
                moves['start'].append(round(begin, 6))
                moves['node'].append(node)
                moves['target'] += [round(float(part), 5) for part in target]
                moves['speed'].append(round(length * rate, 5))
    return moves


def main() -> None:
    """Print the pin_moves of config/fling.yaml."""
    corners = np.array([[-0.25, 0.0, 1.0], [0.25, 0.0, 1.0]])
    print('    pin_moves:')
    for name, values in timed_moves(FLING, corners, 10.0).items():
        print(f'      {name}: [')
        per_line = {'target': 6, 'node': 8}.get(name, 10)
        for first in range(0, len(values), per_line):
            print(' ' * 8 + ', '.join(map(str, values[first:first + per_line])) + ',')
        print('      ]')


if __name__ == '__main__':
    main()
