# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Air against what can be written down: falling, blown and held sheets in each mode."""

import math

from cloth_sim_ros.reference.forces import air_forces
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.validation.air import DENSITY
from cloth_sim_ros.validation.air import DRAG
from cloth_sim_ros.validation.air import fallen
from cloth_sim_ros.validation.air import GRAVITY
from cloth_sim_ros.validation.air import terminal_speed
import numpy as np
import pytest

RHO, CN, G = DENSITY, DRAG, GRAVITY
AIR = {'air.density': RHO}
FREE = {**AIR, 'pins': ['none']}
WEIGHTLESS = {**FREE, 'gravity': [0.0, 0.0, 0.0]}
# No springs, so that each node moves by the air alone.
LOOSE = {f'{what}.{family}': 0.0 for what in ('stiffness', 'damping')
         for family in ('structural', 'shear', 'bend')}
# Mass per area [kg/m2] and dt [s].
FALLS = ((0.10, 0.001), (0.15, 0.005), (0.187, 0.02), (0.324, 0.05))


@pytest.fixture
def start(simulate):
    """Return the function from scene values to a simulation."""
    return simulate


@pytest.fixture(params=[16, pytest.param(32, marks=pytest.mark.long), 64])
def side(request):
    """Return each number of nodes along a side."""
    return request.param


def sheet(start, mode, side, velocity=(0.0, 0.0, 0.0), **values):
    """Return a square cloth that moves as a whole."""
    run = start({'rows': side, 'cols': side, 'mode': mode, **FREE, **values})
    flat = run.scene.rest_positions()
    run.set_state(flat, np.broadcast_to(velocity, flat.shape))
    return run


@pytest.mark.parametrize(('side', 'sigma', 'dt'), [
    *((16, *fall) for fall in FALLS), (64, *FALLS[2]),
    *(pytest.param(side, *fall, marks=pytest.mark.long) for side in (32, 64) for fall in FALLS
      if (side, fall) != (64, FALLS[2]))], indirect=['side'])
def test_terminal_speed(context, any_mode, side, sigma, dt):
    """A cloth would come down too fast, or at a speed that depends on the step."""
    falls = fallen(context, any_mode, side, sigma, dt)
    assert falls.mean() == pytest.approx(terminal_speed(sigma), rel=1e-3)
    # What the solver leaves over makes a sheet flutter in the end, as a real one does.
    np.testing.assert_allclose(falls, terminal_speed(sigma), rtol=5e-3)


def test_fall(start, any_mode, side):
    """The way to the terminal speed would be another one."""
    speed = terminal_speed(0.1)
    run = sheet(start, any_mode, side, areal_density=0.1, dt=0.005)
    for _ in range(16):
        run.step(5)
        falls = -run.snapshot().velocities[..., 2]
        np.testing.assert_allclose(falls, speed * math.tanh(G * run.time / speed), rtol=0.005)


@pytest.mark.parametrize(('direction', 'coefficient'), [
    ((0.0, 0.0, 1.0), 'air.drag'), ((0.6, -0.8, 0.0), 'air.friction')])
def test_a_sheet_takes_up_the_wind(start, any_mode, side, direction, coefficient):
    """Drag would act along the surface, or friction across it, or either be of another size."""
    wind = 4.0 * np.array(direction)
    run = sheet(
        start, any_mode, side, gravity=[0.0, 0.0, 0.0], dt=0.002,
        **{'air.wind': wind.tolist(), 'air.drag': 0.0, 'air.friction': 0.0, coefficient: 0.8})
    run.advance(0.2)
    # w' = -c w^2
    per_metre = RHO * 0.8 / (2.0 * run.scene['areal_density'])
    left = wind / (1.0 + per_metre * 4.0 * run.time)
    np.testing.assert_allclose(
        run.snapshot().velocities, np.broadcast_to(wind - left, (side, side, 3)), atol=4e-3)


@pytest.mark.parametrize('wind', [(0.0, 0.0, 10.0), (6.0, 0.0, 8.0), (-2.0, 3.0, -4.0)])
def test_force_on_a_sheet_that_is_held(start, any_mode, side, wind):
    """Pins would hold another force than the wind exerts, by a share that grows with the step."""
    run = start({'rows': side, 'cols': side, 'mode': any_mode, **WEIGHTLESS, 'pins': ['all'],
                 'width': 0.7, 'height': 0.4, 'air.friction': 0.3, 'air.wind': wind})
    run.step(2)
    across, along = np.array((0.0, 0.0, wind[2])), np.array((*wind[:2], 0.0))
    pressure = 0.5 * RHO * (
        CN * np.linalg.norm(across) * across + 0.3 * np.linalg.norm(along) * along)
    held = run.snapshot(pin_forces=True).pin_forces.forces.sum(axis=0)
    np.testing.assert_allclose(held, 0.28 * pressure, rtol=1e-5, atol=1e-4)


