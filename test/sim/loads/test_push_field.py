# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pushes act on the nodes of their region, for their time, and add up."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.loads.push_field import MOST_PUSHES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

# Free nodes without springs or gravity: what moves was pushed.
_FREE = {
    'rows': 6, 'cols': 5, 'gravity': [0.0, 0.0, 0.0], 'pins': ['0,0'], 'dt': 0.01,
    **{f'{law}.{family}': 0.0 for law in ('stiffness', 'damping')
       for family in ('structural', 'shear', 'bend')}}
_CORNER = {'region': 'sphere', 'center': (0.5, -0.5, 1.0), 'radius': 0.3}


def velocities_after(simulation: Simulation, seconds: float) -> np.ndarray:
    """Return the vertical velocities after ``seconds`` more."""
    simulation.advance(seconds)
    return simulation.snapshot().velocities[..., 2]


def test_a_push_on_all_spreads_over_the_free_nodes(context):
    """The cloth would be pushed with more or less than the force asked for."""
    simulation = Simulation(Scene(_FREE), context=context)
    applied = simulation.push((0.0, 0.0, 2.9), duration=0.02)
    assert applied.nodes == 29
    assert applied.impulse == pytest.approx((0.0, 0.0, 0.058))
    v = velocities_after(simulation, 0.1)
    assert v[0, 0] == 0.0
    assert simulation.scene.node_mass * v.sum() == pytest.approx(0.058, rel=1e-6)
    assert simulation.pushes == ()


def test_a_push_on_a_sphere_moves_only_what_is_inside(context):
    """Nodes far away would move."""
    simulation = Simulation(Scene(_FREE), context=context)
    inside = np.linalg.norm(
        simulation.scene.rest_positions() - _CORNER['center'], axis=-1) <= _CORNER['radius']
    applied = simulation.push((0.0, 0.0, 1.0), duration=0.02, **_CORNER)
    assert applied.nodes == inside.sum() > 1
    assert np.array_equal(simulation.snapshot().flags == 4, inside)
    v = velocities_after(simulation, 0.1)
    assert np.array_equal(v > 0.0, inside)
    assert simulation.scene.node_mass * v.sum() == pytest.approx(0.02, rel=1e-6)
    assert not np.any(simulation.snapshot().flags == 4)


def test_overlapping_pushes_add_up(context):
    """The later push would replace the earlier one, or a slot be used twice."""
    simulation = Simulation(Scene(_FREE), context=context)
    simulation.push((0.0, 0.0, 1.0), duration=0.1)
    for _ in range(3):
        simulation.push((0.0, 0.0, 1.0), duration=0.05, **_CORNER)
    v = velocities_after(simulation, 0.2)
    assert simulation.scene.node_mass * v.sum() == pytest.approx(0.25, rel=1e-5)


def test_what_has_ended_leaves_no_trace(context):
    """A node would carry on the mark of a push that has ended."""
    simulation = Simulation(Scene(_FREE), context=context)
    elsewhere = {**_CORNER, 'center': (-0.5, -0.5, 1.0)}
    simulation.push((0.0, 0.0, 1.0), duration=0.02, **_CORNER)
    before = velocities_after(simulation, 0.05).copy()
    simulation.push((0.0, 0.0, 1.0), duration=0.02, **elsewhere)
    change = velocities_after(simulation, 0.05) - before
    assert change[5, 4] == 0.0
    assert change[5, 0] > 0.0


def test_a_push_to_come_waits(context):
    """A timed push would act at once."""
    simulation = Simulation(Scene(_FREE), context=context)
    simulation.push((0.0, 0.0, 1.0), duration=0.02, start=0.1, **_CORNER)
    assert not velocities_after(simulation, 0.1).any()
    assert velocities_after(simulation, 0.1).any()


def test_the_scenes_pushes_come_again_after_a_reset(context):
    """A second run of the same scene would go without its pushes."""
    simulation = Simulation(Scene({
        **_FREE, 'pushes.start': [0.05], 'pushes.duration': [0.02],
        'pushes.force': [0.0, 0.0, 1.0]}), context=context)
    first = velocities_after(simulation, 0.1).copy()
    simulation.reset()
    assert np.array_equal(velocities_after(simulation, 0.1), first)
    assert first.any()


def test_cleared_pushes_do_no_more(context):
    """The cloth would go on rising after the user took the push back."""
    simulation = Simulation(Scene(_FREE), context=context)
    simulation.push((0.0, 0.0, 1.0), duration=1.0)
    simulation.push((0.0, 0.0, 1.0), duration=1.0, start=0.5)
    v = velocities_after(simulation, 0.1).copy()
    assert simulation.clear_pushes() == 2
    assert np.array_equal(velocities_after(simulation, 1.0), v)


