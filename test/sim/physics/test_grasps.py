# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps hold nodes rigidly to their frames, and feel what the cloth pulls with, in every mode."""

import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.snapshot import FLAG_GRASPED
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
import numpy as np
import pytest

CLOTH = {
    'rows': 9, 'cols': 9, 'width': 0.4, 'height': 0.4, 'areal_density': 0.2, 'pins': ['none'],
    'start.pose': 'horizontal', 'start.z': 0.0, 'dt': 0.005, 'adaptive.threshold': 0.05}
CORNER, OTHER = (-0.2, 0.2, 0.0), (0.2, 0.2, 0.0)
# A quarter turn about x.
UPRIGHT = (math.sin(math.pi / 4.0), 0.0, 0.0, math.cos(math.pi / 4.0))


class Losses(InputListener):
    """Notes which grasps were lost by force."""

    def __init__(self):
        self.lost = []

    def accept(self, given, time):
        if isinstance(given, Release) and given.by_force:
            self.lost.append(given.name)


def test_held_nodes_follow_the_frame(simulate, within, any_mode):
    """A towel would slip in the gripper, or be torn where the gripper turns."""
    simulation = simulate({**CLOTH, 'mode': any_mode})
    grasp = simulation.grasp('left', CORNER, radius=0.11)
    rows, cols = grasp.nodes.T
    begin = simulation.positions()[rows, cols].astype(float) - CORNER
    assert len(grasp.nodes) == 6
    path = simulation.move_grasp('left', (-0.1, 0.1, 0.1), UPRIGHT, speed=1.0, angular_speed=3.0)
    simulation.advance(0.5 * path.arrival)
    half = math.pi / 4.0 * math.floor(0.5 * path.arrival / 0.005 + 1e-6) * 0.005 / (
        0.5 * path.arrival)
    turned = np.array([
        (1.0, 0.0, 0.0), (0.0, math.cos(half), -math.sin(half)),
        (0.0, math.sin(half), math.cos(half))])
    way = 0.1 * half / (math.pi / 2.0) * np.array([1.0, -1.0, 1.0])
    within('off the frame on the way [m]', np.abs(
        simulation.positions()[rows, cols] - (CORNER + way + begin @ turned.T)).max(), 1e-6)
    simulation.advance(path.arrival)
    standing = np.stack([begin[:, 0], -begin[:, 2], begin[:, 1]], axis=-1)
    within('off the frame at the end [m]', np.abs(
        simulation.positions()[rows, cols] - ((-0.1, 0.1, 0.1) + standing)).max(), 1e-6)
    np.testing.assert_allclose(simulation.grasps[0].pose.orientation, UPRIGHT)


def test_held_nodes_say_that_they_are(simulate):
    """A viewer would show a gripper as a peg, or one that was released."""
    simulation = simulate({**CLOTH, 'pins': ['bottom_left']})
    grasp = simulation.grasp('left', CORNER, radius=0.11)
    held = np.zeros((9, 9), dtype=bool)
    held[tuple(grasp.nodes.T)] = True
    flags = simulation.snapshot().flags
    np.testing.assert_array_equal(flags & FLAG_GRASPED != 0, held)
    assert np.all(flags[held] & FLAG_PINNED) and np.sum(flags & FLAG_PINNED != 0) == 7
    simulation.release_grasp('left')
    assert not np.any(simulation.snapshot().flags & FLAG_GRASPED)


def test_what_is_released_keeps_its_velocity(simulate, any_mode):
    """A towel that is thrown would drop from the hand."""
    simulation = simulate({**CLOTH, 'mode': any_mode, 'gravity': [0.0, 0.0, 0.0]})
    simulation.grasp('all', (0.0, 0.0, 0.0), radius=1.0)
    simulation.move_grasp('all', (5.0, 0.0, 0.0), speed=2.0)
    simulation.advance(0.05)
    begin = simulation.positions()
    simulation.release_grasp('all')
    simulation.advance(0.1)
    np.testing.assert_allclose(
        simulation.positions() - begin, np.broadcast_to([0.2, 0.0, 0.0], begin.shape), atol=1e-5)
    assert not simulation.pinned_nodes().any()


def test_its_force_is_that_of_its_nodes_as_pins(simulate, any_mode):
    """A controller would be fed another force, or a torque about another point."""
    simulation = simulate({**CLOTH, 'mode': any_mode})
    grasp = simulation.grasp('left', CORNER, radius=0.06)
    simulation.grasp('right', OTHER, count=2)
    pinned = simulate({**CLOTH, 'mode': any_mode, 'pins': [
        '0,0', '0,1', '1,0', '0,7', '0,8']})
    for each in (simulation, pinned):
        each.advance(0.5)
    np.testing.assert_array_equal(simulation.positions(), pinned.positions())
    pins = pinned.pin_forces()
    forces = {tuple(node): force for node, force in zip(pins.nodes.tolist(), pins.forces)}
    left, right = simulation.grasp_forces()
    np.testing.assert_allclose(
        left.force, sum(forces[tuple(node)] for node in grasp.nodes.tolist()), rtol=1e-9)
    np.testing.assert_allclose(
        left.force + right.force, sum(forces.values()), rtol=1e-9)
    arms = {node: pinned.positions()[node] - CORNER for node in forces}
    np.testing.assert_allclose(left.torque, sum(
        np.cross(arms[tuple(node)], forces[tuple(node)]) for node in grasp.nodes.tolist()),
        rtol=1e-6)


