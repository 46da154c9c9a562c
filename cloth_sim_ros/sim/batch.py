# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Many small cloths stepped together, for policy training."""

from collections.abc import Callable
from collections.abc import Hashable
from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
import math
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.arguments import array
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import integers
from cloth_sim_ros.sim.arguments import iterable
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.batch_cloth import ClothOfBatch
from cloth_sim_ros.sim.contact.stacked_contacts import BODY_VECTORS
from cloth_sim_ros.sim.contact.stacked_contacts import StackedContacts
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.low_parts import largest_coordinate
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.device.low_parts import plain_reach
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.guarded_steps import BoundsCheck
from cloth_sim_ros.sim.held.stacked_pins import StackedPins
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.cells import edge_shares
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.model.pins import PinMove
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.scene import GIVE_SCENE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import SINGLE_THREAD_NODES
from cloth_sim_ros.sim.simulation_arguments import check_context
from cloth_sim_ros.sim.state import checked_vectors
from cloth_sim_ros.sim.state import MOST_MAGNITUDE
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.state import StoredPositions
from cloth_sim_ros.sim.stepping import checked_steps
import numpy as np

# Parameters in which the cloths of one stack may differ.
_OWN = ('start.pose', 'start.z', 'start.jitter', 'start.seed', 'pins', 'pin_points.positions',
        'pin_points.max_distance', *(
            f'collider_moves.{value}' for value in (
                'start', 'name', 'target', 'orientation', 'speed', 'angular_speed')))
# Parameters that all cloths of a batch share.
_COMMON = ('rows', 'cols', 'dt')
# Max. cloths of a batch [1]: more than fit into any buffer, even of the smallest size.
_MOST_CLOTHS = 1_000_000
# Parameters that must be empty.
_TIMED = ('pushes.start', 'pin_moves.start', 'grasps.start')