@pytest.mark.parametrize(('changed', 'message'), [
    ({'region': 'sphere', 'center': (9.0, 0.0, 0.0), 'radius': 0.1},
     r'no free node lies in the region of the push \(a sphere of 0.1 m around \(9, 0, 0\)\)'),
    ({'duration': -1.0}, 'the duration of a push'),
    ({'force': (float('nan'), 0.0, 0.0)}, 'the force of a push'),
    ({'start': -1.0}, 'the start of a push'),
    ({'force': (0.0, 0.0, 1e31)}, 'must be at most 1e[+]30 N along each axis'),
])
def test_a_refused_push_leaves_nothing_behind(context, changed: dict, message: str):
    """Half a push would act on."""
    simulation = Simulation(Scene(_FREE), context=context)
    with pytest.raises(ClothSimError, match=message):
        simulation.push(**{'force': (0.0, 0.0, 1.0), 'duration': 0.1, **changed})
    assert simulation.pushes == ()
    assert not velocities_after(simulation, 0.1).any()


def test_a_push_in_the_past_is_refused(context):
    """It would be accepted and give less than the impulse it answers with."""
    simulation = Simulation(Scene(_FREE), context=context)
    simulation.advance(1.0)
    with pytest.raises(ClothSimError, match='the start of the push, 0.5 s, is in the past'):
        simulation.push((0.0, 0.0, 1.0), duration=1.0, start=0.5)


def test_many_pushes_on_spheres_add_up(context):
    """One push too many would be lost, or overwrite another's nodes."""
    simulation = Simulation(Scene(_FREE), context=context)
    for begin in range(40):
        simulation.push((0.0, 0.0, 0.1), duration=0.1, start=0.001 * begin, **_CORNER)
    v = velocities_after(simulation, 0.2)
    assert simulation.scene.node_mass * v.sum() == pytest.approx(0.4, rel=1e-5)


@pytest.mark.parametrize('look', [False, True])
@pytest.mark.parametrize('region', [_CORNER, {}])
def test_looking_does_not_begin_a_push(context, look: bool, region: dict):
    """A frame published before a push begins would settle its nodes too early."""
    simulation = Simulation(Scene(_FREE), context=context)
    simulation.push((0.0, 0.0, 1.0), duration=0.1, start=0.105, **region)
    simulation.step(10)
    if look:
        assert not np.any(simulation.snapshot().flags & 4)
    simulation.pin(5, 4)
    v = velocities_after(simulation, 0.3)
    assert simulation.scene.node_mass * v.sum() == pytest.approx(0.1, rel=1e-5)


def test_a_push_that_finds_no_node_marks_none(context):
    """The whole cloth would be shown as pushed."""
    simulation = Simulation(Scene(_FREE), context=context)
    simulation.push((0.0, 0.0, 1.0), duration=0.5, start=0.05, region='sphere',
                    center=(50.0, 0.0, 0.0), radius=0.1)
    assert not velocities_after(simulation, 0.1).any()
    assert not np.any(simulation.snapshot().flags & 4)


def test_a_push_for_later_finds_the_nodes_that_have_come(context):
    """A push would be refused because its sphere is empty now."""
    simulation = Simulation(Scene({**_FREE, 'gravity': [0.0, 0.0, -10.0]}), context=context)
    simulation.push((0.0, 0.0, 1.0), region='sphere', center=(0.0, 0.0, 0.0), radius=0.7,
                    duration=0.1, start=0.4)
    assert np.ptp(velocities_after(simulation, 0.6)[1:]) > 0.0


def test_an_acceleration_beyond_float32_is_refused(context):
    """The state would be infinite after one step."""
    simulation = Simulation(Scene({**_FREE, 'node_mass': 1e-12}), context=context)
    with pytest.raises(ClothSimError, match='would accelerate its 29 nodes by .* m/s2'):
        simulation.push((0.0, 0.0, 1e29), duration=0.1)
    assert simulation.pushes == ()


def test_a_pinned_cloth_has_nothing_to_push(context):
    """The force would be divided by no nodes at all."""
    simulation = Simulation(Scene({**_FREE, 'pins': ['all']}), context=context)
    with pytest.raises(ClothSimError, match=r'no free node .*\(the whole cloth\)'):
        simulation.push((0.0, 0.0, 1.0), duration=0.1)


def test_the_number_of_pushes_is_bounded(context):
    """A client that pushes again and again would slow the run down without end."""
    simulation = Simulation(Scene(_FREE), context=context)
    for _ in range(MOST_PUSHES):
        simulation.push((0.0, 0.0, 1e-3), duration=0.02)
    for start in (None, 1.0):
        with pytest.raises(ClothSimError, match='1000 pushes are active or scheduled.*clear them'):
            simulation.push((0.0, 0.0, 1e-3), duration=0.02, start=start)
    assert len(simulation.pushes) == MOST_PUSHES
    simulation.advance(0.1)
    assert simulation.push((0.0, 0.0, 1e-3), duration=0.02).nodes == 29


def test_a_scene_has_as_many_pushes_at_most(context):
    """The pushes of a scene would not be bounded."""
    count = MOST_PUSHES + 1
    with pytest.raises(ClothSimError, match='1000 pushes'):
        Simulation(Scene({
            **_FREE, 'pushes.start': [0.0] * count, 'pushes.duration': [1.0] * count,
            'pushes.force': [0.0] * 3 * count}), context=context)
