# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloth as an environment of gymnasium."""

from pathlib import Path
import re
import subprocess
import sys

from cloth_sim_ros import ClothSimError
from cloth_sim_ros import Scene
from cloth_sim_ros.gym import make_vec
from cut_scene import CUT
import gymnasium
import numpy as np
import pytest
from small_environment import SMALL


def test_the_programs_of_its_page_run(capsys):
    """The first programs of a user would fail."""
    page = Path(__file__).resolve().parents[2] / 'docs' / 'how_to' / 'gymnasium.md'
    text = page.read_text(encoding='utf-8')
    first, *parts, last = re.findall(r'```python\n(.*?)```', text, re.DOTALL)
    for program in (first, last):
        exec(program, {})
        assert capsys.readouterr().out in re.findall(r'```text\n(.*?)```', text, re.DOTALL)
    # Each of these is a part of a program that has made its scene and cloths.
    names = {
        'make_vec': make_vec, 'scene': {'rows': 8, 'cols': 16}, 'cloths': make_vec(2, SMALL),
        'seeds': [1, 2], 'mask': np.array([True, False])}
    for part in parts:
        exec(part, names)
        names['cloths'].close()
    assert len(parts) == 4 and names['cloths'].single_observation_space.shape == (4, 3)
    pushed = names['Pushed'](make_vec(
        2, {**SMALL, 'colliders.names': ['ball'], 'colliders.ball.size': [0.1]}))
    pushed.reset(seed=1)
    pushed.step((np.zeros((2, 2, 3), np.float32), np.array([(0.0, 1.0, 0.0), (0.0, 0.0, 0.0)])))
    balls = [view.colliders[0].position for view in pushed.unwrapped._cloths.views()]
    np.testing.assert_allclose(balls, [(0.0, 0.025, 0.0), (0.0, 0.0, 0.0)], atol=1e-12)
    pushed.close()


def test_it_is_made_by_name():
    """A configuration that names environments could not name this one."""
    environment = gymnasium.make('cloth_sim_ros/CarryCloth-v0', scene=SMALL)
    observation, info = environment.reset(seed=1)
    assert observation.shape == (6, 5, 3) and info['problem'] == ''
    environment.close()


def test_pins_go_where_the_action_says(make):
    """A policy would steer other pins, or in other units."""
    environment = make(speed=0.5, frame=0.1)
    start, _ = environment.reset(seed=0)
    assert environment.pins.tolist() == [[0, 0], [0, 4]]
    environment.step(np.array([[0.0, 0.0, 1.0], [-0.5, 0.0, 0.0]], np.float32))
    seen, *_, info = environment.step(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 0.0]], np.float32))
    np.testing.assert_allclose(seen[0, 0] - start[0, 0], (0.0, 0.05, 0.05), atol=1e-6)
    np.testing.assert_allclose(seen[0, 4] - start[0, 4], (-0.025, 0.0, 0.0), atol=1e-6)
    assert info['time'] == pytest.approx(0.2)


def test_the_reward_is_the_mean_distance_from_the_goal(make):
    """The reward would differ from the documented one."""
    environment = make(goal=(0.3, 0.0, 0.4), jitter=0.0)
    environment.reset()
    seen, reward, terminated, truncated, info = environment.step(np.zeros((2, 3), np.float32))
    # The cloth still hangs where it was, but for what its weight stretches it.
    assert reward == pytest.approx(-0.5, abs=0.02) and reward == -info['distance']
    assert not terminated and not truncated


def test_carried_to_the_goal_the_episode_terminates(make):
    """The task could not be solved."""
    environment = make(goal=(0.05, 0.0, 0.0), speed=0.1, frame=0.1, tolerance=0.03)
    environment.reset(seed=3)
    for _ in range(5):
        *_, terminated, truncated, info = environment.step(
            np.array([[1.0, 0.0, 0.0]] * 2, np.float32))
    for _ in range(100):
        *_, terminated, truncated, info = environment.step(np.zeros((2, 3), np.float32))
        if terminated:
            break
    assert terminated and info['distance'] <= 0.03 and not truncated