class Stack:
    """
    Cloths that differ only in start, pins and moves of bodies, one below the other on one lattice.

    :param scenes: one for each cloth
    :param context: GL context, which is current
    """

    def __init__(self, scenes: Sequence[Scene], context: Context) -> None:
        """Compile, allocate and set the start poses."""
        scene = scenes[0]
        self.scenes = tuple(scenes)
        self._most_texels = context.max_texture_texels
        single = choose_layout(scene, context)
        self.layout = single.stacked(len(scenes), context)
        moves = any(each['collider_moves.start'] for each in scenes)
        if moves:
            self.layout = self._with_own_bodies()
        rows = np.arange(len(scenes))[:, None] * single.period + np.arange(scene.rows)
        self._rows = rows
        parts = np.zeros((self.layout.rows, scene.cols))
        parts[rows] = 1.0 if scene.cells is None else scene.cells.parts
        starts = np.zeros((*parts.shape, 3))
        starts[rows] = [each.start_positions() for each in scenes]
        pinned = np.zeros(parts.shape, dtype=bool)
        pinned[rows] = [each.pinned_nodes() for each in scenes]
        self._state = State(
            self.layout, starts, pinned, parts, absent=parts == 0.0 if scene.has_gaps else None,
            has_low_parts=needs_low_parts(scene))
        self._loads = Loads(scene, self.layout, self._state)
        self.pins = StackedPins(scene, self.layout, self._state)
        self._check = BoundsCheck(scene, self.layout)
        self._mode = MassSpring(scene, self.layout)
        # The contacts of ``_loads`` once bodies are to move.
        self._bodies: StackedContacts | None = None
        if moves:
            self._replace_contacts(np.zeros(len(scenes), dtype=int))

    def step(self, first: int, count: int) -> np.ndarray:
        """
        Make ``count`` steps of dt, numbered from ``first``.

        :return: which cloths became non-finite, (cloths,) bool: they are at rest where they were
            before
        """
        self._state.keep()
        number, end = first, first + count
        while number < end:
            number += self._steps(number, end - number)
        if self._check.passes(self._state):
            return np.zeros(len(self.scenes), dtype=bool)
        there = self.scenes[0].present_nodes[..., None]
        lost = ~np.all(
            ~there | (np.abs([self.positions(), self.velocities()]) < MOST_MAGNITUDE),
            axis=(0, 2, 3, 4))
        kept = self._state.read_kept_positions()[self._rows]
        for cloth in np.flatnonzero(lost).tolist():
            self.write(cloth, kept[cloth], np.zeros_like(kept[cloth]))
        return lost

    def positions(self) -> np.ndarray:
        """Return all positions [m], (cloths, rows, cols, 3) float32."""
        return self._state.read_positions()[self._rows]

    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (cloths, rows, cols, 3) float32."""
        return self._state.read_velocities()[self._rows]

    def write(self, cloth: int, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace the state of one cloth, (rows, cols, 3) each; its pins are at rest."""
        rows = self._rows[cloth]
        self.pins.stop(slice(rows[0], rows[-1] + 1))
        self._state.write_rows(int(rows[0]), positions, velocities)

    def colliders(self, cloth: int, time: float) -> tuple[Collider, ...]:
        """Return the colliders of a cloth at its ``time`` [s]."""
        if self._bodies is None:
            return self.scenes[cloth].colliders
        return self._bodies.present_in(cloth, time)

    def let_bodies_move(self, firsts: np.ndarray) -> None:
        """
        Compile and allocate what bodies that move need, unless it is there.

        :param firsts: number of the first step of each cloth, (cloths,) int
        :raises DeviceError: when they are too many for it
        """
        if self._bodies is None:
            layout = self._with_own_bodies()
            mode, self._mode = self._mode, MassSpring(self.scenes[0], layout)
            mode.delete()
            self.layout = layout
            self._replace_contacts(firsts)

    def move_collider(self, cloth: int, move: FrameMove) -> FramePath:
        """Start the motion of a collider, after ``let_bodies_move``; return its path."""
        assert self._bodies is not None
        return self._bodies.move_in(cloth, move)

    def reset(self, cloth: int, number: int) -> None:
        """Put one cloth back to its start, before step ``number``."""
        scene = self.scenes[cloth]
        if self._bodies is not None:
            self._bodies.begin_cloth(cloth, number)
        self._state.pinned[self._rows[cloth]] = scene.pinned_nodes()
        start = scene.start_positions()
        self.write(cloth, start, np.zeros_like(start))

    def hold(self, cloths: np.ndarray, nodes: np.ndarray) -> None:
        """Pin ``nodes`` (n, 2), each of one of ``cloths`` (n,), where they are."""
        self.pins.hold(self.at(cloths, nodes))

    def release(self, cloths: np.ndarray, nodes: np.ndarray) -> None:
        """Release ``nodes`` (n, 2), each of one of ``cloths`` (n,)."""
        self.pins.release(self.at(cloths, nodes))

    def pinned(self, cloth: int) -> np.ndarray:
        """Return which nodes of a cloth are held, (rows, cols) bool."""
        return self._state.pinned[self._rows[cloth]]

    def strains(self) -> np.ndarray:
        """Return the largest abs(l / L0 - 1) of structural and shear edges, (cloths,)."""
        scene, positions = self.scenes[0], self.positions().astype(float)
        largest = np.zeros(len(self.scenes))
        for kind in EDGE_KINDS:
            if kind.family == 'bend' or kind.family not in scene.families:
                continue
            starts, ends = kind.everywhere(scene.rows, scene.cols)
            lengths = np.linalg.norm(
                positions[(slice(None), *ends)] - positions[(slice(None), *starts)], axis=-1)
            strain = np.abs(lengths / kind.rest_length(scene) - 1.0)
            has_edge = np.broadcast_to(edge_shares(scene.cells, kind), strain.shape) > 0.0
            largest = np.maximum(
                largest, strain.max(axis=(1, 2), initial=0.0, where=has_edge))
        return largest

    def stored_positions(self, cloth: int) -> StoredPositions:
        """Return the place of the positions of one cloth on the device."""
        stored = self._state.stored_positions
        return stored._replace(first=self.layout.index(int(self._rows[cloth, 0]), 0))

    def at(self, cloths: np.ndarray, nodes: np.ndarray) -> np.ndarray:
        """Return row in the stack and col of ``nodes`` (n, 2), each of one of ``cloths`` (n,)."""
        return np.stack([self._rows[cloths, nodes[:, 0]], nodes[:, 1]], axis=-1)

    def delete(self) -> None:
        """Release everything."""
        for part in (self._mode, self._check, self.pins, self._loads, self._state):
            part.delete()

    def _with_own_bodies(self) -> Layout:
        """Return the layout for bodies that move; DeviceError where they are too many."""
        layout = replace(self.layout, own_bodies=True)
        texels = len(self.scenes) * len(self.scenes[0].colliders) * BODY_VECTORS
        if layout.texture_loads and texels > self._most_texels:
            raise DeviceError(
                f'{len(self.scenes)} cloths with {len(self.scenes[0].colliders)} bodies that move '
                f'need {texels} texels, textures of this device hold {self._most_texels}: set '
                'loads: storage, or make several batches')
        return layout

    def _replace_contacts(self, firsts: np.ndarray) -> None:
        """Let bodies move, which ``_mode`` has been compiled for."""
        bodies = StackedContacts(
            self.scenes, firsts, self.layout, length=self._mode.last_length,
            most=self._mode.most_at_once, quiet_until=self._loads.quiet_without_bodies_until)
        if self._loads.contacts is not None:
            self._loads.contacts.delete()
        self._loads.contacts = self._bodies = bodies

    def _steps(self, number: int, most: int) -> int:
        dt = self.scenes[0]['dt']
        begin, end = number * dt, (number + 1) * dt
        if most > 1 and self.pins.rest and self._loads.still_until(begin) == math.inf:
            made = self._mode.step_ahead(
                self._state, self._loads.forcing(self._state, begin, end), most)
            if made:
                return made
        self.pins.begin_step(number)
        self._loads.begin_step(begin, end)
        if self._bodies is not None:
            self._bodies.begin_stacked_step(number)
        self._mode.step(self._state, begin, self._loads)
        self.pins.end_step(number)
        return 1


