# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The adaptive mode holds its limit, lets go again, and is mass-spring where it has none."""

from contextlib import closing

from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.held.pin_forces import spring_tension
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
from cloth_sim_ros.study.energy_account import EnergyAccount
from inactive_cost import inactive_costs
from limits import limit_run
from limits import spread
import numpy as np
from pushed_scenes import paper_scene
from pushed_scenes import unit_scene
import pytest

# Scene, push, largest strain, spread of peak kinetic energy (issue 3, point 3).
CASES = [('paper', 12, 5.0, 0.11, 0.1), ('paper', 12, 20.0, 0.125, 0.1)]
LONG_CASES = [
    ('unit', 12, 5.0, 0.125, 0.1), ('unit', 12, 20.0, 0.14, 0.12), ('unit', 32, 5.0, 0.12, 0.1),
    ('unit', 32, 20.0, 0.15, 0.12)]
LIMP = {'stiffness.structural': 5.0, 'stiffness.shear': 5.0, 'stiffness.bend': 0.5,
        'damping.structural': 1e-4, 'damping.shear': 1e-4, 'damping.bend': 1e-4}

# Relative difference of limits that float32 does not resolve [1].
NEARLY = 3e-5
SCHEMES = ('list', 'lattice', 'whole')


def scene_of(kind, nodes, push, dt, **changes):
    """Return the values of a paper or unit scene."""
    if kind == 'paper':
        return paper_scene(push, dt, **changes)
    return unit_scene(nodes, push, dt, **changes)


def check_limit(kind, nodes, push, strain, energy, seconds, dts):
    """Run at each dt, and hold strain and spread of energy to their limits."""
    runs = [limit_run(scene_of(kind, nodes, push, dt), seconds) for dt in dts]
    for dt, run in zip(dts, runs):
        print(f'measured {run.max_strain:.4f} of {strain} allowed at dt {dt}, '
              f'{100 * run.switching:.2f} % switching, {run.substeps:.0f} substeps/s')
        assert run.finite
        assert run.max_strain <= strain
    print(f'measured {spread(runs):.3f} of {energy} allowed: spread of peak kinetic energy')
    assert spread(runs) <= energy
    return runs


@pytest.mark.parametrize(('kind', 'nodes', 'push', 'strain', 'energy'), CASES[:1])
def test_a_pushed_cloth_keeps_its_limit(kind, nodes, push, strain, energy):
    """Edges stretch far beyond the limit, or the frame's dt changes the motion."""
    check_limit(kind, nodes, push, strain, energy, 1.8, (0.01, 0.02, 0.05))


@pytest.mark.long
@pytest.mark.parametrize(('kind', 'nodes', 'push', 'strain', 'energy'), CASES + LONG_CASES)
def test_a_pushed_cloth_keeps_its_limit_for_long(kind, nodes, push, strain, energy):
    """The limit is lost, or energy comes up, some time after the push."""
    check_limit(kind, nodes, push, strain, energy, 10.0, (0.01, 0.015, 0.02, 0.03, 0.04, 0.05))


@pytest.mark.parametrize(('push', 'dt'), [
    (5.0, 0.05),
    *(pytest.param(push, dt, marks=pytest.mark.long)
      for push, dt in ((20.0, 0.03), (5.0, 0.01), (20.0, 0.01), (5.0, 0.03), (20.0, 0.05)))])
def test_constraints_do_not_chatter(push, dt):
    """Constraints go on and off in turn, which is noise and heats the cloth."""
    switching = limit_run(paper_scene(push, dt), 10.0).switching
    print(f'measured {100.0 * switching:.2f} of 2 % allowed: switches a frame, push {push}')
    assert switching <= 0.02


def test_the_papers_scheme_fails_as_it_reports():
    """The comparison with the paper is with something that isn't its scheme."""
    runs = [limit_run(
        paper_scene(5.0, dt, **{'adaptive.scheme': 'paper', 'auto_substeps': False}),
        4.0, check_stability=False, stop_at_non_finite=False) for dt in (0.01, 0.02)]
    print([(run.max_strain, run.peak_kinetic_energy) for run in runs])
    assert runs[0].max_strain < 0.5
    assert runs[1].max_strain > 2.0
    assert runs[1].peak_kinetic_energy > 20.0 * runs[0].peak_kinetic_energy


@pytest.mark.parametrize(('threshold', 'seconds'), [
    (0.02, 0.8),
    *(pytest.param(threshold, 1.6, marks=pytest.mark.long) for threshold in (0.005, 0.02, 0.5))])
