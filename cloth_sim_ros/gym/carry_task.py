# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The task of carrying cloth: its start, what actions move, what is good, when it ends."""

from collections.abc import Mapping
from collections.abc import Sequence
from types import MappingProxyType
from typing import Any
from typing import NamedTuple

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gym.own_functions import asked
from cloth_sim_ros.gym.own_functions import checked_function
from cloth_sim_ros.gym.own_functions import OwnFunction
from cloth_sim_ros.sim.arguments import array
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import integers
from cloth_sim_ros.sim.arguments import iterable
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import vector_or_none
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pins import FARTHEST
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import checked_vectors
import numpy as np

_DEFAULT = {'rows': 16, 'cols': 16, 'width': 0.4, 'height': 0.4, 'start.pose': 'hanging'}
_NOTHING = 1e-9  # [m]
_LONGEST_FRAME = 1e6  # [s]; chosen: eleven days of simulated time are no action
_FASTEST = 1e6  # [m/s]; as of any pin, sim/model/pins.py
_GIVE_HANDS = 'give a list of nodes [row, col] for each hand'


class Moves(NamedTuple):
    """
    Pins that an action moves.

    :param cloths: place in the cloths asked for, of each, (m,) int
    :param nodes: row and col of each, (m, 2) int
    :param targets: (m, 3) [m]
    :param speeds: (m,) [m/s]
    """

    cloths: np.ndarray
    nodes: np.ndarray
    targets: np.ndarray
    speeds: np.ndarray


class Outcome(NamedTuple):
    """
    What a state of n cloths is worth.

    :param rewards: (n,) float64
    :param arrived: whether the goal is reached within the tolerance, (n,) bool
    :param distances: mean distance of the nodes from the goal [m], (n,); None without a goal
    """

    rewards: np.ndarray
    arrived: np.ndarray
    distances: np.ndarray | None