class Batch(AbstractContextManager['Batch']):
    """
    Many cloths in mode mass_spring, each bitwise identical to a Simulation of its scene.

    Cloths that differ only in their start, pins and timed moves of colliders step in one dispatch;
    otherwise there is one dispatch for each kind. All have the same rows, cols and dt. With air,
    cloths are bitwise identical to a Simulation only if all cloths of a kind are held, or none is.
    Colliders act on nodes. There are no pushes, grasps or self-contact.

    A cloth whose state becomes non-finite stays as it was before that call, and is marked in
    ``lost`` until it is reset; the others continue.

    :param scenes: one for each cloth, or one for all
    :param count: number of cloths, if ``scenes`` is a single scene
    :param context: GL context to use; by default one of its own
    :raises ClothSimError: if a scene cannot be part of a batch
    :raises DeviceError: if there is no suitable device
    """

    def __init__(
            self, scenes: Scene | Sequence[Scene], count: int | None = None, *,
            context: Context | None = None) -> None:
        """Compile, allocate and set the start poses."""
        self.scenes = _checked_scenes(scenes, count)
        check_context(context)
        self.count = len(self.scenes)
        self.dt: float = self.scenes[0]['dt']
        self.steps = 0
        # Number of the step at which each cloth started.
        self._firsts = np.zeros(self.count, dtype=int)
        self._shape = self.scenes[0].rows, self.scenes[0].cols
        self._owns_context = context is None
        nodes = sum(scene.node_count for scene in self.scenes)
        self._context = context or Context(single_thread=nodes < SINGLE_THREAD_NODES)
        self._context.make_current()
        self.device = self._context.device
        kinds: dict[Hashable, list[int]] = {}
        reaches: dict[Hashable, float] = {}
        for number, scene in enumerate(self.scenes):
            values = _kind(scene)
            if values not in reaches:
                reaches[values] = plain_reach(scene)
            is_far = largest_coordinate(scene) > reaches[values]
            kinds.setdefault((values, is_far), []).append(number)
        self._stacks: list[Stack] = []
        # Cloths of each stack; and for each cloth its stack and its place there.
        self._members = [np.array(numbers) for numbers in kinds.values()]
        self._places = np.empty((self.count, 2), dtype=int)
        for stack, members in enumerate(self._members):
            self._places[members] = np.stack(
                [np.full(len(members), stack), np.arange(len(members))], axis=-1)
            self._stacks.append(Stack([self.scenes[cloth] for cloth in members], self._context))
        self.lost = np.zeros(self.count, dtype=bool)

    def __exit__(self, *_: object) -> None:
        """Close, however the block has ended."""
        self.close()

    @property
    def time(self) -> float:
        """Return the simulated time since the start [s]."""
        return self.steps * self.dt

    @property
    def times(self) -> np.ndarray:
        """Return the simulated time since the start of each cloth or its reset [s], (count,)."""
        return (self.steps - self._firsts) * self.dt

    def step(self, count: int = 1) -> None:
        """Make ``count`` steps of dt of every cloth."""
        count = checked_steps(count, self.steps, self.dt)
        self._context.make_current()
        for stack, members in zip(self._stacks, self._members):
            self.lost[members] |= stack.step(self.steps, count)
        self.steps += count

    def positions(self) -> np.ndarray:
        """Return all positions [m], (count, rows, cols, 3) float32; NaN for no node."""
        return self._gathered([stack.positions for stack in self._stacks])

    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (count, rows, cols, 3) float32, pins included."""
        return self._gathered([stack.velocities for stack in self._stacks])

    def max_strains(self) -> np.ndarray:
        """Return the largest abs(l / L0 - 1) of structural and shear edges, (count,)."""
        self._context.make_current()
        strains = np.empty(self.count)
        for stack, members in zip(self._stacks, self._members):
            strains[members] = stack.strains()
        return strains

    def cloth(self, number: int) -> ClothOfBatch:
        """Return one of the cloths, for a Camera."""
        number = int(self._checked_cloths([integer(number, 'the number of a cloth')])[0])
        stack, place = self._places[number]
        return ClothOfBatch(self, number, self._stacks[stack], int(place), self._context)

    def set_state(
            self, positions: np.ndarray, velocities: np.ndarray,
            cloths: Iterable[int] | None = None) -> None:
        """
        Replace positions [m] and velocities [m/s] of some cloths; their pins are at rest then.

        :param positions: (n, rows, cols, 3)
        :param velocities: (n, rows, cols, 3)
        :param cloths: their numbers, (n,); None for all
        """
        numbers = self._checked_cloths(cloths)
        shape = (len(numbers), *self._shape, 3)
        absent = None
        if any(scene.has_gaps for scene in self.scenes):
            absent = ~np.array([self.scenes[number].present_nodes for number in numbers])
        states = [
            checked_vectors(values, of, shape, 'give one state for each cloth', absent=absent)
            for of, values in (('positions', positions), ('velocities', velocities))]
        self._context.make_current()
        for (stack, place), at, velocity in zip(self._places[numbers], *states):
            self._stacks[stack].write(place, at, velocity)
        self.lost[numbers] = False

    def reset(self, cloths: Iterable[int] | None = None) -> None:
        """
        Restore the start of some cloths: pose, pins, colliders and their own time.

        The ``time`` of the batch continues, and so do gusts.

        :param cloths: their numbers; None for all
        """
        numbers = self._checked_cloths(cloths)
        self._context.make_current()
        for stack, place in self._places[numbers]:
            self._stacks[stack].reset(place, self.steps)
        self._firsts[numbers] = self.steps
        self.lost[numbers] = False

    def pin(self, cloths: np.ndarray, nodes: np.ndarray) -> None:
        """
        Pin nodes where they are; moving pins stop.

        :param cloths: the number of the cloth of each, (n,)
        :param nodes: row and col of each, (n, 2)
        :raises ClothSimError: when there is no such cloth or node; then none is pinned
        """
        self._change_pins(Stack.hold, cloths, nodes)

    def release(self, cloths: np.ndarray, nodes: np.ndarray) -> None:
        """
        Release nodes, with the velocities of their pins.

        :param cloths: the number of the cloth of each, (n,)
        :param nodes: row and col of each, (n, 2)
        :raises ClothSimError: when there is no such cloth or node; then none is released
        """
        self._change_pins(Stack.release, cloths, nodes)

    def pinned_nodes(self, cloth: int) -> np.ndarray:
        """Return which nodes of a cloth are held, (rows, cols) bool."""
        number = integer(cloth, 'the number of a cloth')
        stack, place = self._places[self._checked_cloths([number])[0]]
        return self._stacks[stack].pinned(place)

    def move_pins(
            self, cloths: np.ndarray, nodes: np.ndarray, targets: np.ndarray,
            speeds: np.ndarray | float) -> None:
        """
        Start moving pins in straight lines; a new move replaces the present one of a pin.

        :param cloths: the number of the cloth of each, (n,)
        :param nodes: row and col of each, (n, 2); none of them twice
        :param targets: (n, 3) [m]
        :param speeds: [m/s] in simulated time, (n,) or one for all
        :raises ClothSimError: when a node is not pinned or a value is wrong; then none moves
        """
        numbers, nodes = self._checked_nodes(cloths, nodes)
        targets = array(
            targets, 'the targets', (len(numbers), 3), 'give x, y and z for each pin')
        speed = _one_each(speeds, 'speed', len(numbers), 'pin', 'm/s')
        entries = zip(numbers.tolist(), nodes.tolist(), targets.tolist(), speed.tolist())
        for cloth, (row, col), target, pace in entries:
            self._check_pin(cloth, row, col)
            PinMove.checked(row=row, col=col, target=target, speed=pace, start=self.time)
        if len(np.unique(np.column_stack([numbers, nodes]), axis=0)) < len(numbers):
            raise ClothSimError('a pin is given twice: give each pin one target')
        self._context.make_current()
        places = self._places[numbers]
        for number, stack in enumerate(self._stacks):
            here = places[:, 0] == number
            if here.any():
                stack.pins.move(
                    stack.at(places[here, 1], nodes[here]), targets[here], speed[here],
                    self._firsts[numbers[here]], self.steps)

    def move_collider(
            self, cloths: np.ndarray, name: str, targets: np.ndarray,
            orientations: np.ndarray | None = None, speeds: np.ndarray | float | None = None,
            angular_speeds: np.ndarray | float | None = None, *,
            durations: np.ndarray | float = 0.0) -> tuple[FramePath, ...]:
        """
        Move the collider of that name of some cloths as ``Simulation.move_collider`` does.

        The first move compiles what bodies that move need, for all cloths of a dispatch.

        :param cloths: their numbers, (n,); none of them twice
        :param name: of the collider
        :param targets: of its centre for each cloth [m], (n, 3)
        :param orientations: at the targets, quaternions x y z w, (n, 4); the present ones by
            default
        :param speeds: [m/s] in simulated time, (n,) or one for all; motion.speed of each scene by
            default
        :param angular_speeds: [rad/s], (n,) or one for all; motion.angular_speed by default
        :param durations: in which to arrive, where these speeds are high enough [s], (n,) or one
            for all; 0 to have these speeds themselves
        :return: the path of each, whose times are those of its cloth
        :raises ClothSimError: when there is no such cloth or collider or a value is wrong; then
            none moves
        """
        numbers = self._checked_cloths(cloths)
        count = len(numbers)
        if len(np.unique(numbers)) < count:
            raise ClothSimError('a cloth is given twice: give its collider one target')
        targets = array(targets, 'the targets', (count, 3), 'give x, y and z for each cloth')
        turned = [None] * count if orientations is None else array(
            orientations, 'the orientations', (count, 4), 'give x, y, z and w for each cloth'
            ).tolist()
        speed, angular_speed = (
            [None] * count if values is None else _one_each(
                values, of, count, 'cloth', unit).tolist()
            for values, of, unit in (
                (speeds, 'speed', 'm/s'), (angular_speeds, 'angular_speed', 'rad/s')))
        duration = _one_each(durations, 'duration', count, 'cloth', 's').tolist()
        times = self.times[numbers].tolist()
        moves = []
        for cloth, time, target, *values in zip(
                numbers.tolist(), times, targets.tolist(), turned, speed, angular_speed, duration):
            stack, place = self._places[cloth]
            moves.append(MoveCollider(name, target, *values).of_one(
                self.scenes[cloth], self._stacks[stack].colliders(place, time), time))
        self._context.make_current()
        places = self._places[numbers]
        for stack in np.unique(places[:, 0]):
            self._stacks[stack].let_bodies_move(self._firsts[self._members[stack]])
        return tuple(
            self._stacks[stack].move_collider(place, move)
            for (stack, place), move in zip(places, moves))

    def finish(self) -> None:
        """Wait until the device has finished all work; for timing."""
        self._context.finish()

    def close(self) -> None:
        """Free all memory on the device; does nothing when called again, or in a forked child."""
        if not self._stacks or self._context.is_of_parent:
            return
        self._context.make_current()
        for stack in self._stacks:
            stack.delete()
        self._stacks = []
        if self._owns_context:
            self._context.close()

    def _gathered(self, readers: Sequence[Callable[[], np.ndarray]]) -> np.ndarray:
        self._context.make_current()
        if len(readers) == 1:
            return readers[0]()
        values = np.empty((self.count, *self._shape, 3), dtype=np.float32)
        for members, read in zip(self._members, readers):
            values[members] = read()
        return values

    def _checked_cloths(self, cloths: Iterable[int] | None) -> np.ndarray:
        if cloths is None:
            return np.arange(self.count)
        numbers = integers(
            cloths, 'the numbers of cloths', 'give a list of int, np.flatnonzero(mask) for a mask')
        if numbers.ndim != 1:
            raise ClothSimError(
                f'the numbers of cloths must be (n,), got {numbers.shape}: give a list of them')
        if numbers.size and not 0 <= numbers.min() <= numbers.max() < self.count:
            raise ClothSimError(
                f'there is no cloth {numbers.min() if numbers.min() < 0 else numbers.max()} in a '
                f'batch of {self.count}: give numbers from 0 to {self.count - 1}')
        return numbers

    def _checked_nodes(
            self, cloths: np.ndarray, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return numbers of cloths (n,) and nodes (n, 2); ClothSimError for another shape."""
        numbers = self._checked_cloths(cloths)
        nodes = integers(nodes, 'the nodes', 'give [row, col] of each pin')
        if nodes.shape != (len(numbers), 2):
            raise ClothSimError(
                f'{len(numbers)} pins need ({len(numbers)}, 2) nodes, got {nodes.shape}: give '
                '[row, col] of each pin')
        return numbers, nodes

    def _change_pins(
            self, change: Callable[[Stack, np.ndarray, np.ndarray], None], cloths: np.ndarray,
            nodes: np.ndarray) -> None:
        numbers, nodes = self._checked_nodes(cloths, nodes)
        for cloth, (row, col) in zip(numbers.tolist(), nodes.tolist()):
            self.scenes[cloth].checked_node(row, col)
        self._context.make_current()
        places = self._places[numbers]
        for number, stack in enumerate(self._stacks):
            here = places[:, 0] == number
            change(stack, places[here, 1], nodes[here])

    def _check_pin(self, cloth: int, row: int, col: int) -> None:
        self.scenes[cloth].checked_node(row, col)
        stack, place = self._places[cloth]
        if not self._stacks[stack].pinned(place)[row, col]:
            raise ClothSimError(
                f'node ({row}, {col}) of cloth {cloth} is free and only a pin can be moved: pin '
                'it in its scene')


