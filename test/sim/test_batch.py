# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Many cloths step together as each would by itself."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
import re

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.inventory import Inventory
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.batch import Batch
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cut_scene import CUT
import numpy as np
import pytest
from springs import SPRINGS

_SMALL = {'rows': 11, 'cols': 9, 'dt': 0.002, 'start.jitter': 0.05}
_PINS = (['top_left', 'top_right'], ['bottom_left'], ['top_edge'])
_BODIES = {
    'colliders.names': ['table', 'ball'], 'colliders.table.shape': 'plane',
    'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.3],
    'colliders.ball.position': [0.1, 0.0, 0.2], 'colliders.ball.friction': 0.6, 'start.z': 0.55}


def _scenes(values: dict, unlike: tuple[dict, ...] = ({},)) -> list[Scene]:
    return [
        Scene({
            **_SMALL, 'start.seed': number, 'pins': _PINS[number % 3],
            'start.pose': ('horizontal', 'hanging')[number % 2], **values,
            **unlike[number % len(unlike)]})
        for number in range(5)]


@pytest.fixture
def batch() -> Iterator[Batch]:
    """Give two small cloths of springs."""
    with Batch(Scene({**_SMALL, **SPRINGS}), 2) as batch:
        yield batch


@pytest.mark.parametrize('values, unlike', [
    (SPRINGS, ({},)), ({}, ({},)),
    (SPRINGS, ({'stiffness.structural': 50.0}, {'areal_density': 0.4})),
    ({**SPRINGS, 'bending.rigidity': 1e-4, 'bending.damping': 0.01}, ({},)),
    ({**SPRINGS, 'loads': 'storage', 'block': 1}, ({},)), ({**SPRINGS, **_BODIES}, ({},)),
    (_BODIES, ({}, {'colliders.ball.size': [0.2]}))],
    ids=['springs', 'fabric in air', 'unlike', 'damped bending', 'layout of a GPU', 'colliders',
         'unlike colliders'])
def test_each_cloth_has_the_bits_of_its_own_run(values, unlike):
    """A policy would be trained on another cloth than it is tried on."""
    scenes = _scenes(values, unlike)
    numbers = np.arange(len(scenes))
    nodes = np.array([np.argwhere(scene.pinned_nodes())[0] for scene in scenes])
    ways = np.random.default_rng(1).uniform(-0.1, 0.1, (len(scenes), 3))
    with ExitStack() as stack:
        batch = stack.enter_context(Batch(scenes))
        alone = [stack.enter_context(Simulation(scene)) for scene in scenes]
        # Moves begin, are replaced on their way, and arrive within a step.
        for steps, speed in ((50, None), (30, 0.7), (40, 0.31), (200, None)):
            if speed:
                targets = batch.positions()[numbers, nodes[:, 0], nodes[:, 1]] + ways
                batch.move_pins(numbers, nodes, targets, speed)
                for simulation, (row, col), target in zip(alone, nodes.tolist(), targets):
                    simulation.move_pin(row, col, target.tolist(), speed=speed)
            batch.step(steps)
            for simulation in alone:
                simulation.step(steps)
            np.testing.assert_array_equal(
                batch.positions(), [simulation.positions() for simulation in alone])
            np.testing.assert_array_equal(
                batch.velocities(), [simulation.velocities() for simulation in alone])
        assert np.abs(batch.velocities()).max() > 0.1 and not batch.lost.any()
        touching = sum(
            force.sticking + force.sliding for each in alone for force in each.contact_forces())
        assert (touching > 0) == ('colliders.names' in values)


# A ball and a board that come from below and from the side, and bodies of each shape.
_PUSHERS = {**_BODIES, 'colliders.names': ['table', 'ball', 'board'],
            'colliders.board.shape': 'box', 'colliders.board.size': [0.3, 0.25, 0.4],
            'colliders.board.position': [0.8, 0.0, 0.4]}