def test_pins_hold_wind_and_weight(start, any_mode):
    """What the air gives to free nodes would not reach the pins."""
    run = start({'rows': 16, 'cols': 16, 'mode': any_mode, **AIR, 'pins': ['top_edge'],
                 'air.wind': [0.0, 0.8, 0.0], 'start.pose': 'hanging', 'air.friction': 0.02})
    run.advance(6.0 if any_mode == 'constraint' else 12.0)
    seen = run.snapshot(pin_forces=True)
    assert np.abs(seen.velocities).max() < 0.02
    nodes = np.argwhere(np.ones((16, 16), dtype=bool))
    blown = run.scene.node_mass * run.loads.at_nodes(nodes).sum(axis=0)
    np.testing.assert_allclose(
        seen.pin_forces.forces.sum(axis=0), blown, atol=2e-3 * np.linalg.norm(blown))


def wave(scene):
    """Return a cloth that is bent both ways, and how it moves."""
    flat = scene.rest_positions()
    x, y = flat[..., 0], flat[..., 1]
    flat[..., 2] += 0.05 * np.sin(5.0 * x) * np.cos(4.0 * y + 0.3)
    return flat, np.stack((0.3 * y, np.cos(3.0 * x), np.sin(4.0 * x + y)), axis=-1)


def test_wind_is_motion_the_other_way(start, any_mode, side):
    """The force would depend on more than the velocity of the air past the cloth (Galilei)."""
    wind = np.array((3.0, -1.0, 2.0))
    ends = []
    for blows, moves in ((wind, 0.0 * wind), (0.0 * wind, -wind)):
        run = start({'rows': side, 'cols': side, 'mode': any_mode, **WEIGHTLESS, 'dt': 0.002,
                     'air.wind': blows.tolist()})
        positions, velocities = wave(run.scene)
        run.set_state(positions, velocities + moves)
        run.step(10)
        seen = run.snapshot()
        ends.append((seen.positions - run.time * moves, seen.velocities - moves))
    # Springs of small cells make the more of the rounding of positions, which are elsewhere; mode
    # constraint solves for a change of velocity to 0.5 % of it.
    speed = 2e-6 * side**2 if any_mode != 'constraint' else 0.02
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=0.02 * speed)
    np.testing.assert_allclose(ends[0][1], ends[1][1], atol=speed)


def test_only_the_velocity_past_the_cloth_counts(start, side):
    """The force would depend on more than that (Galilei)."""
    wind = np.array((3.0, -1.0, 2.0))
    given = []
    for blows, moves in ((wind, 0.0 * wind), (0.0 * wind, -wind)):
        run = start({'rows': side, 'cols': side, **WEIGHTLESS, **LOOSE, 'air.friction': 0.3,
                     'air.wind': blows.tolist()})
        positions, velocities = wave(run.scene)
        run.set_state(positions, velocities + moves)
        run.step(20)
        given.append(run.snapshot().velocities - moves)
    # A coordinate is rounded by 1e-7 of its size, which turns the normals of small cells.
    np.testing.assert_allclose(given[0], given[1], atol=1.5e-6 * side)


@pytest.mark.parametrize('dt', [1e-4, 0.01, 0.05, 1.0])
@pytest.mark.parametrize('pins', ['none', 'top_edge'])
def test_still_air_never_adds_energy(start, dt, pins, side):
    """Long steps would turn velocities round and throw nodes off."""
    run = start({'rows': side, 'cols': side, **WEIGHTLESS, **LOOSE, 'pins': [pins], 'dt': dt,
                 'air.drag': 5.0, 'air.friction': 2.0, 'areal_density': 0.05})
    shape = run.scene.rest_positions().shape
    chance = np.random.default_rng(3)
    velocities = chance.uniform(-30.0, 30.0, shape) * ~run.scene.pinned_nodes()[..., None]
    run.set_state(run.scene.rest_positions() + chance.uniform(-0.03, 0.03, shape), velocities)
    energy = run.measure().kinetic_energy
    for _ in range(20):
        run.step()
        now = run.measure().kinetic_energy
        assert now <= energy * (1.0 + 1e-6)
        energy = now
    assert energy < 0.9 * 0.5 * 0.05 * np.mean(np.sum(velocities**2, axis=-1))