def test_the_threshold_is_the_limit(threshold, seconds):
    """A limit other than 10 % is not held, or not reached."""
    run = limit_run(unit_scene(10, 5.0, 0.01, **{'adaptive.threshold': threshold}), seconds)
    assert run.finite
    assert threshold < run.max_strain < 2.0 * threshold


@pytest.mark.parametrize('least', [60, pytest.param(1000, marks=pytest.mark.long)])
def test_a_tumbling_cloth_keeps_its_momentum_at_the_limit(context, least):
    """An edge at its limit pushes one end more than the other, or not along itself."""
    scene = Scene({
        **LIMP, 'rows': 16, 'cols': 16, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
        'start.z': 0.0, 'mode': 'adaptive', 'adaptive.threshold': 0.02, 'dt': 0.005})
    with closing(Simulation(scene, context=context)) as simulation:
        start = simulation.snapshot().positions.astype(float)
        random = np.random.default_rng(3)
        spin = np.cross([2.0, 3.0, 6.0], start)
        simulation.set_state(start, spin + 0.5 * random.standard_normal(start.shape))
        before = momenta(simulation.snapshot())
        substeps, active = 0, 0
        while substeps < least and simulation.time < 60.0:
            simulation.step()
            substeps += simulation.substeps
            active += simulation.snapshot().active_constraints > 0
        after = momenta(simulation.snapshot())
        steps = simulation.steps
    print(f'measured {np.abs(after[0] - before[0]).max() / before[2]:.1e} of 1e-6 and '
          f'{np.abs(after[1] - before[1]).max() / before[3]:.1e} of 5e-6 allowed: momentum after '
          f'{substeps} substeps, edges at the limit after {active} of {steps} steps')
    assert substeps >= least
    assert active > 0.2 * steps
    assert np.abs(after[0] - before[0]).max() <= 1e-6 * before[2]
    assert np.abs(after[1] - before[1]).max() <= 5e-6 * before[3]


@pytest.mark.parametrize(('scheme', 'spin'), [
    ('constraint', 12.0), ('list', 12.0), ('lattice', 12.0), ('whole', 4.0)])
def test_a_push_gives_its_impulse_at_the_limit(context, scheme, spin):
    """A push is given more or less as the substeps become shorter while it acts."""
    scene = Scene({
        **LIMP, 'rows': 12, 'cols': 12, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
        'mode': 'adaptive', 'adaptive.scheme': scheme, 'dt': 0.02})
    impulse = np.array([0.3, -0.2, 0.5])
    with closing(Simulation(scene, context=context)) as simulation:
        start = simulation.snapshot().positions.astype(float)
        simulation.set_state(start, np.cross([0.0, 0.0, spin], start) + 6.0 * start)
        before = simulation.snapshot().velocities.astype(float).sum(axis=(0, 1))
        simulation.push(impulse / 0.137, duration=0.137)
        counts = []
        while simulation.time < 0.2:
            simulation.step()
            counts.append(simulation.substeps)
        after = simulation.snapshot().velocities.astype(float).sum(axis=(0, 1))
    assert len(set(counts)) > 1
    given = scene.node_mass * (after - before)
    miss = np.abs(given - impulse).max() / np.abs(impulse).max()
    print(f'measured {miss:.1e} of 1e-5 allowed: impulse of a push, over its own')
    assert miss <= 1e-5


def momenta(snapshot):
    """Return sums over nodes of v, of x cross v, of |v| and of |x| |v|."""
    positions = snapshot.positions.astype(float)
    velocities = snapshot.velocities.astype(float)
    speed = np.linalg.norm(velocities, axis=-1)
    return (velocities.sum(axis=(0, 1)), np.cross(positions, velocities).sum(axis=(0, 1)),
            speed.sum(), (np.linalg.norm(positions, axis=-1) * speed).sum())


def test_a_calm_cloth_is_mass_spring_to_the_bit():
    """Cloth within its limit is not stepped as its springs alone would."""
    stiff = {'stiffness.structural': 300.0, 'stiffness.shear': 300.0, 'pins': ['top_edge']}
    for cost in inactive_costs(stiff, (12, 33), 2, 20):
        assert cost.same_state
        assert cost.largest_strain < 0.1
        assert len(cost.ratios) == 2


