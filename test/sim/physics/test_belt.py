# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A belt round a drum slips at the ratio of tensions that Euler and Eytelwein found."""

import math

import numpy as np
import pytest

RADIUS, WRAP, ON_DRUM, FREE_NODES = 0.1, math.pi, 15, 4
TURN = WRAP / ON_DRUM  # at each node on the drum
LENGTH = 2.0 * RADIUS * math.sin(TURN / 2.0)
ROWS, WIDTH = ON_DRUM + 2 * FREE_NODES, 0.02
LOAD = 1.0  # [N] at the slack end
# A share of the default: the harder edges are, the more they amplify what friction is off by.
HARD = {'constraint.strain': 1e-4}
BELT = {
    'rows': ROWS, 'cols': 2, 'width': WIDTH, 'height': LENGTH * (ROWS - 1), 'areal_density': 1.0,
    'gravity': [0.0, 0.0, 0.0], 'dt': 0.001, 'stiffness.structural': 2e4, 'stiffness.shear': 1e3,
    'stiffness.bend': 0.0, 'damping.structural': 1.0, 'contact.thickness': 0.0,
    'pins': ['bottom_edge'], 'colliders.names': ['drum'], 'colliders.drum.shape': 'cylinder',
    'colliders.drum.size': [RADIUS, 0.2],
    'colliders.drum.orientation': [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]}


def laid_on_drum():
    """Return positions on the drum, (rows, 2, 3), and the directions of both free ends."""
    angles = [0.5 * (math.pi + WRAP - TURN) - TURN * number for number in range(ON_DRUM)]

    def at(angle):
        return np.array([math.cos(angle), 0.0, math.sin(angle)])

    slack = at(angles[0] + 0.5 * (TURN + math.pi))
    pulled = at(angles[-1] - 0.5 * (TURN + math.pi))
    on = [RADIUS * at(angle) for angle in angles]
    line = np.array([
        *(on[0] + LENGTH * number * slack for number in range(FREE_NODES, 0, -1)), *on,
        *(on[-1] + LENGTH * number * pulled for number in range(1, FREE_NODES + 1))])
    return line[:, None] + np.array([[0.0, -WIDTH / 2, 0.0], [0.0, WIDTH / 2, 0.0]]), slack, pulled


def pull_slowly(simulation, positions, slack, way):
    """Lay the belt, load its slack end, and begin to pull the other one along ``way`` [m]."""
    simulation.set_state(
        positions.astype(np.float32), np.zeros(positions.shape, dtype=np.float32))
    simulation.push(
        tuple(LOAD * slack), duration=100.0, region='sphere',
        center=tuple(positions[0].mean(axis=0)), radius=0.03)
    simulation.advance(0.05)
    for col in range(2):
        simulation.move_pin(len(positions) - 1, col, tuple(positions[-1, col] + way), 0.005)


@pytest.mark.parametrize('friction', [pytest.param(0.2, marks=pytest.mark.long), 0.4])
def test_ratio_of_tensions_at_the_onset_of_slip(simulate, within, any_mode, friction):
    """A cloth pulled over an edge or round a body would need another force."""
    simulation = simulate({
        **BELT, 'mode': any_mode, 'colliders.drum.friction': friction,
        **(HARD if any_mode == 'constraint' else {})})
    positions, slack, pulled = laid_on_drum()
    pull_slowly(simulation, positions, slack, 0.003 * pulled)
    simulation.advance(0.2)
    tensions = []
    for _ in range(25):
        simulation.step()
        tensions.append(abs(float((simulation.pin_forces().forces @ pulled).sum())))
    # A polygon turns by as much at each node.
    share = friction * math.tan(0.5 * TURN)
    exact = ((1.0 + share) / (1.0 - share))**ON_DRUM
    within('ratio of tensions over that of the formula, less 1',
           abs(np.mean(tensions) / LOAD / exact - 1.0), 0.01)


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
        **(HARD if any_mode == 'constraint' else {})})
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
