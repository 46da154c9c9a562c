# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A belt round a drum slips at the ratio of tensions that Euler and Eytelwein found."""

import math

from cloth_sim_ros.validation.belt import BELT
from cloth_sim_ros.validation.belt import FREE_NODES
from cloth_sim_ros.validation.belt import HARD
from cloth_sim_ros.validation.belt import LENGTH
from cloth_sim_ros.validation.belt import LOAD
from cloth_sim_ros.validation.belt import pull_slowly
from cloth_sim_ros.validation.belt import ratio_of_tensions
from cloth_sim_ros.validation.belt import WIDTH
import numpy as np
import pytest


@pytest.mark.parametrize('friction', [pytest.param(0.2, marks=pytest.mark.long), 0.4])
def test_ratio_of_tensions_at_the_onset_of_slip(context, within, any_mode, friction):
    """A cloth pulled over an edge or round a body would need another force."""
    found = ratio_of_tensions(context, any_mode, friction)
    within('ratio of tensions over that of the formula, less 1',
           abs(found.value / found.most - 1.0), 0.01)


# A belt over a rod that is thinner than its cells, under the middle of an edge.
STEEP = math.pi / 4.0  # of both free ends, below the horizon
ROD = 0.1 * LENGTH
OVER_ROD = {
    **{name: value for name, value in BELT.items() if not name.startswith('colliders.')},
    'rows': 2 * FREE_NODES + 2, 'height': LENGTH * (2 * FREE_NODES + 1),
    'colliders.names': ['rod'], 'colliders.rod.shape': 'capsule', 'colliders.rod.size': [ROD, 0.2],
    'colliders.rod.orientation': [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]}


def laid_on_rod():
    """Return positions over the rod, (rows, 2, 3), and the directions of both free ends."""
    slack, pulled = (
        np.array([side * math.cos(STEEP), 0.0, -math.sin(STEEP)]) for side in (-1.0, 1.0))
    line = np.array([
        np.array([side * LENGTH / 2.0, 0.0, ROD]) + LENGTH * number * along
        for side, along, numbers in (
            (-1.0, slack, range(FREE_NODES, -1, -1)), (1.0, pulled, range(FREE_NODES + 1)))
        for number in numbers])
    return line[:, None] + np.array([[0.0, -WIDTH / 2, 0.0], [0.0, WIDTH / 2, 0.0]]), slack, pulled


def lever_of(line, pull):
    """
    Return what is true of an edge at rest on a point, with a force at each of its ends.

    :param line: of nodes of the belt, (rows, 3) [m]
    :param pull: force at the end that is pulled [N]
    :return: moment of that force about the point over that of the load, and force of the point
        along the edge over that across it
    """
    slack, pulled = line[FREE_NODES], line[FREE_NODES + 1]
    edge = (pulled - slack) / np.linalg.norm(pulled - slack)
    normal = np.array([-edge[2], 0.0, edge[0]])
    forces = [
        force * (beyond - end) / np.linalg.norm(beyond - end) for force, beyond, end in (
            (LOAD, line[FREE_NODES - 1], slack), (pull, line[FREE_NODES + 2], pulled))]
    # The point below the axis of the rod, which is the origin.
    moments = [abs(end @ edge * (force @ normal)) for force, end in zip(forces, (slack, pulled))]
    total = forces[0] + forces[1]
    return moments[1] / moments[0], total @ edge / -(total @ normal)


@pytest.mark.parametrize('friction', [0.3, pytest.param(0.6, marks=pytest.mark.long)])
def test_edge_over_a_thin_rod_slips_as_a_seesaw(simulate, within, any_mode, friction):
    """A cloth over a clothes line would slip too early, or hang on by its edges."""
    simulation = simulate({
        **OVER_ROD, 'mode': any_mode, 'colliders.rod.friction': friction,
        **HARD[any_mode]})
    assert simulation.scene.thin_colliders
    positions, slack, pulled = laid_on_rod()
    pull_slowly(simulation, positions, slack, 0.005 * pulled)
    # It slips by then.
    simulation.advance(0.8 * friction)
    found = []
    for _ in range(150):
        simulation.step()
        pull = np.linalg.norm(simulation.pin_forces().forces.sum(axis=0))
        found.append(lever_of(simulation.positions().astype(float).mean(axis=1), pull))
    moments, resistance = np.mean(found, axis=0)
    within('moments about the rod over each other, less 1', abs(moments - 1.0), 0.02)
    within('friction over normal force, over the coefficient, less 1',
           abs(resistance / friction - 1.0), 0.02)