def test_edges_at_the_limit_are_shown_and_counted(context):
    """People would not see where constraints act, or see them where there are none."""
    with closing(Simulation(Scene(unit_scene(12, 5.0, 0.01)), context=context)) as simulation:
        assert not (simulation.snapshot().flags & FLAG_AT_LIMIT).any()
        simulation.advance(0.5)
        snapshot = simulation.snapshot()
        at_limit = (snapshot.flags & FLAG_AT_LIMIT) != 0
        assert 0 < snapshot.active_constraints < 506
        assert snapshot.active_fraction == snapshot.active_constraints / 506
        assert at_limit[0, 0] and at_limit[0, -1]
        # Each node with a mark has an edge that is held there.
        assert snapshot.strain[at_limit].min() > 0.095
        assert snapshot.strain[~at_limit].max() < 0.105
        simulation.set_mode('mass_spring')
        assert not (simulation.snapshot().flags & FLAG_AT_LIMIT).any()
        assert simulation.snapshot().active_constraints == 0


def thrown(context, scheme):
    """Return a cloth that is thrown so that its edges come to their limits and leave them."""
    simulation = Simulation(Scene({
        **LIMP, 'rows': 9, 'cols': 7, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
        'mode': 'adaptive', 'adaptive.scheme': scheme, 'dt': 0.005}), context=context)
    start = simulation.positions().astype(float)
    random = np.random.default_rng(3)
    simulation.set_state(start, 1.5 * random.standard_normal(start.shape))
    return closing(simulation)


def limited_edges(simulation):
    """
    Return for each kind of edge with a limit its ends, and arrays of what its edges do.

    :return: ends, strain over the limit, whether the limit pulls now, and whether float32 leaves
        that in doubt
    """
    scene, snapshot = simulation.scene, simulation.snapshot(tension=True)
    positions = snapshot.positions.astype(float)
    # In schemes list and lattice an edge is held by an impulse, beside its spring; in scheme whole
    # by a law that pulls beyond the limit.
    springs = spring_tension(scene, snapshot.positions, snapshot.velocities)
    pulls = np.abs(snapshot.tension - springs)
    found = []
    for kind in (kind for kind in EDGE_KINDS if kind.family != 'bend'):
        ends = kind.everywhere(scene.rows, scene.cols)
        lengths = np.linalg.norm(positions[ends[1]] - positions[ends[0]], axis=-1)
        strain = np.abs(lengths / kind.rest_length(scene) - 1.0)
        share = strain / scene['adaptive.threshold']
        if scene['adaptive.scheme'] == 'whole':
            is_held, in_doubt = share > 1.0, np.abs(share - 1.0) < NEARLY
        else:
            is_held = pulls[(*ends[0], kind.number)] > 0.0
            in_doubt = np.zeros_like(is_held)
        found.append((ends, share, is_held, in_doubt))
    return found


@pytest.mark.parametrize('scheme', SCHEMES)
def test_both_ends_of_each_edge_at_its_limit_are_shown(context, scheme):
    """One end of some edges would look as if nothing held it."""
    alone = set()
    with thrown(context, scheme) as simulation:
        for _ in range(40):
            simulation.step()
            shown = (simulation.snapshot().flags & FLAG_AT_LIMIT) != 0
            at_limit, in_doubt = [], np.zeros_like(shown)
            for ends, _, is_held, is_near in limited_edges(simulation):
                for end in ends:
                    at_limit.append(np.zeros_like(shown))
                    at_limit[-1][end] = is_held
                    in_doubt[end] |= is_near
            count = np.sum(at_limit, axis=0)
            assert np.array_equal(shown[~in_doubt], (count > 0)[~in_doubt])
            alone |= {
                number for number, nodes in enumerate(at_limit)
                if np.any(nodes & (count == 1) & ~in_doubt)}
    assert alone == set(range(8))


@pytest.mark.parametrize('scheme', SCHEMES)
def test_an_edge_is_engaged_until_it_is_back_at_half_its_limit(context, scheme):
    """Each edge that swings at its limit would count as a switch at each swing."""
    engaged = in_doubt = None
    switched = held_below = 0
    with thrown(context, scheme) as simulation:
        for _ in range(40):
            simulation.step()
            snapshot = simulation.snapshot()
            shares, held, near = (
                np.concatenate([edges[place].ravel() for edges in limited_edges(simulation)])
                for place in (1, 2, 3))
            if engaged is None:
                engaged = in_doubt = np.zeros(shares.shape, dtype=bool)
            before, engaged = engaged, held | ((shares > 0.5) & engaged)
            in_doubt = in_doubt | near | (before & (np.abs(shares - 0.5) < NEARLY))
            switches = np.count_nonzero(engaged != before)
            assert abs(snapshot.constraint_switches - switches) <= in_doubt.sum()
            assert abs(snapshot.active_constraints - np.count_nonzero(held)) <= near.sum()
            switched += switches
            held_below += np.count_nonzero(engaged & ~held)
    assert switched > 100 and held_below > 100 and in_doubt.sum() < 10