_MANY = {**_PUSHERS, 'colliders.names': ['table', 'ball', 'board', 'stick', 'drum'],
         'colliders.stick.shape': 'capsule', 'colliders.stick.size': [0.15, 0.8],
         'colliders.stick.position': [-0.7, 0.0, 0.6],
         'colliders.drum.shape': 'cylinder', 'colliders.drum.size': [0.2, 0.3],
         'colliders.drum.position': [0.0, 0.9, 0.5]}


def _assert_same(batch: Batch, alone: list[Simulation]) -> None:
    np.testing.assert_array_equal(
        batch.positions(), [simulation.positions() for simulation in alone])
    np.testing.assert_array_equal(
        batch.velocities(), [simulation.velocities() for simulation in alone])
    for number, simulation in enumerate(alone):
        assert batch.cloth(number).colliders == simulation.colliders


@pytest.mark.parametrize('values', [
    {**SPRINGS, **_BODIES}, {**SPRINGS, **_PUSHERS}, {**SPRINGS, **_MANY}, _BODIES,
    {**SPRINGS, **_PUSHERS, 'loads': 'storage', 'block': 1}, {**SPRINGS, **_PUSHERS, 'dt': 5e-5}],
    ids=['ball', 'board', 'many', 'fabric in air', 'layout of a GPU', 'short steps'])
def test_moved_bodies_push_as_in_single_runs(values: dict):
    """A policy that pushes with a stick would push another cloth than it is tried on."""
    scenes = _scenes(values)
    random = np.random.default_rng(2)
    names = values['colliders.names']
    with ExitStack() as stack:
        batch = stack.enter_context(Batch(scenes))
        alone = [stack.enter_context(Simulation(scene)) for scene in scenes]
        touching = 0
        # Moves begin after some steps, are replaced on their way, arrive within a step, and rest.
        for round_, steps in enumerate((30, 40, 25, 60, 150)):
            moved = [[], range(5), [0, 2, 4], [1, 2], []][round_]
            name = names[-1 - round_ % (len(names) - 1)]
            targets = random.uniform((-0.3, -0.3, 0.3), (0.3, 0.3, 0.7), (len(moved), 3))
            turned = random.normal(size=(len(moved), 4)) if round_ != 2 else None
            speeds = random.uniform(1.0, 5.0, len(moved))
            if len(moved):
                paths = batch.move_collider(moved, name, targets, turned, speeds, 4.0)
            for place, cloth in enumerate(moved):
                path = alone[cloth].move_collider(
                    name, targets[place], None if turned is None else turned[place],
                    float(speeds[place]), 4.0)
                assert paths[place].arrival == path.arrival
            for part in (1, steps):
                batch.step(part)
                for simulation in alone:
                    simulation.step(part)
                _assert_same(batch, alone)
            touching += sum(
                force.sticking + force.sliding for each in alone for force in each.contact_forces()
                if force.name == name)
            if round_ == 2:
                # One begins anew, and the state of another is replaced while its body goes on.
                batch.reset([2])
                alone[2].reset()
                state = alone[1].positions(), alone[1].velocities()
                batch.set_state(*(each[None] for each in state), [4])
                alone[4].set_state(*state)
        assert touching and not batch.lost.any()


def test_a_moved_floor_carries_as_in_single_runs():
    """A cloth on a moving belt would slip where it sticks."""
    scenes = _scenes({
        **SPRINGS, 'pins': ['none'], 'start.pose': 'horizontal', 'start.z': 0.01,
        'colliders.names': ['table'], 'colliders.table.shape': 'plane'})[:3]
    with ExitStack() as stack:
        batch = stack.enter_context(Batch(scenes))
        alone = [stack.enter_context(Simulation(scene)) for scene in scenes]
        batch.step(100)
        start = batch.positions()[..., 0].mean(axis=(1, 2))
        batch.move_collider([0, 2], 'table', [(0.3, 0.0, 0.0), (-0.3, 0.0, 0.1)], None, [0.2, 0.1])
        for simulation in alone:
            simulation.step(100)
        alone[0].move_collider('table', (0.3, 0.0, 0.0), speed=0.2)
        alone[2].move_collider('table', (-0.3, 0.0, 0.1), speed=0.1)
        batch.step(400)
        for simulation in alone:
            simulation.step(400)
        _assert_same(batch, alone)
        carried = batch.positions()[..., 0].mean(axis=(1, 2)) - start
        # In 0.8 s, of which the cloth slips for the first hundredths.
        np.testing.assert_allclose(carried, (0.16, 0.0, -0.075), atol=0.01)


