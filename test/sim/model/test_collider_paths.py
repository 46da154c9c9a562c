# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the bodies of many cloths are at each time."""

import math

from cloth_sim_ros.sim.model.collider_paths import Change
from cloth_sim_ros.sim.model.collider_paths import paths_of_scene
from cloth_sim_ros.sim.model.collider_paths import StackedPaths
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

# Substeps of a step of dt [1].
SUBSTEPS = 4
DT = 0.01
LENGTH = DT / SUBSTEPS
BODIES = {
    'dt': DT, 'colliders.names': ['ball', 'stick'], 'colliders.ball.size': [0.1],
    'colliders.stick.shape': 'capsule', 'colliders.stick.size': [0.05, 0.4],
    'colliders.stick.position': [0.3, -0.1, 0.7],
    'colliders.stick.orientation': [0.1, 0.2, 0.3, 0.9]}


def random_move(random: np.random.Generator, name: str, now: float) -> FrameMove:
    """Return a move that takes some steps; every other one turns the body."""
    turns = random.random() < 0.5
    return FrameMove.checked(
        name=name, target=random.uniform(-0.1, 0.1, 3),
        orientation=random.normal(size=4) if turns else None,
        speed=random.uniform(0.5, 5.0), angular_speed=random.uniform(5.0, 50.0), start=now)


@pytest.mark.parametrize('timed', [{}, {
    'collider_moves.start': [0.0312, 0.05, 0.3], 'collider_moves.name': ['ball', 'stick', 'ball'],
    'collider_moves.target': [0.0, 0.1, 0.2] * 3}], ids=['moved', 'timed'])
def test_motions_have_the_bits_of_one_cloth_after_another(timed: dict):
    """A body would push a cloth of a batch by a little more than it does in a run of its own."""
    random = np.random.default_rng(5)
    scenes = [Scene({**BODIES, **timed}), Scene(BODIES), Scene({**BODIES, **timed})]
    firsts = np.zeros(3, dtype=int)
    stacked = StackedPaths(scenes, firsts, length=LENGTH, most=SUBSTEPS)
    alone = [paths_of_scene(scene) for scene in scenes]
    moved = 0
    for number in range(60):
        for cloth in np.flatnonzero(random.random(3) < 0.15).tolist():
            move = random_move(
                random, ('ball', 'stick')[number % 2], (number - firsts[cloth]) * DT)
            path = stacked.move(cloth, move)
            assert path.arrival == alone[cloth].add(move).arrival
        if number in (20, 41):
            stacked.begin(1, number)
            alone[1], firsts[1] = paths_of_scene(scenes[1]), number
        stacked.begin_step(number)
        made = 0
        while made < SUBSTEPS:
            moved += stacked.find(made, math.inf) is not Change.NOTHING
            for cloth, paths in enumerate(alone):
                begin = (number - firsts[cloth]) * DT + made * LENGTH
                expected = paths.motions(['ball', 'stick'], begin, begin + LENGTH)
                for found, one in zip((
                        stacked.centres, stacked.axes, stacked.velocities, stacked.turns),
                        expected):
                    np.testing.assert_array_equal(found[cloth].reshape(one.shape), one)
                assert [pose.position for pose in stacked.poses(cloth, begin)] == [
                    paths.pose(name, begin).position for name in ('ball', 'stick')]
            made += min(stacked.alike, SUBSTEPS - made)
    assert moved > 60


def test_bodies_at_rest_are_asked_once_a_step():
    """A batch in which no body moves would take as long as one in which all do."""
    stacked = StackedPaths(
        [Scene(BODIES)] * 2, np.zeros(2, dtype=int), length=LENGTH, most=SUBSTEPS)
    found = []
    for number in range(3):
        stacked.begin_step(number)
        found.append(stacked.find(0, math.inf))
        assert stacked.alike == SUBSTEPS
    assert found == [Change.ALL, Change.NOTHING, Change.NOTHING]
