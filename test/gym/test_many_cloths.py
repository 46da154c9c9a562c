# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Many environments whose cloths step together."""

import warnings

from cloth_sim_ros import ClothSimError
from cloth_sim_ros.gym import CarryCloth
from cloth_sim_ros.gym import CarryCloths
from cut_scene import CUT
import gymnasium
from gymnasium.utils.env_checker import data_equivalence
from gymnasium.vector import AutoresetMode
from gymnasium.vector import SyncVectorEnv
from gymnasium.vector.utils import batch_space
from gymnasium.wrappers import TimeLimit
from gymnasium.wrappers.vector import NormalizeObservation
from gymnasium.wrappers.vector import RecordEpisodeStatistics
import numpy as np
import pytest
from small_environment import SMALL

NEAR = {'goal': (0.05, 0.0, 0.0), 'speed': 0.1, 'frame': 0.1, 'tolerance': 0.03}
TABLE = {
    **SMALL, 'start.pose': 'horizontal', 'start.z': 0.02, 'colliders.names': ['table'],
    'colliders.table.shape': 'plane', 'colliders.table.friction': 0.5}


def one_by_one(count, scene=SMALL, *, max_steps, **options):
    """Return the same environments, each with a Simulation of its own, by gymnasium."""
    def make():
        return TimeLimit(CarryCloth(scene, **options), max_steps)

    return SyncVectorEnv([make] * count)


@pytest.mark.parametrize('scene, options', [
    (SMALL, {**NEAR, 'observation': 'state'}), (TABLE, {'jitter': 0.3, 'observation': 'state'}),
    ({**CUT, 'pins': ['none']}, {'hands': [[(6, 0), (6, 1)], [(6, 13)]]}),
    (SMALL, {'observation': ['depth', 'positions'], 'picture_size': (24, 32)})],
    ids=['carry', 'table', 'cut with hands', 'depth'])
def test_each_has_the_numbers_of_one_alone(make_many, scene, options):
    """A policy would be trained on another task than it is tried on."""
    many, alone = make_many(3, scene, max_steps=7, **options), one_by_one(
        3, scene, max_steps=7, **options)
    assert many.single_action_space == alone.single_action_space
    assert many.single_observation_space == alone.single_observation_space
    assert many.action_space == alone.action_space
    assert many.observation_space == alone.observation_space
    many.action_space.seed(1)
    ends = 0
    found, expected = many.reset(seed=5), alone.reset(seed=5)
    for step in range(20):
        assert data_equivalence(found[0], expected[0], exact=True), step
        for each, other in zip(found[1:-1], expected[1:-1]):
            np.testing.assert_array_equal(each, other)
            assert each.dtype == other.dtype
        infos, others = found[-1], expected[-1]
        # It is measured on the device where one cloth is alone, in float32.
        np.testing.assert_allclose(
            infos.pop('max_strain'), others.pop('max_strain'), rtol=1e-4, atol=1e-6)
        assert data_equivalence(infos, others, exact=True), step
        actions = many.action_space.sample()
        actions[0] = (0.5, 0.0, 0.0)
        found, expected = many.step(actions), alone.step(actions)
        ends += np.count_nonzero(found[2] | found[3])
    assert ends >= 6
    alone.close()


def test_gymnasium_makes_them_by_name():
    """A configuration that names environments could not name these."""
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        many = gymnasium.make_vec('cloth_sim_ros/CarryCloth-v0', num_envs=3, scene=SMALL)
    assert isinstance(many.unwrapped, CarryCloths) and many.num_envs == 3
    assert many.metadata['autoreset_mode'] is AutoresetMode.NEXT_STEP
    assert many.observation_space == batch_space(many.single_observation_space, 3)
    many.close()
    many = gymnasium.make_vec(
        'cloth_sim_ros/CarryCloth-v0', num_envs=2, scene=SMALL, max_episode_steps=1)
    many.reset(seed=1)
    assert many.step(np.zeros((2, 2, 3), np.float32))[3].all()
    many.close()


