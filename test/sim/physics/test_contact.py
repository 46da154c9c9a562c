# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Contact with colliders obeys Coulomb's law, exactly where nodes stick, in every mode."""

import math

from body_distance import distance_to
from cloth_sim_ros.sim.snapshot import FLAG_TOUCHING
from cloth_sim_ros.validation.slope import FLOOR
from cloth_sim_ros.validation.slope import GRAVITY
from cloth_sim_ros.validation.slope import inclined
from cloth_sim_ros.validation.slope import LYING
from cloth_sim_ros.validation.slope import Slope
import numpy as np
import pytest

ANGLE = 0.4


def tilted(angle):
    """Return a plane that goes down along x, and a cloth that lies on it."""
    return {'colliders.floor.orientation': [
        0.0, math.sin(angle / 2.0), 0.0, math.cos(angle / 2.0)]}


def lay_on_tilted(simulation, angle):
    """Lay the flat cloth of a scene upon the plane that is tilted, at rest."""
    rest = simulation.scene.rest_positions()
    laid = rest.copy()
    laid[..., 0], laid[..., 2] = (
        math.cos(angle) * rest[..., 0], -math.sin(angle) * rest[..., 0])
    simulation.set_state(laid.astype(np.float32), np.zeros(laid.shape, dtype=np.float32))


# Between the least and the most friction there is no other way through the shaders.
FRICTIONS = [0.1, pytest.param(0.4, marks=pytest.mark.long), 1.0]


@pytest.mark.parametrize('friction', FRICTIONS)
def test_slip_angle(simulate, within, any_mode, friction):
    """A cloth would slide on a slope that holds it, or stick on one that does not."""
    slope = Slope(simulate, any_mode, friction)
    # What lengths are rounded by moves nodes that are so near to sliding by a few bits.
    within('way below the slip angle [m]', np.abs(slope.way(1.0 - 1e-3)).max(), 1e-6)
    assert slope.way(1.0 + slope.allowed).min() > 0.9 * slope.gained


@pytest.mark.parametrize(('dt', 'nodes', 'side'), [(0.005, 8, 0.5), (0.01, 20, 1.0)])
def test_slip_angle_in_large_steps(simulate, dt, nodes, side):
    """Hard edges would pull by what lengths are rounded by, or a solve begin far from its end."""
    slope = Slope(
        simulate, 'constraint', 0.1, dt=dt, rows=nodes, cols=nodes, width=side, height=side)
    assert not slope.way(1.0 - 1e-3).any()
    assert slope.way(1.0 + slope.allowed).min() > 0.9 * slope.gained


@pytest.mark.long
@pytest.mark.parametrize('friction', [0.1, 0.4, 1.0])
def test_the_slope_that_just_holds(simulate, within, any_mode, friction):
    """The same, bisected for the figure in the docs: a table of friction would be off by more."""
    slope = Slope(simulate, any_mode, friction)
    sticking, sliding = slope.bracket()
    print(f'measured mu / mu set: {sticking:.5f} to {sliding:.5f}, mu {friction}, {any_mode}')
    within('mu measured over mu set, less 1', abs(sticking - 1.0), slope.allowed)


@pytest.mark.parametrize('friction', FRICTIONS)
def test_slip_angle_of_springs_to_a_ten_thousandth(simulate, within, friction):
    """Friction would be a little more or less than it says, which rounding does not excuse."""
    ways = {}
    for share in (-1e-4, 1e-4):
        angle = math.atan((1.0 + share) * friction)
        simulation = simulate({
            **LYING, **FLOOR, 'mode': 'mass_spring', 'gravity': inclined(angle),
            'colliders.floor.friction': friction})
        begin = simulation.positions()
        simulation.advance(1.0)
        ways[share] = (simulation.positions() - begin)[..., 0]
    slid = 0.5 * GRAVITY * (math.sin(angle) - friction * math.cos(angle))
    within('way just below the slip angle, over that just above', ways[-1e-4].max() / slid, 0.3)
    assert ways[1e-4].min() > 0.9 * slid


@pytest.mark.parametrize(('seconds', 'allowed'), [
    (1.0, 1e-6), pytest.param(60.0, 1e-5, marks=pytest.mark.long)])