def test_a_run_with_switches_and_pushes_is_repeatable(context):
    """Something of the run before, or thread timing, gets into the state."""
    hashes = []
    with closing(Simulation(Scene(unit_scene(10, 20.0, 0.01)), context=context)) as simulation:
        for _ in range(2):
            simulation.advance(0.4)
            simulation.set_mode('mass_spring')
            simulation.push((0.0, 0.0, 1.0), duration=0.1, region='sphere', radius=2.0)
            simulation.advance(0.05)
            simulation.set_mode('adaptive')
            simulation.advance(0.2)
            hashes.append(simulation.snapshot().state_sha256)
            simulation.reset()
    assert hashes[0] == hashes[1]


@pytest.mark.parametrize('dt', [1e-4, 0.01])
@pytest.mark.parametrize('largest', [0.95, 1.05, 1.5, 5.0])
def test_a_cloth_that_comes_strained_gains_nothing(context, largest, dt):
    """The limit pulls at once at what has the energy of springs, and throws the cloth together."""
    values = {
        'mode': 'adaptive', 'rows': 8, 'cols': 8, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
        'adaptive.threshold': 0.02, 'areal_density': 0.1, **LIMP, 'dt': dt}
    with closing(Simulation(Scene(values), context=context)) as simulation:
        rest = simulation.scene.rest_positions()
        stretched = rest * (1.0 + 0.02 * largest * np.linspace(-1.0, 1.0, 8)[:, None])
        simulation.set_state(stretched, np.zeros_like(rest))
        account = EnergyAccount(simulation)
        for _ in range(40):
            account.step(1)
        print(f'measured {account.gained:.2g} of 0.02 allowed: energy from nothing')
        assert account.gained <= 0.02


def test_fixed_substeps_above_the_limit_are_refused(context):
    """A run would blow up without a word."""
    with pytest.raises(ClothSimError, match='in mode adaptive'):
        Simulation(Scene(paper_scene(5.0, 0.05, auto_substeps=False)), context=context)


def test_a_calm_cloth_has_no_solver_in_memory(context):
    """A cloth that never comes to its limit would pay for what holds one that does."""
    values = {**LIMP, 'rows': 24, 'cols': 24, 'areal_density': 0.2, 'adaptive.threshold': 0.3}
    taken = {}
    for mode, scheme in (('mass_spring', 'constraint'), ('adaptive', 'list'),
                         ('adaptive', 'whole')):
        with take_inventory() as inventory, \
                closing(Simulation(Scene({
                    **values, 'mode': mode, 'adaptive.scheme': scheme}),
                    context=context)) as simulation:
            simulation.step(3)
            taken[mode] = inventory.buffer_bytes
            if mode == 'adaptive':
                simulation.push((0.0, 0.0, 20.0), duration=1.0)
                simulation.step(40)
                snapshot = simulation.snapshot()
                assert snapshot.listed_substeps or snapshot.solves, 'it comes to its limit'
                assert inventory.buffer_bytes > 2 * taken[mode]
                simulation.reset()
                simulation.step(3)
                assert inventory.buffer_bytes < 2 * taken[mode]
        assert taken[mode] < 1.2 * taken['mass_spring']


@pytest.mark.parametrize('nodes', [12, pytest.param(20, marks=pytest.mark.long)])
@pytest.mark.parametrize('dt', [0.005, 0.01])
def test_a_limit_that_is_passed_is_reported(context, nodes, dt):
    """At 1 % nothing was said of 1.3 to 1.8 times the limit: lengths were held up to 5 times."""
    values = {'mode': 'adaptive', 'rows': nodes, 'cols': nodes, 'adaptive.threshold': 0.01}
    with closing(Simulation(Scene({**values, 'dt': dt}), context=context)) as simulation:
        weight = simulation.scene.node_count * simulation.scene.node_mass * 9.81
        simulation.advance(1.0)
        simulation.push((0.0, 0.0, 20.0 * weight), duration=0.2)
        seen = []
        for _ in range(round(0.25 / dt)):
            simulation.step()
            seen.append(simulation.snapshot())
    print(f'measured {max(each.max_strain for each in seen) / 0.01:.3g} times the limit')
    assert any(each.max_strain > 0.012 for each in seen)
    for each in seen:
        assert each.lengths_are_held is (each.max_strain <= 0.012)