def test_a_mode_that_does_not_batch_has_a_way_out(make_many):
    """A user of other modes would be turned away."""
    scene = {**SMALL, 'mode': 'constraint'}
    with pytest.raises(ClothSimError, match='mode mass_spring, got constraint: .* by itself'):
        make_many(2, scene)
    many = gymnasium.make_vec(
        'cloth_sim_ros/CarryCloth-v0', num_envs=2, vectorization_mode='sync', scene=scene)
    many.reset(seed=1)
    observations, *_ = many.step(np.ones((2, 2, 3), np.float32))
    assert observations.shape == (2, 6, 5, 3)
    many.close()


def test_observations_and_rewards_lie_in_their_spaces(make_many):
    """A library would refuse them, or learn from values outside its bounds."""
    many = make_many(2, observation=['state', 'depth'], picture_size=(8, 12))
    observations, infos = many.reset(seed=[3, 4])
    for _ in range(3):
        assert many.observation_space.contains(observations)
        observations, rewards, terminations, truncations, infos = many.step(
            many.action_space.sample())
        assert rewards.shape == terminations.shape == truncations.shape == (2,)
        assert rewards.dtype == np.float64 and terminations.dtype == truncations.dtype == bool
        assert infos['distance'].shape == infos['time'].shape == (2,)


def test_wrappers_of_gymnasium_take_them(make_many):
    """Returns of episodes would have to be summed by hand."""
    many = NormalizeObservation(RecordEpisodeStatistics(make_many(2, max_steps=4)))
    many.reset(seed=1)
    total = np.zeros(2)
    for _ in range(4):
        _, rewards, _, truncations, infos = many.step(np.zeros((2, 2, 3), np.float32))
        total += rewards
    assert truncations.all()
    np.testing.assert_allclose(infos['episode']['r'], total, rtol=1e-6)
    np.testing.assert_array_equal(infos['episode']['l'], 4)


def test_an_ended_episode_begins_anew_with_the_next_action(make_many):
    """A library would mistake the first observation of an episode for the last of another."""
    many = make_many(2, max_steps=2, jitter=0.4)
    first, _ = many.reset(seed=9)
    actions = np.ones((2, 2, 3), np.float32)
    many.step(actions)
    *_, truncations, infos = many.step(actions)
    assert truncations.all() and infos['time'] == pytest.approx(0.1)
    again, rewards, terminations, truncations, infos = many.step(actions)
    assert not (rewards.any() or terminations.any() or truncations.any() or infos['time'].any())
    # The pins are where they were, other nodes have the next random offsets.
    np.testing.assert_array_equal(again[:, 0, 0], first[:, 0, 0])
    assert not np.array_equal(again, first)
    _, rewards, *_, infos = many.step(actions)
    assert rewards.all() and infos['time'] == pytest.approx(0.05)


def test_a_mask_resets_some_to_the_start_of_their_seeds(make_many):
    """One episode could not be begun anew without all of them."""
    many = make_many(3, jitter=0.3)
    first, _ = many.reset(seed=[4, 5, 6])
    assert many.np_random_seed == (4, 5, 6)
    there, *_ = many.step(np.ones((3, 2, 3), np.float32))
    seen, infos = many.reset(
        seed=[None, 5, None], options={'reset_mask': np.array([False, True, False])})
    np.testing.assert_array_equal(seen, [there[0], first[1], there[2]])
    np.testing.assert_allclose(infos['time'], (0.05, 0.0, 0.05))


def test_a_moved_body_pushes_as_it_does_one_alone(make_many):
    """A policy would be hindered by another body than in a trial, or begin with it elsewhere."""
    scene = {**SMALL, 'colliders.names': ['ball'], 'colliders.ball.size': [0.12],
             'colliders.ball.position': [0.0, -0.3, 0.6]}
    options = {'goal': (0.0, 0.0, 0.1), 'observation': 'state'}
    many, alone = make_many(2, scene, max_steps=6, **options), one_by_one(
        2, scene, max_steps=6, **options)
    many.reset(seed=5)
    alone.reset(seed=5)
    actions = np.zeros((2, 2, 3), np.float32)
    for step in range(9):
        if step % 7 == 1:
            targets = [(0.0, 0.1, 0.5), (0.1, 0.0, 0.7)]
            many.move_collider([0, 1], 'ball', targets, speeds=1.0)
            for environment, target in zip(alone.envs, targets):
                environment.unwrapped.move_collider('ball', target, speed=1.0)
        found, expected = many.step(actions), alone.step(actions)
        for each, other in zip(found[:-1], expected[:-1]):
            np.testing.assert_array_equal(each, other)
        if step == 5:
            assert found[0][..., 3:].max() > 0.5 and found[3].all()