def test_a_seed_gives_the_same_bits_and_another_one_others(make):
    """A result could not be made again."""
    environment = make(observation='state')
    runs = []
    for seed in (7, 7, 8):
        first, _ = environment.reset(seed=seed)
        last, *_ = environment.step(np.full((2, 3), 0.5, np.float32))
        runs.append(np.stack([first, last]))
    np.testing.assert_array_equal(runs[0], runs[1])
    assert not np.array_equal(runs[0], runs[2])


def test_an_episode_begins_with_the_pins_in_their_places(make):
    """The cloth would be held elsewhere than the hands of a robot are."""
    environment = make(jitter=0.5)
    rest = Scene(SMALL).rest_positions()
    seen, _ = environment.reset(seed=4)
    away = np.linalg.norm(seen - rest, axis=-1)
    pins = tuple(environment.pins.T)
    assert away[pins].max() < 1e-6 < away[1:].min()


def test_a_lost_state_truncates_the_episode(make):
    """A blow-up would end the training with an exception, or go on in nonsense."""
    # A push by which a millionth of a gram is gone within a step.
    environment = make({
        **SMALL, 'node_mass': 1e-9, 'stiffness.structural': 1e-4, 'stiffness.shear': 1e-4,
        'stiffness.bend': 1e-4, 'damping.structural': 0.0, 'damping.shear': 0.0,
        'damping.bend': 0.0, 'pushes.start': [0.1], 'pushes.duration': [9.0],
        'pushes.force': [0.0, 0.0, 1e9]}, frame=0.05)
    environment.reset(seed=0)
    for _ in range(10):
        observation, reward, terminated, truncated, info = environment.step(
            np.zeros((2, 3), np.float32))
        assert np.isfinite(observation).all() and np.isfinite(reward)
        if truncated:
            break
    assert truncated and 'non-finite' in info['problem'] and not terminated
    assert environment.reset(seed=0)[1]['problem'] == ''


@pytest.mark.parametrize('options, said', [
    ({'scene': {**SMALL, 'pins': ['none']}}, 'has none: set pins'),
    ({'frame': 0.0}, 'frame must be above 0'),
    ({'speed': float('nan')}, 'speed must be above 0'), ({'jitter': 0.6}, 'from 0 to 0.5'),
    ({'goal': (0.0, 1.0)}, 'needs 3 numbers')])
def test_wrong_values_are_refused(make, options, said):
    """A mistake would show hours later, in what was learned."""
    with pytest.raises(ClothSimError, match=said):
        make(**options)


def test_wrong_actions_move_nothing(make):
    """A policy without bounds would tear the cloth apart."""
    environment = make()
    start, _ = environment.reset(seed=0)
    for action in (np.zeros((3, 3)), np.full((2, 3), 1.5), np.full((2, 3), np.nan)):
        with pytest.raises(ClothSimError, match='an action must be'):
            environment.step(action)
    np.testing.assert_array_equal(environment._look(), start)


def test_without_gymnasium_it_says_what_is_missing():
    """A user would be left with the name of a module and no way out."""
    start = 'import sys; sys.modules["gymnasium"] = None; import cloth_sim_ros.gym'
    done = subprocess.run([sys.executable, '-c', start], capture_output=True, text=True)
    assert done.returncode == 1
    assert 'pip install gymnasium' in done.stderr.splitlines()[-1]


def test_a_cut_cloth_is_carried(make):
    """A reward would be NaN, or an observation outside its space."""
    environment = make(
        {**CUT, 'pin_points.positions': (0.0, 0.17, 1.0)}, observation=['state', 'depth'])
    observation, info = environment.reset(seed=1)
    assert environment.observation_space.contains(observation)
    observation, reward, *_, info = environment.step(np.ones((1, 3), np.float32))
    assert environment.observation_space.contains(observation)
    assert np.isfinite(reward) and info['problem'] == ''
