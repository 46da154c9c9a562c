# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Time of a substep in which layers of the cloth may touch, over that of the same without."""

import argparse
from time import process_time
from typing import Any

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
import numpy as np

SIDE = 0.6
_TIMED = 0.1  # [s] simulated, in each mode


def scene_of(nodes: int, *, enabled: bool, **values: Any) -> Scene:
    """Return a towel on a floor."""
    cell = SIDE / (nodes - 1)
    return Scene({
        'rows': nodes, 'cols': nodes, 'width': SIDE, 'height': SIDE, 'pins': ['none'],
        'areal_density': 0.2, 'dt': 0.001, 'start.z': 0.0, 'stiffness.structural': 500.0,
        'stiffness.shear': 150.0, 'bending.rigidity': [2e-6, 2e-6],
        'contact.thickness': cell / 4.0, 'colliders.names': ['floor'],
        'colliders.floor.shape': 'plane',
        'colliders.floor.friction': 0.5, 'self_contact.enabled': enabled,
        'self_contact.thickness': cell / 4.0, **values})


def folded(nodes: int) -> np.ndarray:
    """Return a towel that is folded in half, on the floor, (nodes, nodes, 3) [m]."""
    cell = SIDE / (nodes - 1)
    row, col = np.indices((nodes, nodes))
    along = row * cell - SIDE / 2.0
    radius = cell / 2.0
    arc = np.pi * radius / 2.0
    x = np.where(np.abs(along) < arc, radius * np.cos(along / radius), arc - np.abs(along))
    z = np.where(
        np.abs(along) < arc, radius * np.sin(along / radius), np.sign(along) * radius)
    rough = 1e-4 * cell * np.random.default_rng(1).standard_normal((nodes, nodes, 3))
    found = np.stack([x, col * cell, z], axis=-1) + rough
    found[..., 2] += cell / 8.0 - found[..., 2].min()
    return found


def time_modes(nodes: int, settle: float) -> None:
    """Print what a simulated second of a folded towel takes in each mode."""
    for mode, dt in (('mass_spring', 0.001), ('adaptive', 0.001), ('constraint', 0.005)):
        with Simulation(scene_of(nodes, enabled=True, mode=mode, dt=dt)) as cloth:
            positions = folded(nodes)
            cloth.set_state(positions, np.zeros_like(positions))
            cloth.advance(settle)
            begin = process_time()
            cloth.advance(_TIMED)
            taken = (process_time() - begin) / _TIMED
            print(f'{nodes} x {nodes}, {mode}, steps of {1e3 * dt:g} ms: {taken:.1f} s of a '
                  f'processor; {cloth.snapshot().self_contacts} contacts', flush=True)


def main() -> None:
    """Print the times of both, flat and folded, in turns."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, nargs='+', default=[64])
    parser.add_argument('--settle', type=float, default=0.3, help='time before the first [s]')
    parser.add_argument('--steps', type=int, default=60, help='steps of dt timed of each')
    parser.add_argument('--modes', action='store_true', help='time each mode instead')
    given = parser.parse_args()
    for nodes in given.nodes:
        if given.modes:
            time_modes(nodes, given.settle)
            continue
        for name in ('flat', 'folded'):
            runs = []
            for enabled in (False, True):
                cloth = Simulation(scene_of(nodes, enabled=enabled))
                if name == 'folded':
                    positions = folded(nodes)
                    cloth.set_state(positions, np.zeros_like(positions))
                cloth.advance(given.settle)
                runs.append(cloth)
            times = [0.0, 0.0]
            # In turns: lists are made in some steps only, and a busy machine is slow for a while.
            for _ in range(given.steps):
                for number, cloth in enumerate(runs):
                    begin = process_time()
                    cloth.step(1)
                    times[number] += process_time() - begin
            alone, touching = (
                1e3 * taken / (given.steps * cloth.substeps)
                for taken, cloth in zip(times, runs))
            print(
                f'{nodes} x {nodes}, {name}: {alone:.3f} ms a substep, {touching:.3f} ms with '
                f'layers, {touching / alone:.2f}; {runs[1].snapshot().self_contacts} contacts')
            for cloth in runs:
                cloth.close()


if __name__ == '__main__':
    main()