def test_a_lost_cloth_ends_its_episode_alone(make_many):
    """One blow-up would end the training, or go on in nonsense."""
    many = make_many(2, frame=0.05)
    many.reset(seed=1)
    batch = many.unwrapped._cloths.batch
    far = np.where(np.arange(5)[None, :, None] % 2, 9e11, -9e11) + np.zeros((6, 5, 3))
    batch.set_state(far[None], np.full_like(far, 9e11)[None], [1])
    actions = np.zeros((2, 2, 3), np.float32)
    observations, rewards, terminations, truncations, infos = many.step(actions)
    assert truncations.tolist() == [False, True] and not terminations.any()
    assert infos['problem'][0] == '' and 'non-finite' in infos['problem'][1]
    assert np.isfinite(observations).all() and np.isfinite(rewards).all()
    *_, infos = many.step(actions)
    assert infos['problem'].tolist() == ['', ''] and infos['time'] == pytest.approx((0.1, 0.0))


def test_wrong_actions_change_nothing(make_many):
    """Some of the cloths would move."""
    many = make_many(2)
    start, _ = many.reset(seed=0)
    bad = np.zeros((2, 2, 3))
    bad[1, 1] = np.nan
    for actions in (bad, np.zeros((2, 3)), np.zeros((3, 2, 3)), np.full((2, 2, 3), 1.5)):
        with pytest.raises(ClothSimError, match='an action must be') as error:
            many.step(actions)
        assert '\\n' not in str(error.value)
    np.testing.assert_array_equal(many.unwrapped._cloths.positions(), start)
    assert not many.unwrapped._cloths.times().any()


@pytest.mark.parametrize('options, said', [
    ({'num_envs': 0}, 'num_envs must be 1 or more, got 0: give more environments'),
    ({'num_envs': 2.0}, 'num_envs must be a whole number'),
    ({'num_envs': 10**9}, 'at most 1000000 cloths'),
    ({'max_steps': 0}, 'max_steps must be 1 or more'),
    ({'render_mode': 'human'}, 'rgb_array or None'),
    ({'scene': {**SMALL, 'self_contact.enabled': True}}, 'self_contact.enabled'),
    ({'scene': {**SMALL, 'pin.max_force': 2.0}}, 'pin.max_force')])
def test_wrong_values_are_refused(make_many, options, said):
    """A mistake would show hours later, in what was learned."""
    with pytest.raises(ClothSimError, match=said):
        make_many(**options)


def test_a_picture_of_each_cloth(make_many):
    """Somebody who looks would see the same cloth everywhere, or another one."""
    options = {'render_mode': 'rgb_array', 'render_size': (40, 60), 'goal': (0.4, 0.0, 0.0)}
    many, alone = make_many(2, speed=2.0, **options), CarryCloth(SMALL, speed=2.0, **options)
    assert many.metadata['render_fps'] == alone.metadata['render_fps'] == 20
    many.reset(seed=1)
    alone.reset(seed=1)
    for _ in range(4):
        many.step(np.array([[[1.0, 0.0, 0.0]] * 2, np.zeros((2, 3))], np.float32))
        alone.step(np.array([[1.0, 0.0, 0.0]] * 2, np.float32))
    pictures = many.render()
    assert [each.shape for each in pictures] == [(40, 60, 3)] * 2
    assert pictures[0].dtype == np.uint8 and np.ptp(pictures[0]) > 50
    np.testing.assert_array_equal(pictures[0], alone.render())
    assert np.mean(pictures[0] != pictures[1]) > 0.1
    alone.close()
    with pytest.raises(ClothSimError, match="render_mode='rgb_array'"):
        make_many(2).render()