def test_what_sticks_does_not_creep_on_a_tilted_plane(
        simulate, within, any_mode, seconds, allowed):
    """A cloth in a gripper would creep out of it."""
    friction = math.tan(ANGLE) / 0.99
    simulation = simulate({
        **LYING, **FLOOR, **tilted(ANGLE), 'mode': any_mode, 'colliders.floor.friction': friction})
    lay_on_tilted(simulation, ANGLE)
    simulation.advance(0.1)
    begin = simulation.positions()
    simulation.advance(seconds)
    within(f'way in {seconds:g} s at 0.99 of the limit [m]',
           np.abs(simulation.positions() - begin).max(), allowed)


@pytest.mark.parametrize('friction', [0.2, 0.7])
def test_stopping_distance(simulate, within, any_mode, friction):
    """Sliding friction would be another force than mu times the normal one."""
    speed = 2.0
    simulation = simulate({
        **LYING, **FLOOR, 'mode': any_mode, 'colliders.floor.friction': friction})
    begin = simulation.scene.rest_positions()
    velocities = np.zeros_like(begin)
    velocities[..., 1] = speed
    simulation.set_state(begin.astype(np.float32), velocities.astype(np.float32))
    simulation.advance(1.1 * speed / (friction * GRAVITY))
    way = simulation.positions()[..., 1] - begin[..., 1]
    substep = simulation.dt / simulation.substeps
    exact = speed**2 / (2.0 * friction * GRAVITY) - 0.5 * substep * speed
    within('stopping distance, relative', np.abs(way / exact - 1.0).max(), 1e-3)
    assert not simulation.velocities().any()


def test_slide_above_the_limit(simulate, within, any_mode):
    """A cloth would slide down a slope with another acceleration."""
    friction = 0.2
    simulation = simulate({
        **LYING, **FLOOR, 'mode': any_mode, 'gravity': inclined(ANGLE),
        'colliders.floor.friction': friction})
    simulation.advance(0.5)
    exact = GRAVITY * (math.sin(ANGLE) - friction * math.cos(ANGLE))
    speed = simulation.velocities()[..., 0] / 0.5
    within('acceleration, relative', np.abs(speed / exact - 1.0).max(), 1e-3)


def test_half_the_thickness_lies_between_a_surface_and_the_nodes(simulate, within, any_mode):
    """A cloth would lie on a table as if it were twice as thick, or of no thickness at all."""
    simulation = simulate({
        **LYING, **FLOOR, 'mode': any_mode, 'contact.thickness': 0.01, 'start.z': 0.01})
    simulation.advance(0.2)
    heights = simulation.positions()[..., 2]
    within('height above the floor, less 5 mm [m]', np.abs(heights - 0.005).max(), 1e-5)


def test_a_cloth_inside_a_body_comes_out_slowly(simulate, within, any_mode):
    """A cloth that is put inside a body would be thrown out of it, and torn where a part is."""
    simulation = simulate({
        **LYING, **FLOOR, 'mode': any_mode, 'gravity': [0.0, 0.0, 0.0], 'start.z': -0.05})
    simulation.advance(0.02)
    assert not simulation.snapshot().surface_contact_held
    way = 0.02 * math.sqrt(LYING['height'])
    within('depth after 0.02 s, less that at the speed of moving out [m]',
           np.abs(simulation.positions()[..., 2] + 0.05 - way).max(), 1e-5)
    simulation.advance(0.1)
    within('depth in the end [m]', np.abs(simulation.positions()[..., 2]).max(), 1e-6)
    within('speed in the end [m/s]', np.abs(simulation.velocities()).max(), 1e-4)
    assert simulation.snapshot().surface_contact_held


def test_nodes_inside_two_bodies_side_by_side(simulate, any_mode):
    """A cloth in a floor and in a wall would count as pressed between them."""
    wall = {
        'colliders.names': ['floor', 'wall'], 'colliders.wall.shape': 'plane',
        'colliders.wall.position': [0.6 * LYING['width'], 0.0, 0.0],
        'colliders.wall.orientation': [0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)]}
    simulation = simulate({
        **LYING, **FLOOR, **wall, 'mode': any_mode, 'gravity': [0.0, 0.0, 0.0],
        'start.z': -0.05})
    simulation.advance(0.02)
    assert not simulation.snapshot().surface_contact_held


@pytest.mark.parametrize(('room', 'is_held'), [(0.005, True), (-0.005, False)])
def test_bodies_that_overlap_press_on_no_node(simulate, any_mode, room, is_held):
    """A cloth inside two bodies that overlap each other would count as pressed between them."""
    lid = {
        'colliders.names': ['floor', 'lid'], 'colliders.lid.shape': 'plane',
        'colliders.lid.position': [0.0, 0.0, room],
        'colliders.lid.orientation': [1.0, 0.0, 0.0, 0.0]}
    simulation = simulate({
        **LYING, **FLOOR, **lid, 'mode': any_mode, 'contact.thickness': 0.01,
        'start.z': 0.5 * room})
    simulation.advance(0.02)
    assert simulation.snapshot().surface_contact_held == is_held