@pytest.mark.parametrize('rows', [16, 33])
def test_a_flat_sheet_feels_no_torque(start, rows):
    """Borders would be blown off first, or one diagonal of the cells preferred."""
    run = start({'rows': rows, 'cols': 16, **WEIGHTLESS, **LOOSE, 'air.friction': 0.5,
                 'air.wind': [3.0, 2.0, 5.0], 'dt': 0.002})
    run.step(5)
    velocities = run.snapshot().velocities.reshape(-1, 3)
    assert np.abs(velocities[0]).min() > 0.01
    np.testing.assert_allclose(velocities, np.broadcast_to(velocities[0], velocities.shape),
                               rtol=2e-6)


def test_the_account_closes_at_any_fineness(start, any_mode, side):
    """Borders or small cells would take energy that the air does not get."""
    run = start({'rows': side, 'cols': side, 'mode': any_mode, **AIR, 'dt': 0.002,
                 'air.wind': [3.0, 0.0, 5.0]})
    account = EnergyAccount(run)
    account.step(30)
    assert account.air_work > 0.1
    assert account.gained < 0.005


@pytest.mark.parametrize('given', [
    {}, {'air.wind': [4.0, 1.0, 0.0]}, {'air.wind': [4.0, 1.0, 0.0], 'pins': ['none']},
    {'air.wind': [1.0, 0.0, 2.0], 'gusts.start': [0.1], 'gusts.duration': [0.07],
     'gusts.wind': [0.0, 5.0, 3.0], 'pushes.start': [0.2], 'pushes.duration': [0.1],
     'pushes.force': [0.0, 0.0, 3.0], 'pushes.center': [0.0, 0.0, 0.9], 'pushes.radius': [0.4]}],
    ids=['still', 'wind', 'free', 'gust and push'])
def test_the_account_of_energy_closes(start, any_mode, given):
    """Energy would be gained from the air, or lost, without appearing in its work."""
    undamped = {name: 0.0 for name in LOOSE if name.startswith('damping')}
    run = start({'rows': 16, 'cols': 16, 'mode': any_mode, **AIR, 'dt': 0.002, **undamped,
                 **given})
    account = EnergyAccount(run)
    account.step(200)
    assert abs(account.air_work) > 0.1
    assert account.gained < 0.005
    if any_mode == 'mass_spring':
        change = account.seen.total_energy - account.begin.total_energy
        if 'pushes.start' not in given:
            assert change == pytest.approx(account.air_work, abs=0.005 * abs(account.air_work))


def test_a_gust_gives_the_same_at_any_step(start):
    """A gust would last for whole steps, and be another one for each dt."""
    ends = []
    for dt in (0.001, 0.004, 0.016):
        run = start({**WEIGHTLESS, **LOOSE, 'rows': 4, 'cols': 4, 'dt': dt, 'air.drag': 0.01,
                     'gusts.start': [0.0305], 'gusts.duration': [0.021],
                     'gusts.wind': [0.0, 0.0, 8.0]})
        run.advance(0.08)
        ends.append(run.snapshot().velocities[0, 0, 2])
    # A force that goes with the square of the mean wind of a step is smaller in part of a step.
    assert ends[0] == pytest.approx(RHO * 0.01 / 0.4 * 64.0 * 0.021, rel=0.04)
    assert ends[1] == pytest.approx(ends[0], rel=0.05)


@pytest.mark.parametrize('values', [
    {}, {'rows': 7, 'cols': 19, 'height': 0.5}, {'rows': 2, 'cols': 2, 'pins': ['0,1']},
    {'loads': 'storage', 'block': 1}, {'rows': 33, 'cols': 5, 'node_mass': 0.003}])