def test_timed_moves_of_bodies_as_in_single_runs():
    """A scene whose ball comes by itself would be refused, or the ball be late after a reset."""
    timed = tuple({
        'collider_moves.start': [start, 0.3], 'collider_moves.name': ['ball', 'ball'],
        'collider_moves.target': [0.0, 0.1, 0.6, 0.2, 0.0, 0.1],
        'collider_moves.speed': [3.0, 1.0]} for start in (0.0, 0.1, 0.1234))
    scenes = _scenes({**SPRINGS, **_BODIES}, (*timed, {}))
    with ExitStack() as stack:
        batch = stack.enter_context(Batch(scenes))
        assert len(batch._stacks) == 1
        alone = [stack.enter_context(Simulation(scene)) for scene in scenes]
        for steps in (49, 1, 13, 90, 60, 300):
            batch.step(steps)
            for simulation in alone:
                simulation.step(steps)
            _assert_same(batch, alone)
            if steps == 13:
                batch.reset([1, 3])
                alone[1].reset()
                alone[3].reset()
        assert [batch.cloth(number).colliders[1].position for number in range(5)] == [
            (0.1, 0.0, 0.2) if number == 3 else (0.2, 0.0, 0.1) for number in range(5)]


def test_nothing_is_compiled_for_bodies_at_rest():
    """A batch whose bodies never move would pay for what moves them."""
    scene = Scene({**_SMALL, **SPRINGS, **_BODIES})

    def own(inventory: Inventory) -> list[str]:
        return [program.name for program in inventory.programs
                if program.source.used_defines.get('OWN_BODIES')]

    with take_inventory() as inventory, Batch(scene, 2) as batch:
        batch.step(100)
        assert own(inventory) == []
        count, held = len(inventory.programs), inventory.buffer_bytes
        batch.move_collider([0], 'ball', [(0.0, 0.0, 0.5)])
        batch.step(100)
        assert sorted(own(inventory)) == [
            'contact.comp', 'mass_spring_step.comp', 'near_nodes.comp']
        assert len(inventory.programs) == count + 3
        # Eight vectors of 16 bytes for each of two bodies of two cloths.
        assert inventory.buffer_bytes == held + 2 * 2 * 8 * 16


@pytest.mark.parametrize('change, rule', [
    ({'name': 'bal'}, "there is no collider 'bal': give one of those of the scene, table, ball"),
    ({'cloths': [0, 2]}, 'no cloth 2'), ({'cloths': [1, 1]}, 'a cloth is given twice'),
    ({'targets': [(0.0, 0.0, 0.5), (0.0, np.nan, 0.5)]}, 'the target of ball must be 3 finite'),
    ({'targets': [(0.0, 0.0, 0.5)]}, r'targets must be \(2, 3\)'),
    ({'speeds': [1.0, 0.0]}, 'the speed of ball must be from 1e-06 to 1000 m/s, got 0.0 m/s'),
    ({'speeds': -1.0}, 'the speed of ball must be from'),
    ({'angular_speeds': [1.0]}, r'angular_speeds must be \(2,\) numbers'),
    ({'orientations': [(0.0, 0.0, 0.0, 1.0), (0.0,) * 4]}, 'has no direction'),
    ({'durations': [0.1, -0.1]}, 'must be 0 s or more')])
def test_a_bad_move_of_a_body_moves_none(change: dict, rule: str):
    """A wrong action would move the bodies of some of the cloths."""
    given = {'cloths': [0, 1], 'name': 'ball', 'targets': [(0.0, 0.0, 0.5)] * 2}
    with Batch(Scene({**_SMALL, **SPRINGS, **_BODIES}), 2) as batch:
        with pytest.raises(ClothSimError, match=rule):
            batch.move_collider(**{**given, **change})
        batch.step(5)
        for number in range(2):
            assert batch.cloth(number).colliders == batch.scenes[number].colliders
    with Batch(Scene({**_SMALL, **SPRINGS}), 2) as batch:
        with pytest.raises(ClothSimError, match='one of those of the scene, none'):
            batch.move_collider(**given)