def test_a_floor_carries_the_weight(simulate, within, any_mode):
    """A force sensor in the table would show another weight."""
    simulation = simulate({**LYING, **FLOOR, 'mode': any_mode, 'start.z': 0.02})
    simulation.advance(0.5)
    force, = simulation.contact_forces()
    weight = simulation.scene.node_mass * simulation.scene.node_count * GRAVITY
    within('force on the floor over the weight, less 1', abs(-force.force[2] / weight - 1.0), 1e-3)
    assert force.sticking + force.sliding == simulation.scene.node_count


# Where a body is, one function tells all modes: each shape in one of them, and a box in all.
@pytest.mark.parametrize('body', [
    {'shape': 'sphere', 'size': [0.15]}, {'shape': 'capsule', 'size': [0.1, 0.3]},
    {'shape': 'box', 'size': [0.2, 0.3, 0.1]}, {'shape': 'cylinder', 'size': [0.2, 0.1]}],
    ids=lambda body: body['shape'])
def test_a_cloth_drapes_over_a_body(simulate, within, any_mode, body):
    """A cloth would fall through a body, or hover above it."""
    simulation = simulate({
        'mode': any_mode, 'rows': 16, 'cols': 16, 'width': 0.5, 'height': 0.5, 'pins': ['none'],
        'start.z': 0.25, 'dt': 0.005, 'contact.thickness': 0.0, 'colliders.names': ['body'],
        'colliders.body.friction': 0.5, 'air.density': 1.225,
        **{f'colliders.body.{name}': value for name, value in body.items()}})
    deepest, faces = 0.0, 0.0
    for _ in range(20):
        simulation.advance(0.025)
        collider, = simulation.colliders
        positions = simulation.positions().astype(float)
        deepest = max(deepest, -float(distance_to(collider, positions).min()))
        middles = 0.25 * (
            positions[1:, 1:] + positions[1:, :-1] + positions[:-1, 1:] + positions[:-1, :-1])
        faces = max(faces, -float(distance_to(collider, middles).min()))
    within('deepest node [m]', deepest, 1e-6)
    if body['shape'] in ('sphere', 'capsule'):
        # A chord dips so far into a circle.
        within('deepest middle of a face, over a^2 / (4 R)',
               faces / (max(simulation.scene.spacing)**2 / (4.0 * body['size'][0])), 1.2)
    force, = simulation.contact_forces()
    assert force.sticking + force.sliding > 0
    assert simulation.snapshot().max_strain < 0.3


def test_a_moving_ball_hits_a_free_cloth(simulate, within, any_mode):
    """The force on a collider would not be what the cloth feels."""
    simulation = simulate({
        'mode': any_mode, 'rows': 10, 'cols': 10, 'width': 0.5, 'height': 0.5, 'pins': ['none'],
        'gravity': [0.0, 0.0, 0.0], 'start.z': 0.0, 'dt': 0.002, 'solver.tolerance': 1e-5,
        'colliders.names': ['ball'], 'colliders.ball.size': [0.1],
        'colliders.ball.position': [0.02, 0.03, -0.12], 'collider_moves.start': [0.01],
        'collider_moves.name': ['ball'], 'collider_moves.target': [0.02, 0.03, 0.2],
        'collider_moves.speed': [1.0]})
    given = np.zeros(3)
    for _ in range(60):
        simulation.step()
        force, = simulation.contact_forces()
        given -= simulation.dt * force.force
    momentum = simulation.scene.node_mass * simulation.velocities().astype(float).sum(axis=(0, 1))
    assert momentum[2] > 0.0
    within('momentum less what the ball gave, relative',
           np.abs(momentum - given).max() / np.abs(momentum).max(), 1e-5)


