# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The drape test of Cusick on measured fabrics: drape coefficients beside published ones.

A disc of 30 cm lies on a plate of 18 cm, config/cusick.yaml. The drape coefficient is the area of
its shadow beyond the plate, over that of the flat disc (ISO 9073-9). Nothing is fitted: weight,
stretch and bending are those that were measured.

For example:
  python benchmarks/drape_test.py
  python benchmarks/drape_test.py --nodes 97 --fabrics denim
"""

from argparse import ArgumentParser
from pathlib import Path
import sys
from time import process_time

from cloth_sim_ros import load_scene
from cloth_sim_ros import Simulation
from cloth_sim_ros import Snapshot
import numpy as np
from PIL import Image
from PIL import ImageDraw

SCENE = Path(__file__).parents[1] / 'config' / 'cusick.yaml'
# The linear part of the first fabric of the data set of Feng et al. 2022,
# DOI 10.1145/3550454.3555464, which has the weight of silk; its fibre is not given.
_LIGHT = {
    'material.preset': 'none', 'areal_density': 0.0673, 'bending.rigidity': (1.78e-6, 3.08e-6),
    # Not measured there: hardly any stretch, and shear as that of the tablecloth.
    'material.warp': 2000.0, 'material.weft': 2000.0, 'material.shear': 5.0}
# What is simulated, and the drape coefficients [%] that are published for fabrics of its kind.
FABRICS = {
    'light': (_LIGHT, 'silk, 20 to 40'),
    't_shirt': ({'material.preset': 't_shirt'}, 'cotton, 60 to 76'),
    'trousers': ({'material.preset': 'trousers'}, 'cotton, 60 to 76'),
    'denim': ({'material.preset': 'denim'}, 'denim, 70 to 90'),
}
_PLATE = 0.09           # radius [m]
_PIXEL = 1e-4           # [m]
_LOOK = 0.25            # simulated time between two looks [s]
# Change of the drape coefficient between two looks [1], below which the cloth is at rest.
_STILL = 5e-4


def shadow(snapshot: Snapshot) -> np.ndarray:
    """Return the shadow of a lamp far above, (pixels, pixels) bool."""
    mesh = snapshot.mesh()
    reach = 0.17
    side = round(2.0 * reach / _PIXEL)
    image = Image.new('1', (side, side))
    draw = ImageDraw.Draw(image)
    flat = (mesh.vertices[:, :2].astype(float) + reach) / _PIXEL
    for corners in flat[mesh.triangles]:
        draw.polygon([tuple(corner) for corner in corners.tolist()], fill=1)
    return np.asarray(image)


def drape_coefficient(covered: np.ndarray, flat: np.ndarray) -> float:
    """Return how much of the flat cloth beyond the plate is in the shadow."""
    plate = np.pi * _PLATE**2 / _PIXEL**2
    return float((covered.sum() - plate) / (flat.sum() - plate))


def drape(nodes: int, seconds: float, **changes: object) -> tuple[float, float]:
    """Return the drape coefficient, and the simulated time at rest [s]."""
    scene = load_scene(SCENE, {'rows': nodes, 'cols': nodes, **changes})
    with Simulation(scene) as simulation:
        flat = shadow(simulation.snapshot())
        before = found = 1.0
        while simulation.time < seconds:
            simulation.advance(_LOOK)
            before = found
            found = drape_coefficient(shadow(simulation.snapshot()), flat)
            if simulation.time > 1.0 and abs(found - before) < _STILL:
                break
        return found, simulation.time


def main() -> None:
    """Print the table."""
    parser = ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('--nodes', type=int, nargs='+', default=[49], help='a side')
    parser.add_argument('--fabrics', nargs='+', default=list(FABRICS), choices=list(FABRICS))
    parser.add_argument('--mode', default='mass_spring')
    parser.add_argument('--seconds', type=float, default=10.0, help='at most, simulated')
    args = parser.parse_args()
    for name in args.fabrics:
        changes, published = FABRICS[name]
        told = []
        for nodes in args.nodes:
            begin = process_time()
            found, time = drape(nodes, args.seconds, mode=args.mode, **changes)
            told.append(f'{100.0 * found:.1f}')
            print(f'{name} {nodes}: {100.0 * found:.1f} % at {time:g} s, '
                  f'{process_time() - begin:.0f} s of a processor', file=sys.stderr)
        print(f'| {name} | {" | ".join(told)} | {published} |', flush=True)


if __name__ == '__main__':
    main()
