# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The default cloth and the scenes of measured fabrics stretch and shear as woven cloth does."""

from contextlib import closing
from pathlib import Path

from cloth_sim_ros.api.scene_file import load_scene
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

CONFIG = Path(__file__).resolve().parents[2] / 'config'
# Threads of 2000 N/m: thrice the weight of a square metre on two corner nodes would stretch the
# cloth next to them by 5 %, and pegs, tables and smaller cloths leave less to each node.
MOST_STRETCH = 0.03
# From a corner node the cloth hangs by lines of its border, which have half the stiffness.
MOST_AT_CORNERS = 2.0 * MOST_STRETCH
# Woven cloth shears by about 30 degrees before its yarns jam. In a square that shears by an angle
# g the diagonals change by sqrt(1 +- sin g) - 1.
MOST_LONGER, MOST_SHORTER = (
    abs(np.sqrt(1.0 + sign * np.sin(np.radians(30.0))) - 1.0) for sign in (1.0, -1.0))
FRAME = 0.02


def changes(positions, rest, down, across):
    """Return the relative change in length of the edges (down, across) nodes apart."""
    def length(places):
        rows, cols = places.shape[:2]
        first = places[:rows - down, max(0, -across):cols - max(0, across)]
        last = places[down:, max(0, across):cols - max(0, -across)]
        return np.linalg.norm(last - first, axis=-1)
    return length(positions) / length(rest) - 1.0


def extremes(scene, seconds):
    """Return the largest stretch of threads, and how much longer and shorter diagonals get."""
    found = []
    rest = scene.rest_positions()
    with closing(Simulation(scene)) as simulation:
        while simulation.time < seconds:
            simulation.advance(FRAME)
            places = simulation.positions().astype(float)
            threads = [changes(places, rest, *edge).max() for edge in ((0, 1), (1, 0))]
            diagonals = [changes(places, rest, *edge) for edge in ((1, 1), (1, -1))]
            found.append((max(threads), np.max(diagonals), -np.min(diagonals)))
    return np.max(found, axis=0)


@pytest.mark.parametrize(('name', 'seconds'), [
    ('default', 1.0), ('drape', 1.0), ('curtain', 0.8), ('towel', 1.0), ('tablecloth', 0.5)])
def test_threads_hardly_stretch_and_yarns_do_not_jam(name, seconds):
    """The cloth would look like rubber."""
    scene = Scene() if name == 'default' else load_scene(CONFIG / f'{name}.yaml')
    threads, longer, shorter = extremes(scene, seconds)
    print(f'{name}: threads up to {threads:.2%} longer, diagonals {longer:.1%} longer and '
          f'{shorter:.1%} shorter')
    assert threads < (MOST_AT_CORNERS if name == 'default' else MOST_STRETCH)
    assert longer < MOST_LONGER and shorter < MOST_SHORTER


@pytest.mark.parametrize(('name', 'seconds'), [('drape', 1.0), ('curtain', 2.4)])
def test_pegs_and_hooks_of_some_width_carry_it(name, seconds):
    """Diagonals at single nodes would change by several times as much."""
    assert max(extremes(load_scene(CONFIG / f'{name}.yaml'), seconds)) < 0.06
