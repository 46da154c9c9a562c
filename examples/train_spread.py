# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Learn to spread a folded towel, by random search over 64 plans at once. Needs no ROS.

    python examples/train_spread.py --out spread.png        takes half a minute
"""

from argparse import ArgumentParser

from cloth_sim_ros import Scene
from cloth_sim_ros.gym import CarryCloths
from cloth_sim_ros.gym import make_vec
import numpy as np
from PIL import Image

TOWEL = Scene({
    'rows': 9, 'cols': 9, 'width': 0.3, 'height': 0.3, 'start.z': 0.001, 'pins': ['none'],
    'stiffness.structural': 50.0, 'stiffness.shear': 10.0, 'stiffness.bend': 0.2,
    'areal_density': 0.3, 'colliders.names': ['table'], 'colliders.table.shape': 'plane',
    'colliders.table.friction': 0.5})
FLAT = TOWEL.rest_positions()
FOLDED = np.where([True, False, False], np.abs(FLAT), FLAT)


def spread(positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """Return minus the mean distance of the nodes from where they are in the flat towel [m]."""
    return -np.linalg.norm(positions - FLAT, axis=-1).mean(axis=(1, 2))


def play(towels: CarryCloths, plans: np.ndarray, seed: int) -> np.ndarray:
    """Return the last rewards of ``plans`` (64, 4, 3) of a hand, which the other one mirrors."""
    towels.reset(seed=seed)
    for number in range(20):
        action = np.tanh(plans[:, number // 5])
        rewards = towels.step(np.stack([action, action * (1.0, -1.0, 1.0)], axis=1))[1]
    return rewards


parser = ArgumentParser(description='Learn to spread a folded towel.')
parser.add_argument('--out', default='spread.png', help='picture of before and after')
out = parser.parse_args().out
towels = make_vec(
    64, TOWEL, start=FOLDED, hands=[[(0, 0)], [(8, 0)]], goal=None, reward=spread,
    render_mode='rgb_array', camera={
        'azimuth': -90.0, 'elevation': 50.0, 'zoom': 0.5, 'target': (0.0, 0.0, 0.0)})
random, mean, width = np.random.default_rng(1), np.zeros((4, 3)), 1.0
before, pictures = play(towels, np.zeros((64, 4, 3)), seed=1000).mean(), [towels.render()[0]]
for number in range(10):
    plans = mean + width * random.normal(size=(64, 4, 3))
    rewards = play(towels, plans, seed=64 * number)
    best = plans[np.argsort(rewards)[-8:]]
    mean, width = best.mean(axis=0), best.std(axis=0) + 0.05
    print(f'round {number + 1}: mean {rewards.mean():.3f}, best {rewards.max():.3f}')
after = play(towels, np.repeat(mean[None], 64, axis=0), seed=1000).mean()
Image.fromarray(np.hstack([*pictures, towels.render()[0]])).save(out)
print(f'nodes are off by {-1e3 * before:.0f} mm before, {-1e3 * after:.0f} mm after')
