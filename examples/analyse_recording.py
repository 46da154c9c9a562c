# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Read a recording into NumPy, and into a table of pandas where that is installed. Needs no ROS.

    python examples/analyse_recording.py bags/example
    python examples/analyse_recording.py bags/example --csv example.csv
"""

from argparse import ArgumentParser

from cloth_sim_ros import Recording
import numpy as np

COLUMNS = ('time', 'max_strain', 'kinetic_energy', 'total_energy')


def main() -> None:
    """Print how the cloth moved, what it weighed on its pins, and its figures over time."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('recording', help='folder or file, of this project or of ros2 bag')
    parser.add_argument('--csv', help='write the figures of all frames to this file')
    args = parser.parse_args()

    recording = Recording(args.recording)
    points = recording.arrays('points')
    positions = points['positions']  # (frames, rows, cols, 3)
    moved = np.linalg.norm(positions - positions[0], axis=-1)
    row, col = np.unravel_index(moved[-1].argmax(), moved[-1].shape)
    print(f'{len(positions)} frames of {positions.shape[1]} x {positions.shape[2]} nodes; node '
          f'({row}, {col}) has moved farthest, {moved[-1].max():.3f} m')

    if 'pins/wrenches' in recording.keys():
        forces = recording.arrays('pins/wrenches')
        last = forces['time'] == forces['time'][-1]
        total = [forces[f'wrench.force.{axis}'][last].sum() for axis in 'xyz']
        print(f'force of the cloth on all pins at the end: {np.array(total)} N')

    stats = {name: recording.arrays('stats')[name] for name in COLUMNS}
    table = np.column_stack(list(stats.values()))
    if args.csv:
        np.savetxt(args.csv, table, delimiter=',', header=','.join(COLUMNS), comments='')
    try:
        import pandas
    except ImportError:
        print('largest of each column:', dict(zip(COLUMNS, table.max(axis=0))))
    else:
        print(pandas.DataFrame(stats).set_index('time').describe())


if __name__ == '__main__':
    main()