def test_too_many_bodies_for_the_device_are_refused():
    """Bodies of the last cloths would be anywhere."""
    with Batch(Scene({**_SMALL, **SPRINGS, **_BODIES, 'loads': 'texture'}), 3) as batch:
        batch._stacks[0]._most_texels = 3 * 2 * 8 - 1
        with pytest.raises(DeviceError, match='3 cloths with 2 bodies that move need 48 texels'):
            batch.move_collider([0], 'ball', [(0.0, 0.0, 0.5)])
        batch.step(5)
        assert batch.cloth(0).colliders == batch.scenes[0].colliders
        batch._stacks[0]._most_texels += 1
        batch.move_collider([0], 'ball', [(0.0, 0.0, 0.5)])


def test_a_lost_cloth_leaves_the_others_alone():
    """One episode that blows up would end the training, or spoil its neighbours."""
    scene = Scene({**_SMALL, **SPRINGS, 'pins': ['none']})
    with Batch(scene, 3) as batch, Simulation(scene) as alone:
        start = batch.positions()
        # Its square overflows float32; NaN then spreads along springs.
        far = np.where(np.arange(9)[None, :, None] % 2, 9e11, -9e11) + 0.0 * start[0]
        batch.set_state(far[None], np.full_like(far, 9e11)[None], [1])
        for _ in range(3):
            batch.step(200)
            alone.step(200)
        for neighbour in (0, 2):
            np.testing.assert_array_equal(batch.positions()[neighbour], alone.positions())
        assert batch.lost.tolist() == [False, True, False]
        assert np.all(np.isfinite(batch.positions()))
        batch.reset([1])
        assert not batch.lost.any()
        np.testing.assert_array_equal(batch.positions()[1], start[1])


def test_reset_begins_one_cloth_anew(batch: Batch):
    """An episode would begin where another one ended, or end others."""
    start = batch.positions()
    batch.move_pins([0, 1], [(0, 0), (0, 0)], start[:, 0, 0] + (0.1, 0.0, 0.0), 0.05)
    batch.step(100)
    there = batch.positions()
    batch.reset([1])
    np.testing.assert_array_equal(batch.positions(), [there[0], start[1]])
    batch.step(100)
    moved = batch.positions()[:, 0, 0] - start[:, 0, 0]
    np.testing.assert_allclose(moved, [(0.02, 0.0, 0.0), (0.0, 0.0, 0.0)], atol=1e-6)
    assert batch.time == pytest.approx(0.4)
    np.testing.assert_allclose(batch.times, (0.4, 0.2))


def test_a_reset_cloth_has_the_bits_of_its_own_run(batch: Batch):
    """An episode would have other bits for what was done in those before."""
    with Simulation(batch.scenes[0]) as alone:
        target = alone.positions()[0, 0] + np.float32([0.03, 0.01, 0.07])
        batch.step(137)
        batch.reset([1])
        batch.move_pins([1], [(0, 0)], [target], 0.313)
        alone.move_pin(0, 0, target.tolist(), speed=0.313)
        for steps in (40, 90):
            batch.step(steps)
            alone.step(steps)
            np.testing.assert_array_equal(batch.positions()[1], alone.positions())
            np.testing.assert_array_equal(batch.velocities()[1], alone.velocities())
        assert batch.times[1] == alone.time