def test_it_is_the_law(start, values):
    """A triangle or a border would be left out on a cloth of some shape."""
    run = start({'rows': 16, 'cols': 16, **AIR, 'gravity': [0.0, 0.0, 0.0], 'air.friction': 0.3,
                 'air.wind': [3.0, -2.0, 1.0], 'dt': 1e-5, 'auto_substeps': False, **values})
    scene, chance = run.scene, np.random.default_rng(1)
    shape = scene.rest_positions().shape
    # As the device holds them.
    positions = (scene.rest_positions() + chance.uniform(-0.02, 0.02, shape)).astype(np.float32)
    velocities = np.float32(chance.uniform(-3.0, 3.0, shape) * ~scene.pinned_nodes()[..., None])
    run.set_state(positions, velocities)
    run.step()
    nodes = np.argwhere(np.ones(shape[:2], dtype=bool))
    law = air_forces(scene, positions.astype(float), velocities.astype(float),
                     np.array(scene['air.wind'])) / scene.node_mass
    np.testing.assert_allclose(
        run.loads.at_nodes(nodes).reshape(shape), law, atol=2e-6 * np.abs(law).max())


@pytest.mark.parametrize('loads', [('texture', 4), ('storage', 1), ('storage', 2)])
def test_all_ways_of_reading_agree(start, loads):
    """A device of another kind would have other air."""
    ends = []
    for way, block in (('texture', 1), loads):
        run = start({'rows': 13, 'cols': 18, **AIR, 'air.wind': [2.0, 1.0, 3.0], 'loads': way,
                     'block': block})
        run.step(20)
        ends.append(run.snapshot().positions)
    np.testing.assert_allclose(ends[0], ends[1], atol=2e-6)


def test_each_layout_has_air(start, layout):
    """The paper's two passes would leave the air out."""
    run = start({'rows': 13, 'cols': 18, **AIR, 'air.wind': [2.0, 1.0, 3.0], 'layout': layout})
    other = start({'rows': 13, 'cols': 18, 'layout': layout})
    for each in (run, other):
        each.step(20)
    assert run.snapshot().positions[-1, 9, 2] > other.snapshot().positions[-1, 9, 2] + 0.01


@pytest.mark.parametrize('wind', [5.0, 20.0])
@pytest.mark.parametrize('dt', [0.005, 0.02])
def test_a_held_sheet_has_all_the_wind(start, any_mode, dt, wind):
    """In mode constraint at dt 0.02 s it had 0.35 of the force at 5 m/s, 0.087 at 20 m/s."""
    run = start({
        'rows': 12, 'cols': 12, 'mode': any_mode, 'dt': dt, 'areal_density': 0.05, **AIR,
        'pins': ['all'], 'gravity': [0.0, 0.0, 0.0], 'air.wind': [0.0, 0.0, wind]})
    run.step(3)
    seen = run.snapshot(pin_forces=True)
    force = abs(seen.pin_forces.forces[:, 2].sum())
    assert force == pytest.approx(RHO * CN / 2.0 * wind**2, rel=1e-3)
    assert seen.air_margin <= 1.0


@pytest.mark.parametrize(('values', 'longer'), [
    ({'mode': 'constraint', 'auto_substeps': False}, 11.5),
    ({'mode': 'constraint', 'constraint.max_substeps': 4}, 2.87),
    ({'mode': 'mass_spring', **LOOSE, 'stiffness.structural': 1e-3}, 11.5)])
def test_wind_that_is_cut_is_reported(start, values, longer):
    """The force of the air would be too small without a word, where substeps are too long."""
    run = start({
        'rows': 12, 'cols': 12, 'dt': 0.02, 'areal_density': 0.05, **AIR, 'pins': ['all'],
        'gravity': [0.0, 0.0, 0.0], 'air.wind': [0.0, 0.0, 20.0], **values})
    run.step(3)
    seen = run.snapshot(pin_forces=True)
    assert seen.air_margin == pytest.approx(longer, rel=0.01)
    force = abs(seen.pin_forces.forces[:, 2].sum())
    assert force == pytest.approx(RHO * CN / 2.0 * 400.0 / seen.air_margin, rel=0.02)


@pytest.mark.parametrize('pins', [['all'], ['none']])
def test_air_costs_no_substeps_in_usual_scenes(start, pins):
    """Scenes whose substeps are short enough would be stepped otherwise, or looked at."""
    run = start({
        'rows': 12, 'cols': 12, 'mode': 'constraint', 'dt': 0.005, **AIR, 'pins': pins,
        'air.wind': [0.0, 0.0, 5.0], 'areal_density': 0.2})
    run.step(3)
    assert run.snapshot().substeps == 1
    assert run.snapshot().air_margin == 0.0
