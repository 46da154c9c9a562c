# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Runs with grasps and moved colliders, made again from their recording alone."""

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros import SimulationRecorder
from cloth_sim_ros.analysis.recording import Recording
from cloth_under_test import HANDLED
from made_again import assert_same
from made_again import made_again
import numpy as np
import pytest

# Scene with one grasp from the start, one later, each with a move, and a move of the ball.
TIMED = {
    **HANDLED, 'grasps.start': [0.0, 0.1], 'grasps.name': ['hand', 'other'],
    'grasps.position': [-0.45, -0.35, 1.0, 0.45, -0.35, 1.0], 'grasps.radius': [0.12, 0.2],
    'grasps.release': [0.0, 0.5], 'grasp_moves.start': [0.05, 0.2],
    'grasp_moves.name': ['hand', 'other'],
    'grasp_moves.target': [-0.4, -0.3, 1.1, 0.4, -0.3, 1.1],
    'grasp_moves.orientation': [0.3, 0.1, 0.0, 0.9, 0.0, 0.0, 0.4, 0.9],
    'collider_moves.start': [0.1], 'collider_moves.name': ['ball'],
    'collider_moves.target': [0.1, 0.0, 0.95]}
ODD_TURN = (0.123, -0.456, 0.789, 0.321)


def act(simulation):
    """Do one of each thing, with rotations that are not of length 1, and advance."""
    simulation.grasp('third', (0.0, 0.35, 1.0), ODD_TURN, count=3)
    simulation.move_collider('ball', (0.0, 0.1, 0.9), ODD_TURN, 0.37, 2.1)
    simulation.step(7)
    simulation.move_grasp('third', (0.03, 0.3, 1.1), (0.3, 0.2, 0.1, 0.7), 0.33)
    simulation.move_collider('floor', (0.0, 0.0, 0.3), duration=0.4)
    simulation.step(9)
    simulation.move_grasp('third', (0.0, 0.3, 1.0), duration=0.09)
    simulation.step(5)
    simulation.release_grasp('third')


@pytest.mark.parametrize('mode', [
    'mass_spring', 'constraint', pytest.param('adaptive', marks=pytest.mark.long)])
def test_they_have_the_same_bits(tmp_path, mode):
    """A move of a grasp or collider would lack, or come with other bits of its rotation."""
    with Simulation(Scene({**TIMED, 'mode': mode})) as simulation:
        with SimulationRecorder(simulation, tmp_path) as recorder:
            recorder.advance(0.06)
            act(simulation)
            recorder.advance(0.1)
            simulation.reset()
            recorder.advance(0.06)
            act(simulation)
            recorder.advance(0.5)
    assert_same(recorder.path)


def test_what_was_done_before_the_first_step_is_done_again(tmp_path):
    """A scene's grasp that was released or replaced at once would be there again."""
    with Simulation(Scene({**TIMED, 'collider_moves.start': [0.0]})) as simulation:
        simulation.release_grasp('hand')
        simulation.pin(7, 0)
        simulation.grasp('hand', (0.0, -0.35, 1.0), radius=0.12)
        simulation.grasp('left', (-0.45, 0.0, 1.0), ODD_TURN, max_force=50.0)
        simulation.move_grasp('left', (-0.4, 0.0, 1.0), speed=0.2)
        simulation.move_collider('ball', (0.0, 0.0, 0.8), speed=0.2)
        with SimulationRecorder(simulation, tmp_path) as recorder:
            recorder.advance(0.4)
    assert_same(recorder.path)


def test_a_lost_grasp_is_lost_again(tmp_path):
    """A release by force would be made twice, or one of what is lost already be an error."""
    with Simulation(Scene(HANDLED)) as simulation:
        with SimulationRecorder(simulation, tmp_path) as recorder:
            simulation.grasp('hand', (-0.45, -0.35, 1.0), radius=0.12, max_force=0.2)
            simulation.move_grasp('hand', (-0.9, -0.8, 1.2))
            recorder.advance(0.5)
            assert not simulation.grasps
            simulation.grasp('hand', (0.45, -0.35, 1.0), nodes=[(7, 9)])
            recorder.advance(0.1)
    assert_same(recorder.path)
    told = [entry.message for entry in Recording(recorder.path).entries('inputs/grasp')]
    assert [(message.grasped, message.by_force) for message in told] == [
        (True, False), (False, True), (True, False)]


def test_a_recording_that_begins_late_has_grasps_and_places(tmp_path):
    """Only runs recorded from their start could be held to their bits."""
    with Simulation(Scene(HANDLED)) as simulation:
        simulation.grasp('hand', (-0.45, -0.35, 1.0), ODD_TURN, radius=0.12)
        simulation.move_grasp('hand', (-0.4, -0.3, 1.05), (0.1, 0.0, 0.0, 1.0))
        simulation.move_collider('ball', (0.1, 0.0, 0.9), ODD_TURN)
        simulation.advance(3.0)
        with SimulationRecorder(simulation, tmp_path) as recorder:
            recorder.advance(0.3)
            simulation.move_grasp('hand', (-0.4, -0.3, 1.1), (0.2, 0.0, 0.3, 1.0))
            simulation.move_collider('ball', (0.0, 0.0, 0.9))
            recorder.advance(0.3)
            simulation.release_grasp('hand')
            recorder.advance(0.1)
    assert_same(recorder.path)


def test_collider_move_under_way_has_the_same_bits(tmp_path):
    """A recording would forget where a scene's own collider set off."""
    with Simulation(Scene({**TIMED, 'grasps.start': [], 'grasps.name': [], 'grasps.position': [],
                           'grasps.radius': [], 'grasps.release': [], 'grasp_moves.start': [],
                           'grasp_moves.name': [], 'grasp_moves.target': [],
                           'grasp_moves.orientation': []})) as simulation:
        simulation.advance(0.15)
        with SimulationRecorder(simulation, tmp_path) as recorder:
            recorder.advance(0.3)
    assert not list(Recording(recorder.path).entries('inputs/collider_target'))
    assert_same(recorder.path)


def test_a_recording_that_begins_late_says_what_it_lacks(tmp_path):
    """Bits would be promised that depend on where a move began."""
    with Simulation(Scene(HANDLED)) as simulation:
        simulation.grasp('hand', (-0.45, -0.35, 1.0), radius=0.12)
        simulation.move_grasp('hand', (-0.3, -0.2, 1.2), ODD_TURN, 0.1)
        simulation.move_collider('ball', (0.1, 0.0, 0.95), ODD_TURN, 0.03)
        simulation.step(33)
        with SimulationRecorder(simulation, tmp_path) as recorder:
            recorder.advance(0.5)
            poses = [grasp.pose for grasp in simulation.grasps]
            poses += [collider.pose for collider in simulation.colliders]
    with made_again(recorder.path) as rerun:
        assert rerun.unknown == (
            'where the moving grasps started', 'where the moving colliders started')
        assert rerun.refused == []
        again = [grasp.pose for grasp in rerun.simulation.grasps]
        again += [collider.pose for collider in rerun.simulation.colliders]
        for pose, expected in zip(again, poses):
            np.testing.assert_allclose(pose.position, expected.position, atol=1e-12)
            np.testing.assert_allclose(pose.orientation, expected.orientation, atol=1e-12)
        assert rerun.check.largest is None or rerun.check.largest.distance < 1e-3