def test_without_friction_energy_never_rises(simulate, within, any_mode):
    """Contact would be a source of energy."""
    simulation = simulate({
        'mode': any_mode, 'rows': 12, 'cols': 12, 'width': 0.5, 'height': 0.5, 'pins': ['none'],
        'start.z': 0.3, 'dt': 0.001, **FLOOR, 'colliders.floor.friction': 0.0,
        'colliders.floor.orientation': [0.2, 0.15, 0.0, 1.0],
        **{f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}})
    scale = simulation.scene.node_mass * simulation.scene.node_count * GRAVITY * 0.5
    before = simulation.snapshot()
    least, rise = math.inf, 0.0
    for _ in range(300):
        simulation.step()
        seen = simulation.snapshot()
        # A velocity belongs to the middle of its substep, so that of the positions before lies
        # between two.
        mean = 0.5 * (before.velocities.astype(float) + seen.velocities)
        energy = (before.total_energy - before.kinetic_energy
                  + 0.5 * simulation.scene.node_mass * np.sum(mean**2))
        least = min(least, energy)
        rise = max(rise, energy - least)
        before = seen
    within('energy gained over M g L', rise / scale, 1e-4)


def test_untouched_colliders_change_nothing(simulate, any_mode):
    """A scene would move otherwise for a table that stands far away."""
    values = {'mode': any_mode, 'rows': 12, 'cols': 10, 'pins': ['none'], 'start.jitter': 0.1}
    states = []
    for more in ({}, {
            'colliders.names': ['far'], 'colliders.far.size': [1.0],
            'colliders.far.position': [9.0, 0.0, 0.0]}):
        simulation = simulate({**values, **more})
        simulation.advance(0.1)
        states.append(simulation.snapshot().state_sha256)
    assert states[0] == states[1]


def test_nothing_creeps_on_a_table_that_turns(simulate, within, any_mode):
    """What sticks would be carried outwards, as a velocity along the tangent does."""
    simulation = simulate({
        **LYING, **FLOOR, 'mode': any_mode, 'colliders.floor.friction': 0.9,
        'motion.angular_speed': 1.0})
    simulation.move_collider(
        'floor', (0.0, 0.0, 0.0), (0.0, 0.0, math.sin(0.6), math.cos(0.6)))

    def on_the_table():
        return simulation.colliders[0].pose.seen_from(simulation.positions().astype(float))

    # It slides until it has the velocity of the table.
    simulation.advance(0.2)
    begin = on_the_table()
    simulation.advance(0.9)
    within('way on a table that turns by 0.9 rad [m]', np.abs(on_the_table() - begin).max(), 1e-5)


def test_a_blade_that_turns_lets_nothing_through(simulate, within, any_mode):
    """A cloth would pass through a body that turns."""
    simulation = simulate({
        'rows': 12, 'cols': 12, 'width': 0.4, 'height': 0.4, 'pins': ['none'], 'dt': 0.005,
        'start.pose': 'horizontal', 'start.z': 0.05, 'mode': any_mode,
        'colliders.names': ['blade'], 'colliders.blade.shape': 'box',
        'colliders.blade.size': [0.9, 0.2, 0.02], 'colliders.blade.friction': 0.3,
        'collider_moves.start': [0.02], 'collider_moves.name': ['blade'],
        'collider_moves.target': [0.0, 0.0, 0.0],
        'collider_moves.orientation': [0.0, math.sin(0.75), 0.0, math.cos(0.75)],
        'collider_moves.angular_speed': [6.0]})
    deepest = 0.0
    for _ in range(60):
        simulation.step()
        deepest = max(deepest, -distance_to(
            simulation.colliders[0], simulation.positions().astype(float)).min())
    within('deepest node in a blade that turns [m]', deepest, 1e-6)


def test_what_touches_is_told(simulate, any_mode):
    """Stats and flags would be silent about contact, or go on after it has ended."""
    simulation = simulate({
        **LYING, **FLOOR, 'mode': any_mode, 'colliders.floor.friction': 0.3,
        'motion.speed': 10.0})
    simulation.advance(0.02)
    lying = simulation.snapshot()
    assert (lying.sticking_nodes, lying.sliding_nodes) == (48, 0)
    assert lying.deepest_node <= 1e-6
    assert np.all(lying.flags & FLAG_TOUCHING)
    simulation.move_collider('floor', (0.0, 0.0, -1.0))
    simulation.advance(0.2)
    falling = simulation.snapshot()
    assert (falling.sticking_nodes, falling.sliding_nodes) == (0, 0)
    assert not np.any(falling.flags & FLAG_TOUCHING)
    # Taken as it is, and not moved out within no step at all.
    simulation.set_state(
        np.full_like(falling.positions, -1.25), np.zeros_like(falling.positions))
    assert simulation.snapshot().deepest_node == pytest.approx(0.25, rel=1e-6)
