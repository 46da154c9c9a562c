# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Many cloths step together as each would by itself."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
import re

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
    ({**SPRINGS, 'loads': 'storage', 'block': 1}, ({},))],
    ids=['springs', 'fabric in air', 'unlike', 'damped bending', 'layout of a GPU'])
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


@pytest.mark.parametrize('change, rule', [
    ({'mode': 'constraint'}, 'mass_spring'), ({'layout': 'paper'}, 'fused'),
    ({'colliders.names': ['a'], 'colliders.a.shape': 'plane'}, 'no contact'),
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


def test_the_program_of_its_page_runs(capsys):
    """The first program of a user would fail."""
    page = Path(__file__).resolve().parents[2] / 'docs' / 'how_to' / 'many_cloths.md'
    (program,) = re.findall(r'```python\n(.*?)```', page.read_text(encoding='utf-8'), re.DOTALL)
    exec(program, {})
    assert capsys.readouterr().out == '(64, 16, 16, 3) False\n'


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