def _one_each(
        values: np.ndarray | float, of: str, count: int, owner: str, unit: str) -> np.ndarray:
    """Return ``values``, or one value for all, as (count,) float."""
    if getattr(values, 'shape', None) == () or not hasattr(values, '__len__'):
        one = real_number(values, f'the {of}', f'give it in {unit}')
        values = np.full(count, one)
    return array(values, f'the {of}s', (count,), f'give one for each {owner}, or for all')


def _checked_scenes(scenes: Scene | Sequence[Scene], count: int | None) -> tuple[Scene, ...]:
    count = None if count is None else integer(count, 'the count of a batch')
    if isinstance(scenes, Scene):
        if count is not None and count > _MOST_CLOTHS:
            raise ClothSimError(
                f'a batch has at most {_MOST_CLOTHS} cloths, got {shown(count)}: make several')
        scenes = [scenes] * (1 if count is None else count)
    else:
        scenes = [
            instance(scene, Scene, 'each cloth of a batch', GIVE_SCENE)
            for scene in iterable(scenes, 'the cloths of a batch', GIVE_SCENE)]
        if count is not None and count != len(scenes):
            raise ClothSimError(
                f'count is {shown(count)}, and there are {len(scenes)} scenes: give one scene, or '
                'no count')
    if not scenes:
        raise ClothSimError('a batch needs one cloth or more: give a count of 1 or more')
    for name in _COMMON:
        values = {scene[name] for scene in scenes}
        if len(values) > 1:
            raise ClothSimError(
                f'the cloths of a batch must have the same {name}, got '
                f'{" and ".join(map(str, sorted(values)[:2]))}: make a batch of each')
    for scene in scenes:
        _check(scene)
    return tuple(scenes)