@pytest.mark.parametrize(('max_force', 'is_lost'), [(0.05, True), (100.0, False)])
def test_it_is_lost_where_the_cloth_pulls_too_hard(simulate, any_mode, max_force, is_lost):
    """A gripper that can't hold a cloth would hold it, or lose one that it can hold."""
    simulation = simulate({**CLOTH, 'mode': any_mode})
    simulation.listener = Losses()
    simulation.grasp('left', CORNER, radius=0.06, max_force=max_force)
    simulation.advance(0.5)
    assert simulation.listener.lost == ['left'] * is_lost
    assert len(simulation.grasps) == int(not is_lost)
    assert simulation.pinned_nodes().any() == (not is_lost)


def test_those_of_the_scene_are_made_at_their_times(simulate, any_mode):
    """A scene with a gripper would run otherwise than the same calls one after the other."""
    timed = simulate({
        **CLOTH, 'mode': any_mode, 'pins': ['bottom_edge'],
        'grasps.start': [0.0, 0.052], 'grasps.name': ['left', 'right'],
        'grasps.position': [*CORNER, 0.2, 0.2, -0.02], 'grasps.radius': [0.06, 0.0],
        'grasps.release': [0.15, 0.0], 'grasp_moves.start': [0.02], 'grasp_moves.name': ['left'],
        'grasp_moves.target': [-0.2, 0.1, 0.1], 'grasp_moves.orientation': [*UPRIGHT]})
    called = simulate({**CLOTH, 'mode': any_mode, 'pins': ['bottom_edge']})
    called.grasp('left', CORNER, radius=0.06)
    called.advance(0.02)
    called.move_grasp('left', (-0.2, 0.1, 0.1), UPRIGHT)
    called.advance(0.035)
    called.grasp('right', (0.2, 0.2, -0.02))
    called.advance(0.095)
    called.release_grasp('left')
    called.advance(0.05)
    timed.advance(0.2)
    assert [grasp.name for grasp in timed.grasps] == ['right']
    np.testing.assert_array_equal(timed.positions(), called.positions())
    timed.reset()
    assert [grasp.name for grasp in timed.grasps] == ['left']
    timed.advance(0.2)
    np.testing.assert_array_equal(timed.positions(), called.positions())


def test_a_reset_releases_all(simulate):
    """A cloth would hang on grippers of the run before."""
    simulation = simulate(CLOTH)
    simulation.grasp('left', CORNER)
    simulation.advance(0.1)
    simulation.reset()
    assert not simulation.grasps
    assert not simulation.pinned_nodes().any()


@pytest.mark.parametrize(('request_', 'rule'), [
    ({'position': (0.0, 0.0, 9.0)}, 'has no free node within 0.1 m: the nearest is 9 m'),
    ({'position': (0.0, math.nan, 0.0)}, 'must be 3 finite numbers'),
    ({'radius': -1.0}, 'the radius of grasp right must be from 0'),
    ({'max_force': math.nan}, 'the max_force of grasp right must be'),
    ({'count': -1}, 'must be 0 or more'),
    ({'count': 2, 'radius': 0.1}, 'a radius and a count'),
    ({'orientation': (0.0, 0.0, 0.0, 0.0)}, 'has no direction'),
    ({'nodes': [(99, 0)]}, 'row'),
    ({'nodes': [(0, 0)]}, 'which is pinned'),
    ({'nodes': []}, 'has no node'),
    ({'name': 'left'}, 'holds 1 nodes'),
    ({'name': '/x'}, 'is no name of a grasp')])
def test_bad_requests_change_nothing(simulate, request_, rule):
    """A gripper would hold what nobody asked for."""
    simulation = simulate(CLOTH)
    simulation.grasp('left', CORNER)
    with pytest.raises(ClothSimError, match=rule):
        simulation.grasp(**{'name': 'right', 'position': OTHER, **request_})
    for do in (lambda: simulation.move_grasp('right', OTHER),
               lambda: simulation.release_grasp('right')):
        with pytest.raises(ClothSimError, match="there is no grasp 'right'"):
            do()
    for do in (simulation.pin, simulation.release):
        with pytest.raises(ClothSimError, match='move or release the grasp'):
            do(0, 0)
    assert simulation.pinned_nodes().sum() == 1
    assert [grasp.name for grasp in simulation.grasps] == ['left']