def test_pinned_and_released_nodes_as_in_a_single_run(batch: Batch):
    """A gripper would hold another cloth than the one it closes on."""
    held, free = np.array([(5, 4), (5, 5)]), (0, 8)
    with Simulation(batch.scenes[0]) as alone:
        def step_both() -> None:
            batch.step(40)
            alone.step(40)
            np.testing.assert_array_equal(batch.positions()[1], alone.positions())
            np.testing.assert_array_equal(batch.velocities()[1], alone.velocities())

        step_both()
        batch.pin([1, 1], held)
        batch.release([1], [free])
        alone.release(*free)
        target = alone.positions()[5, 4] + np.float32([0.0, 0.05, 0.2])
        for row, col in held.tolist():
            alone.pin(row, col)
        batch.move_pins([1], held[:1], [target], 0.5)
        alone.move_pin(5, 4, target.tolist(), speed=0.5)
        step_both()
        # One stops on its way, the other is let go with its velocity.
        batch.pin([1], held[:1])
        alone.pin(5, 4)
        step_both()
        batch.move_pins([1], held[1:], [target], 0.5)
        alone.move_pin(5, 5, target.tolist(), speed=0.5)
        step_both()
        batch.release([1], held[1:])
        alone.release(5, 5)
        step_both()
        np.testing.assert_array_equal(batch.pinned_nodes(1), alone.pinned_nodes())
        assert batch.pinned_nodes(0)[free] and not batch.pinned_nodes(0)[5, 4]


@pytest.mark.parametrize('scenes', [
    [Scene({**_SMALL, **SPRINGS})] * 2,
    [Scene({**CUT, 'pin_points.positions': (0.0, 0.17, 1.0), 'shape.disc': disc})
     for disc in (0.37, 0.3)]], ids=['sheets', 'discs'])
def test_strains_are_those_of_single_runs(scenes):
    """A penalty on stretch would be that of another cloth."""
    with Batch(scenes) as batch, Simulation(scenes[1]) as alone:
        batch.step(60)
        alone.step(60)
        assert batch.max_strains()[1] == pytest.approx(alone.measure().max_strain, rel=1e-5)
        assert batch.max_strains()[1] > 1e-4


def test_a_camera_sees_one_cloth_of_a_batch():
    """A policy would look at its neighbour."""
    camera = {'position': [0.0, -2.0, 1.0], 'target': [0.0, 0.0, 0.8], 'width': 40, 'height': 30}
    scenes = _scenes({**SPRINGS, **_BODIES})[:3]
    with Batch(scenes) as batch, Camera(**camera) as of_batch:
        batch.move_collider([1], 'ball', [(0.3, 0.0, 0.4)], speeds=4.0)
        batch.step(50)
        for number, scene in enumerate(scenes):
            seen = of_batch.capture(batch.cloth(number))
            with Simulation(scene) as alone, Camera(**camera) as of_one:
                if number == 1:
                    alone.move_collider('ball', (0.3, 0.0, 0.4), speed=4.0)
                alone.step(50)
                expected = of_one.capture(alone)
            assert seen.time == expected.time and seen.label_names == expected.label_names
            for part in ('color', 'depth', 'labels', 'normals', 'visible'):
                np.testing.assert_array_equal(getattr(seen, part), getattr(expected, part))


@pytest.mark.parametrize('change, rule', [
    ({'mode': 'constraint'}, 'mass_spring'), ({'layout': 'paper'}, 'fused'),
    ({'colliders.names': ['a'], 'colliders.a.shape': 'sphere', 'colliders.a.size': [0.01]},
     'collider a is thinner'),
    ({'grasps.start': [0.0], 'grasps.name': ['a'], 'grasps.position': [0.0, 0.0, 0.0]}, 'timed'),
    ({'pin.max_force': 1.0}, 'pin.max_force is 1 N: set it to 0'),
    ({'self_contact.enabled': True}, 'set it to false'),
    ({'pushes.start': [0.0], 'pushes.duration': [1.0], 'pushes.force': [0.0, 0.0, 1.0]}, 'timed')])
def test_what_no_batch_can_do_is_refused(change, rule):
    """A user would get cloths that lack what their scene asks for."""
    with pytest.raises(ClothSimError, match=rule):
        Batch(Scene({**_SMALL, **SPRINGS, **change}), 2)


def test_cloths_of_unlike_sizes_are_refused():
    """Their positions would fit into no array."""
    scenes = [Scene({**_SMALL, **SPRINGS, 'rows': rows}) for rows in (5, 6)]
    with pytest.raises(ClothSimError, match='the same rows, got 5 and 6'):
        Batch(scenes)
    with pytest.raises(ClothSimError, match='count of 1 or more'):
        Batch(scenes[0], 0)