def _check(scene: Scene) -> None:
    if scene['mode'] != MassSpring.name:
        raise ClothSimError(
            f'a batch steps in mode mass_spring, got {scene["mode"]}: set the mode, or run each '
            'cloth by itself')
    if scene['layout'] != 'fused':
        raise ClothSimError(f'a batch needs layout fused, got {scene["layout"]}: set it')
    for name in _TIMED:
        if scene[name]:
            raise ClothSimError(
                f'a batch has no timed inputs but moves of colliders, and {name} is not empty: '
                'hold and move nodes with pin and move_pins')
    if scene['self_contact.enabled']:
        raise ClothSimError(
            'a batch lets layers of a cloth pass, and self_contact.enabled is true: set it to '
            'false')
    if scene.thin_colliders:
        name = scene.colliders[scene.thin_colliders[0]].name
        raise ClothSimError(
            f'in a batch colliders act on nodes alone, and collider {name} is thinner than 1.4 '
            'cells: make it thicker, or set contact.features to false')
    if scene['pin.max_force'] > 0.0:
        raise ClothSimError(
            f'a batch moves pins against any force, and pin.max_force is '
            f'{scene["pin.max_force"]:g} N: set it to 0, or run each cloth by itself')


def _kind(scene: Scene) -> Hashable:
    """Return the values that cloths of one stack share."""
    values: Mapping[str, Any] = scene.values
    return tuple(
        (name, tuple(value) if isinstance(value, list) else value)
        for name, value in sorted(values.items()) if name not in _OWN)