class CarryTask:
    """
    What environments of cloth ask, of one cloth or of many.

    An action is (hands, 3) from -1 to 1: along each axis, how fast a hand moves for a ``frame``,
    over ``speed``. Each pin of the scene is a hand, in the order of rows; or ``hands`` says which
    nodes each hand holds, and pins that no hand holds stay where they are.

    The reward is minus the mean distance of the nodes from where they would be if the start had
    been moved by ``goal``, or what ``reward`` returns. An episode terminates once that distance is
    within ``tolerance``; never, without a goal.

    ``jitter`` puts free nodes off their places by up to that share of the node spacing.

    :param scene: what is carried, a Scene or parameters by name
    :param goal: x y z [m], from the start; None for none, which needs a ``reward``
    :param frame: simulated time of an action [s], rounded to whole steps of dt
    :param speed: of a hand along each axis at an action of 1 [m/s]
    :param jitter: 0 to 0.5
    :param tolerance: mean distance that counts as there [m]
    :param hands: the nodes that each holds, a list of [row, col] for each hand; None for the pins
    :param start: where episodes begin, at rest, (rows, cols, 3) [m]; None for the pose of the
        scene without its jitter
    :param reward: a function of positions [m] and velocities [m/s] of n cloths, (n, rows, cols, 3)
        float32 each, NaN where a shape has no node, that returns n numbers; None for that above
    :param observation: positions, state or depth, a list of them, or a function of the same arrays
        that returns (n, ...) numbers, whose shape is that of the observations
    :param camera: azimuth, elevation and field_of_view [deg], zoom and target [m] of the camera of
        depth and of ``render``, by name; at zoom 1 it sees the whole cloth at its start and goal
    :param picture_size: height and width of the depth picture [pixel]
    :param render_size: height and width of the pictures of ``render`` [pixel]
    :raises ClothSimError: when the scene has no pin or a value is wrong
    """

    def __init__(
            self, scene: Scene | Mapping[str, Any] | None = None, *,
            goal: Sequence[float] | None = (0.2, 0.0, 0.1), frame: float = 0.05,
            speed: float = 0.5, jitter: float = 0.01, tolerance: float = 0.02,
            hands: Sequence[Sequence[Sequence[int]]] | None = None,
            start: np.ndarray | None = None, reward: OwnFunction | None = None,
            observation: str | Sequence[str] | OwnFunction = 'positions',
            camera: Mapping[str, Any] = MappingProxyType({}),
            picture_size: Sequence[int] = (64, 64),
            render_size: Sequence[int] = (240, 320)) -> None:
        """Check the values."""
        if not isinstance(scene, Scene):
            scene = Scene(_DEFAULT if scene is None else scene)
        self.scene = scene
        self.hands = _checked_hands(scene, hands)
        frame = _checked('frame', frame, _LONGEST_FRAME, 's')
        speed = _checked('speed', speed, _FASTEST, 'm/s')
        tolerance = real_number(tolerance, 'the tolerance', 'give a distance in metres')
        if not 0.0 <= tolerance <= FARTHEST:
            raise ClothSimError(
                f'the tolerance must be from 0 to {FARTHEST:g} m, got {tolerance}: give a '
                'distance')
        jitter = real_number(jitter, 'the jitter', 'give a share of the node spacing')
        if not 0.0 <= jitter <= 0.5:
            raise ClothSimError(
                f'the jitter must be from 0 to 0.5 of the node spacing, got {jitter}: give less')
        self.start = _checked_start(scene, start)
        self._present = scene.present_nodes
        self.goal = None if goal is None else self.start + _checked_goal(goal)
        self._reward = _checked_reward(reward, self.goal)
        self.steps = max(round(frame / scene['dt']), 1)
        self._seconds = self.steps * scene['dt']
        self._reach = speed * self._seconds
        self._jitter = jitter * min(length for length in scene.spacing if length > 0.0)
        self._tolerance = tolerance
        # The nodes of all hands one after the other, and the hand of each.
        self.held = np.concatenate(self.hands)
        self._hand_of = np.repeat(np.arange(len(self.hands)), [len(each) for each in self.hands])
        self._free = ~scene.pinned_nodes()
        self._free[tuple(self.held.T)] = False
        self.observation = observation
        self.camera = camera
        self.picture_size = picture_size
        self.render_size = render_size
        # A function of the user's would fail hours later in another shape.
        self.outcome(*self.at_start(2))

    @property
    def seen(self) -> np.ndarray:
        """Return what a camera should have in view: start and goal, (n, 3) [m]."""
        places = [self.start] if self.goal is None else [self.start, self.goal]
        return np.concatenate([each[self._present] for each in places])

    @property
    def frames_per_second(self) -> int:
        """Return how many actions there are in a second, rounded, 1 at least [1/s]."""
        return max(round(1.0 / self._seconds), 1)

    def at_start(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return positions and velocities of ``count`` cloths at the start, as functions get."""
        one = np.where(self._present[..., None], self.start, np.nan).astype(np.float32)
        positions = np.repeat(one[None], count, axis=0)
        return positions, 0.0 * positions

    def drawn_start(self, random: np.random.Generator) -> np.ndarray:
        """Return where an episode begins, with its random offsets, (rows, cols, 3) [m]."""
        offsets = random.uniform(-self._jitter, self._jitter, self.start.shape)
        return self.start + np.where(self._free[..., None], offsets, 0.0)

    def checked_actions(self, actions: np.ndarray, count: int | None = None) -> np.ndarray:
        """
        Return how far hands move in a frame, (n, hands, 3) [m].

        :param actions: (hands, 3) of one cloth; (count, hands, 3) where a ``count`` is given
        :raises ClothSimError: when it has another shape or a value outside its range
        """
        shape = (len(self.hands), 3) if count is None else (count, len(self.hands), 3)
        ways = array(actions, 'an action', shape, 'give x, y and z from -1 to 1 for each hand')
        # NaN fails this as well.
        if not np.all(np.abs(ways.astype(np.float32)) <= 1.0):
            raise ClothSimError(
                f'an action must be {shape} numbers from -1 to 1, got {ways.min():g} to '
                f'{ways.max():g}: clip it')
        return self._reach * ways.reshape(-1, len(self.hands), 3)

    def moves(self, ways: np.ndarray, positions: np.ndarray) -> Moves:
        """
        Return which pins to move, and where; those that stay are left out.

        :param ways: as ``checked_actions`` returns them, (n, hands, 3) [m]
        :param positions: of the cloths, (n, rows, cols, 3) [m]
        """
        lengths = np.linalg.norm(ways, axis=-1)
        cloths, places = np.nonzero(lengths[:, self._hand_of] > _NOTHING)
        nodes, hands = self.held[places], self._hand_of[places]
        here = positions[cloths, nodes[:, 0], nodes[:, 1]]
        return Moves(
            cloths, nodes, here + ways[cloths, hands], lengths[cloths, hands] / self._seconds)

    def outcome(self, positions: np.ndarray, velocities: np.ndarray) -> Outcome:
        """
        Return what the present state of n cloths is worth.

        :param positions: (n, rows, cols, 3) [m]
        :param velocities: (n, rows, cols, 3) [m/s]
        :raises ClothSimError: when the user's function returns something else than n numbers
        """
        count = len(positions)
        distances, arrived = None, np.zeros(count, dtype=bool)
        if self.goal is not None:
            away = np.linalg.norm(positions - self.goal, axis=-1)[:, self._present]
            distances = np.ascontiguousarray(away).mean(axis=-1)
            arrived = distances <= self._tolerance
        if self._reward is None:
            assert distances is not None  # it was checked
            return Outcome(-distances, arrived, distances)
        rewards = asked(self._reward, 'reward', positions, velocities, ()).astype(float)
        return Outcome(rewards, arrived, distances)


def checked_seed(seed: int | None) -> int | None:
    """Return ``seed`` as an int of 0 or more; None stays None."""
    if seed is None:
        return None
    seed = integer(seed, 'the seed', 'give an int of 0 or more, or None')
    if seed < 0:
        raise ClothSimError(f'the seed must be 0 or more, got {shown(seed)}: give another')
    return seed


def _checked(name: str, value: float, most: float, unit: str) -> float:
    value = real_number(value, f'the {name}', f'give it in {unit}')
    if not 0.0 < value <= most:
        raise ClothSimError(
            f'the {name} must be above 0 {unit} and at most {most:g} {unit}, got {value}: give '
            f'{"less" if value > most else "more"}')
    return value


def _checked_goal(goal: Sequence[float]) -> np.ndarray:
    offset = vector_or_none(goal)
    if offset is None or not all(abs(part) <= FARTHEST for part in offset):
        raise ClothSimError(
            f'the goal needs 3 numbers up to {FARTHEST:g} m, got {shown(goal)}: give x, y '
            'and z')
    return np.array(offset)


def _checked_start(scene: Scene, start: np.ndarray | None) -> np.ndarray:
    rest = scene.rest_positions()
    if start is None:
        return rest
    absent = ~scene.present_nodes if scene.has_gaps else None
    return checked_vectors(start, 'the start', rest.shape, absent=absent)


def _checked_reward(reward: OwnFunction | None, goal: np.ndarray | None) -> OwnFunction | None:
    if reward is None and goal is None:
        raise ClothSimError(
            'without a goal there is nothing to reward: give a goal, or a reward')
    return None if reward is None else checked_function(reward, 'reward')


def _checked_hands(
        scene: Scene, hands: Sequence[Sequence[Sequence[int]]] | None) -> list[np.ndarray]:
    """Return the nodes of each hand, (k, 2) int each."""
    if hands is None:
        pins = np.argwhere(scene.pinned_nodes())
        if not len(pins):
            raise ClothSimError(
                'the cloth is carried by its pins, but this scene has none: set pins, or give '
                'hands')
        return [pin[None] for pin in pins]
    found = [
        integers(nodes, 'the nodes of a hand', _GIVE_HANDS)
        for nodes in iterable(hands, 'the hands', _GIVE_HANDS)]
    if not found or any(each.ndim != 2 or each.shape[1] != 2 or not len(each) for each in found):
        raise ClothSimError(
            f'each hand needs (n, 2) nodes, got {[each.shape for each in found]}: {_GIVE_HANDS}')
    everything = np.concatenate(found)
    for row, col in everything.tolist():
        scene.checked_node(row, col)
    if len(np.unique(everything, axis=0)) < len(everything):
        raise ClothSimError('a node is in two hands, or twice in one: give it to one hand')
    return found