@pytest.mark.parametrize('cloths, nodes, targets, speed, rule', [
    ([2], [(0, 0)], [(0.0, 0.0, 0.0)], 1.0, 'no cloth 2'),
    ([0], [(1, 0)], [(0.0, 0.0, 0.0)], 1.0, r'node \(1, 0\) of cloth 0 is free'),
    ([0], [(11, 0)], [(0.0, 0.0, 0.0)], 1.0, 'there is no node'),
    ([0], [(0, 0)], [(0.0, np.nan, 0.0)], 1.0, '3 finite numbers'),
    ([0], [(0, 0)], [(0.0, 0.0, 0.0)], 0.0, 'speed of a pin'),
    ([0], [(0, 0)], [(0.0, 0.0)], 1.0, r'targets must be \(2, 3\)'),
    ([0, 0], [(0, 0), (0, 0)], [(0.0, 0.0, 0.0)] * 2, 1.0, 'given twice')])
def test_a_bad_move_changes_nothing(batch: Batch, cloths, nodes, targets, speed, rule):
    """A wrong action would move some of the pins."""
    before = batch.positions()
    with pytest.raises(ClothSimError, match=rule):
        batch.move_pins([1, *cloths], [(0, 8), *nodes], [(9.0, 9.0, 9.0)[:len(targets[0])],
                                                         *targets], speed)
    batch.step(5)
    np.testing.assert_array_equal(batch.positions()[:, 0, 8], before[:, 0, 8])


@pytest.mark.parametrize('cloths, nodes, rule', [
    ([0, 2], [(0, 0), (0, 0)], 'no cloth 2'), ([0, 1], [(0, 0), (11, 0)], 'there is no node'),
    ([0, 1], [(0, 0)], r'need \(2, 2\) nodes'), ([0, 1], [(0, 0), (0.0, 0.5)], 'whole numbers')])
def test_bad_nodes_are_neither_pinned_nor_released(batch: Batch, cloths, nodes, rule):
    """A wrong number would change some of the pins."""
    before = [batch.pinned_nodes(number) for number in range(2)]
    for change in (batch.pin, batch.release):
        with pytest.raises(ClothSimError, match=rule):
            change(cloths, nodes)
    np.testing.assert_array_equal([batch.pinned_nodes(number) for number in range(2)], before)


def test_a_bad_state_is_refused(batch: Batch):
    """A cloth would be lost at once, or stand in another one's place."""
    positions = batch.positions()
    for bad, rule in (
            (positions[:1], 'give one state for each cloth'),
            (np.full_like(positions, np.nan), 'numbers below 1e+12, got up to nan')):
        with pytest.raises(ClothSimError, match=re.escape(rule)):
            batch.set_state(bad, np.zeros_like(positions))
    np.testing.assert_array_equal(batch.positions(), positions)


def test_a_closed_batch_can_be_closed_again():
    """A block within a block would end with an error."""
    with Batch(Scene({**_SMALL, **SPRINGS})) as batch:
        batch.close()


def test_the_programs_of_its_page_run(capsys):
    """The first program of a user would fail."""
    page = Path(__file__).resolve().parents[2] / 'docs' / 'how_to' / 'many_cloths.md'
    for program in re.findall(r'```python\n(.*?)```', page.read_text(encoding='utf-8'), re.DOTALL):
        exec(program, {})
    assert capsys.readouterr().out == '(64, 16, 16, 3) False\n(0.0, -0.1, 0.6)\n'


def test_cut_cloths_step_as_each_by_itself():
    """Cloths of a batch would have the shape of another, or be lost for their NaN."""
    scenes = [Scene({**CUT, 'shape.disc': disc}) for disc in (0.37, 0.3, 0.37)]
    with Batch(scenes) as batch:
        batch.step(20)
        batch.set_state(batch.positions()[1:2], batch.velocities()[1:2], [1])
        found = batch.positions()
        assert not batch.lost.any()
    for scene, positions in zip(scenes, found):
        with Simulation(scene) as simulation:
            simulation.step(20)
            np.testing.assert_array_equal(positions, simulation.positions())
