# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Compare two stiffnesses of one cloth in a plot. Needs no ROS.

    python examples/compare_stiffness.py 100 1000 --out stiffness.png
"""

from argparse import ArgumentParser

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from matplotlib.figure import Figure
import numpy as np

FRAME = 0.02  # [s]


def run(stiffness: float, seconds: float) -> np.ndarray:
    """Return time [s], height of the lower edge [m] and largest strain [%] of each frame."""
    scene = Scene({
        'rows': 24, 'cols': 24, 'stiffness.structural': stiffness,
        'stiffness.shear': 0.2 * stiffness})
    rows = []
    with Simulation(scene) as cloth:
        while cloth.time < seconds:
            cloth.advance(FRAME)
            height = cloth.positions()[-1, :, 2].mean()
            rows.append((cloth.time, height, 100.0 * cloth.measure().max_strain))
    return np.array(rows)


def main() -> None:
    """Drop the cloth twice, and draw both runs into two panels."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('stiffnesses', nargs='+', type=float, help='of structural springs [N/m]')
    parser.add_argument('--seconds', type=float, default=2.0, help='simulated time')
    parser.add_argument('--out', default='stiffness.png', help='the plot')
    args = parser.parse_args()

    figure = Figure(figsize=(8.0, 6.0), layout='constrained')
    panels = figure.subplots(2, 1, sharex=True)
    for stiffness in args.stiffnesses:
        time, height, strain = run(stiffness, args.seconds).T
        for panel, values in zip(panels, (height, strain)):
            panel.plot(time, values, label=f'{stiffness:g} N/m')
        print(f'{stiffness:g} N/m: largest strain {strain.max():.2f} %')
    for panel, label in zip(panels, ('height of the lower edge [m]', 'largest strain [%]')):
        panel.set_ylabel(label)
        panel.grid(alpha=0.3)
    panels[0].legend()
    panels[1].set_xlabel('simulated time [s]')
    figure.savefig(args.out, dpi=110)
    print(f'written to {args.out}')


if __name__ == '__main__':
    main()
