# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colliders of a run on the device: their poses, and their contact with the cloth."""

from collections.abc import Iterable
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
import math
from typing import NamedTuple

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_dispatches_visible
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.sim.contact.surface_contact import SurfaceContact
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.forcing import Layers
from cloth_sim_ros.sim.model.collider_paths import paths_of_scene
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.colliders import FACING
from cloth_sim_ros.sim.model.colliders import FACING_THIN
from cloth_sim_ros.sim.model.colliders import placed
from cloth_sim_ros.sim.model.colliders import SHAPES
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.model.frame_paths import Motions
from cloth_sim_ros.sim.model.frame_paths import MovedFrame
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import FLAG_TOUCHING
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.state import State
import numpy as np

STICKS, SLIDES = 1, 2
# Thickness of a plane [m]: larger than any displacement of a node.
_ENDLESS = 1e9
# Size of an entry of the contact record, a vec4 [bytes].
_ENTRY_BYTES = 16
# Speed at which a node inside a body is moved out, over the square root of the cloth size
# [sqrt(m) / s]: a third of sqrt(gravity x size); chosen: from 0.25 to 4 a squeezed cloth does not
# change, one that starts inside a body by 1 % (constants.py --only _WAY_OUT_SPEED).
_WAY_OUT_SPEED = 1.0
# Max. serial number of a substep [1]: the largest exact integer of float32.
_MOST_SERIAL = 2**24
# Displacement over the coordinates [1] that is ignored as rounding: ten times that of
# contact.glsl.
_ROUNDING = 4e-6
# Depth of a node in a collider [m] above which contact is reported as lost, or twice the rounding
# of contact.glsl if that is more; the random scenes of test_contact_scenes.py allow 1e-6.
_INSIDE = 1e-6
# Workgroups along x, y and z and number of near blocks, then the same of near nodes.
_NONE_NEAR = np.array([0, 1, 1, 0, 0, 1, 1, 0], dtype=np.uint32)
# Index of the number of near nodes.
_NEAR_NODES = 7
# Offset of the workgroups of near nodes [bytes].
_NODE_GROUPS = 16
# Size of a list entry of a block or node [bytes].
_NEAR_BYTES = 8


@dataclass(frozen=True)
class ContactForce:
    """
    Force of the cloth on one collider, mean over the last step of dt, and its contacts.

    :param name: of the collider
    :param force: on the collider [N], (3,)
    :param torque: on it about its centre [N m], (3,)
    :param sticking: nodes that touched it and had its velocity
    :param sliding: nodes that touched it and moved along it
    """

    name: str
    force: np.ndarray
    torque: np.ndarray
    sticking: int
    sliding: int


class Contacts:
    """
    Apply contact with colliders to the cloth, docs/explanation/contact.md.

    A substep gets its colliders from ``join``. The impulses of a step of dt stay in a buffer until
    the next step begins.
    """

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate the record of contacts; the pass is compiled when it is first needed."""
        self.colliders = scene.colliders
        self._scene = scene
        self._layout = layout
        # Marks of each collider and node, and the last substep with a contact.
        self._record = Buffer((len(scene.colliders) * layout.stored + 1) * _ENTRY_BYTES)
        # The record at the time of ``keep``, and an unused one.
        self._kept: Buffer | None = None
        self._spare: Buffer | None = None
        # The record before a substep that may be repeated.
        self._before_try: Buffer | None = None
        # Reading the record itself would make the driver move it to host memory.
        self._polled = Buffer(_ENTRY_BYTES, is_polled=True) if layout.is_asynchronous else None
        self.clearance = 0.5 * scene['contact.thickness']
        self.reach = np.array([collider.reach for collider in scene.colliders])
        self.reach_from_core = np.array([body.reach_from_core for body in scene.colliders])
        # Half axes of long bodies in the frame of the body [m], (n, 3).
        self.cores = np.array([collider.core for collider in scene.colliders])
        # Max. distance of a node from a contact of its edge or face [m].
        self.feature_reach = 1.5 * math.hypot(*scene.spacing) if scene.thin_colliders else 0.0
        self._serial = self._decision = 0
        self._program = SceneProgram('contact.comp', scene, layout, {'NOTES_CHANGES': 0})
        self._noting_program = SceneProgram('contact.comp', scene, layout, {'NOTES_CHANGES': 1})
        self._near_nodes = SceneProgram('near_nodes.comp', scene, layout)
        self._near_blocks = SceneProgram('near_blocks.comp', scene, layout)
        entries = layout.block_count + layout.rows * layout.cols
        # An even number, as a texel holds two entries.
        self._near = Buffer(_NONE_NEAR.nbytes + _NEAR_BYTES * (entries + entries % 2))
        self._clear_near = self._near.write_calls(_NONE_NEAR)
        self._foresight = SceneProgram('foresee_contact.comp', scene, layout)
        self._surface = (
            SurfaceContact(scene, layout) if scene.thin_colliders else None)
        self._set: dict[Program, tuple[Touch, float]] = {}
        self._joined: tuple[Forcing, Touch, Forcing] | None = None
        self.begin_run()

    def begin_run(self) -> None:
        """Put the colliders at their poses of the scene."""
        self._paths = paths_of_scene(self._scene)
        self._forget_touch()
        self.forget()

    def begin_step(self) -> None:
        """Clear the record of the previous step."""
        if self._record is self._kept:
            self._record = self._spare or Buffer(self._kept.bytes)
            self._spare = None
        self._record.clear()

    def keep(self) -> tuple[Buffer, bool]:
        """Return what ``restore`` needs to return to this moment: the record of the last step."""
        if self._kept is not self._record:
            self._spare = self._kept
        self._kept = self._record
        return self._kept, self._surface is not None and self._surface.keep()

    def restore(self, kept: tuple[Buffer, bool]) -> None:
        """Return to the moment of the latest ``keep``; the paths of colliders are kept."""
        record, has_impulses = kept
        if self._record is not record:
            self._record, self._spare = record, self._record
        if self._surface is not None:
            self._surface.restore(has_impulses)

    def forget(self) -> None:
        """Drop the memory of earlier steps."""
        self.begin_step()
        if self._surface is not None:
            self._surface.forget()

    def begin_try(self) -> None:
        """Copy the record of the step so far, for ``undo_try``."""
        if self._before_try is None:
            self._before_try = Buffer(self._record.bytes)
        self._record.copy_to(self._before_try, 0, self._record.bytes)

    def undo_try(self) -> None:
        """Restore the record of ``begin_try``."""
        assert self._before_try is not None
        self._before_try.copy_to(self._record, 0, self._record.bytes)

    def join(self, forcing: Forcing, begin: float, end: float) -> Forcing:
        """Return ``forcing`` plus the colliders of a substep from ``begin`` to ``end`` [s]."""
        touch = self._touch_in(begin, end)
        if self._joined is None or self._joined[:2] != (forcing, touch):
            self._joined = forcing, touch, replace(forcing, touch=touch)
        return self._joined[2]

    def present(self, time: float) -> tuple[Collider, ...]:
        """Return the colliders at their poses of ``time`` [s]."""
        return placed(self.colliders, self._poses(time))

    def move(self, move: FrameMove) -> FramePath:
        """Start the motion of a collider; return its path."""
        path = self._paths.add(move)
        self._forget_touch()
        return path

    def moved(self, now: float) -> tuple[MovedFrame, ...]:
        """Return the colliders that are not at their poses of the scene ``now`` [s]."""
        return self._paths.differing(paths_of_scene(self._scene), now)

    def place(self, name: str, pose: Pose, now: float) -> None:
        """Put a collider at rest at ``pose`` from ``now`` [s] on, until its next move."""
        self._paths.add(FrameMove(
            name, pose.position, pose.orientation, speed=math.inf, angular_speed=math.inf,
            start=now))
        self._forget_touch()

    def quiet_until(self, now: float) -> float:
        """Return the time [s] until which no collider moves: ``now`` if one does, or infinity."""
        return self._paths.quiet_until(now)

    def begin_explicit(
            self, touch: 'Touch', step: Program, length: float, *, on_surface: bool) -> None:
        """
        Have ``step``, which is in use, list the nodes for ``act`` in substeps of ``length`` [s].

        :param on_surface: whether thin colliders act on edges and faces as well
        """
        self.set_in(step, touch, length)
        for part in (self._near_nodes, self._program):
            program = part.use()
            program.set_float('substep', length)
            program.set_int('block_count', self._layout.block_count)
            self.set_in(program, touch, length)
        if on_surface:
            self._begin_surface(touch, length, notes_changes=False)
        self._bind_near()

    def _begin_surface(self, touch: 'Touch', length: float, *, notes_changes: bool) -> None:
        if self._surface is None:
            return
        self._set_surface(self._surface.programs(notes_changes=notes_changes), touch, length)
        self._surface.bind()

    def _set_surface(
            self, programs: Iterable[Program], touch: 'Touch', length: float) -> None:
        for program in programs:
            program.set_float('substep', length)
            program.set_int('block_count', self._layout.block_count)
            self.set_in(program, touch, length)

    def _bind_near(self) -> None:
        """Bind the lists of an explicit substep, and the record."""
        self._near.bind_storage(bindings.NEAR_BLOCKS)
        if self._layout.texture_loads:
            self._near.bind_texture(bindings.NEAR_BLOCKS)
            self._record.bind_texture(bindings.CONTACTS)

    def list_none(self) -> None:
        """Empty the lists before an explicit substep."""
        make(self._clear_near)

    def act_after_limits(
            self, touch: 'Touch', state: State, length: float, changes: Buffer,
            held_at: int, layers: Layers | None) -> None:
        """
        Apply contact to an explicit substep whose velocities were changed after it was made.

        :param changes: buffer of limit_give.glsl, to which changes of velocity are added
        :param held_at: first entry of the substep in held.glsl, which is bound; -1 for none
        :param layers: of the cloth that touch, as in act_beside; None for none
        """
        self._list_blocks(touch, state, length)
        noting = self._noting_program.use()
        noting.set_float('substep', length)
        noting.set_int('block_count', self._layout.block_count)
        self.set_in(noting, touch, length)
        changes.bind_storage(bindings.LIMIT_CHANGES)
        self._begin_surface(touch, length, notes_changes=True)
        if layers is None:
            self._act(self._noting_program, self._surface, held_at, notes_changes=True)
        else:
            self._act_beside(layers, self._noting_program, held_at, notes_changes=True)

    def move_out(self, touch: 'Touch', state: State, length: float) -> None:
        """
        Move edges and faces out of thin colliders at the end of an implicit substep.

        Both states are bound; the state that is written is the one at the end.
        """
        if self._surface is None:
            return
        self._list_blocks(touch, state, length)
        self._set_surface(self._surface.programs_of_ways(), touch, length)
        self._surface.bind()
        self._bind_near()
        self._near.bind_dispatches()
        shader_dispatches_visible()
        self._surface.list_nodes(0)
        shader_dispatches_visible()
        self._surface.list_entries()
        self._surface.move_out()

    def _list_blocks(self, touch: 'Touch', state: State, length: float) -> None:
        """List the blocks near colliders in a substep whose end state is written."""
        self.list_none()
        program = self._near_blocks.use()
        program.set_float('substep', length)
        self.set_in(program, touch, length)
        self._bind_near()
        state.bind_in()
        if self._layout.texture_loads:
            state.bind_out_textures()
        program.dispatch(*self._layout.groups)

    def act(self, held_at: int, *, on_surface: bool) -> None:
        """Apply contact to an explicit substep; both its states are bound."""
        self._act(self._program, self._surface if on_surface else None, held_at)

    def act_beside(self, layers: Layers, held_at: int) -> None:
        """Apply contact with bodies and between ``layers`` to an explicit substep."""
        self._act_beside(layers, self._program, held_at)

    def _act_beside(
            self, layers: Layers, act: SceneProgram, held_at: int, *,
            notes_changes: bool = False) -> None:
        self._near.bind_dispatches()
        shader_dispatches_visible()
        if self._surface is None:
            self._near_nodes.use().dispatch_indirect(0)
            shader_dispatches_visible()
            act.use().dispatch_indirect(_NODE_GROUPS)
            shader_writes_visible()
            layers.let_act()
            layers.give(held_at, notes_changes=notes_changes)
        else:
            self._surface.list_nodes(0)
            shader_dispatches_visible()
            self._surface.act_beside(
                layers, _NODE_GROUPS, held_at, notes_changes=notes_changes)
            shader_writes_visible()
            self._surface.move_out()

    def _act(
            self, act: SceneProgram, surface: SurfaceContact | None, held_at: int, *,
            notes_changes: bool = False) -> None:
        self._near.bind_dispatches()
        shader_dispatches_visible()
        if surface is None:
            self._near_nodes.use().dispatch_indirect(0)
        else:
            surface.list_nodes(0)
        shader_dispatches_visible()
        if surface is None:
            act.use().dispatch_indirect(_NODE_GROUPS)
        else:
            surface.act(_NODE_GROUPS, held_at, notes_changes=notes_changes)
        shader_writes_visible()
        if surface is not None:
            surface.move_out()

    def has_acted(self) -> bool:
        """Wait for ``act``; return whether any node was near a collider."""
        head = np.empty_like(_NONE_NEAR)
        self._near.read_into(head)
        return bool(head[_NEAR_NODES])

    def foresee(
            self, touch: 'Touch', state: State, forcing: Forcing, ahead: float) -> None:
        """Write the expected velocities of the state after ``state``."""
        program = self._foresight.use_for_step(forcing, ahead)
        self.set_in(program, touch, ahead)
        state.bind_in()
        state.bind_out()
        program.dispatch(*self._layout.node_groups)
        shader_writes_visible()

    def set_in(self, program: Program, touch: 'Touch', length: float) -> None:
        """Set the uniforms of contact.glsl in the program in use for ``length`` [s]."""
        self._record.bind_storage(bindings.CONTACTS)
        if program not in self._set:
            self._set_shapes(program)
        if self._set.get(program) != (touch, length):
            self._set_motions(program, touch, length)
            self._set[program] = touch, length

    def near_limits(self, velocities: np.ndarray, length: float) -> np.ndarray:
        """
        Return the distances from the cores within which a node at rest is near [m], (..., n).

        What ``rounding_of`` returns has to be added.

        :param velocities: of the colliders [m/s], (..., n, 3)
        """
        return (
            self.reach_from_core + self.clearance + self.feature_reach
            + length * np.linalg.norm(velocities, axis=-1) + 1e-8)

    def rounding_of(self, centres: np.ndarray) -> np.ndarray:
        """Return more than the rounding of positions at colliders [m], (..., n)."""
        largest = np.abs(centres).max(axis=-1) + self.reach + self.clearance
        return _ROUNDING * largest

    def near_cores(self, axes: np.ndarray) -> np.ndarray:
        """
        Return the half axes of long bodies [m], (..., n, 3); 0 for others, whose core is a point.

        :param axes: of the colliders, (..., n, 3, 3)
        """
        return np.einsum('na,...nax->...nx', self.cores, axes)

    def set_marks_in(self, program: Program) -> None:
        """Set the marks that a pass of an implicit step leaves for a contact or a motion."""
        program.set_float('serial', self._serial)
        program.set_float('decision', self._decision)

    def begin_substep(self) -> None:
        """Start a new substep, without contacts."""
        self._serial = self._serial % _MOST_SERIAL + 1

    def is_touched(self) -> bool:
        """Return whether any node has touched a collider in this implicit substep."""
        return bool(self._marks()[0] == self._serial)

    def begin_decision(self) -> None:
        """Start a new decision whether another solve is required."""
        self._decision = self._decision % _MOST_SERIAL + 1

    def is_solve_due(self, *, is_exact: bool = False) -> bool:
        """
        Return whether contact has moved nodes by more than the tolerance of a solve.

        :param is_exact: True if the previous solve had nothing to do: then another one is required
            only if a node begins to stick or slide, or is released
        """
        due, turned = self._marks()[1:3] == self._decision
        return bool(due and (turned or not is_exact))

    def forces(self, positions: np.ndarray, time: float) -> tuple[ContactForce, ...]:
        """
        Return the force on each collider, mean over the last step of dt.

        :param positions: of the nodes now, (rows, cols, 3) [m]
        :param time: simulated, now [s]
        """
        records = self._read_record()
        per_impulse = -self._scene.node_mass / self._scene['dt']
        found = []
        poses = self._poses(time)
        for number, collider in enumerate(self.colliders):
            record = records[number]
            forces = per_impulse * record[..., :3].astype(float)
            arms = np.nan_to_num(positions).astype(float) - np.array(poses[number].position)
            found.append(ContactForce(
                collider.name, forces.sum(axis=(0, 1)), np.cross(arms, forces).sum(axis=(0, 1)),
                int(np.sum(record[..., 3] == STICKS)), int(np.sum(record[..., 3] == SLIDES))))
        return tuple(found)

    def with_contacts(self, snapshot: Snapshot) -> Snapshot:
        """Return ``snapshot``, taken at the end of a step, with its contacts."""
        positions = snapshot.positions.astype(float)
        kinds = self._read_record()[..., 3]
        bodies = self.present(snapshot.time)
        gaps = np.stack([body.distance(positions) - self.clearance for body in bodies])
        lost = 0 if self._surface is None else self._surface.warn_of_losses()
        records = snapshot.records
        records['flags'][np.any(kinds > 0.0, axis=0)] |= FLAG_TOUCHING
        sticking = np.any(kinds == STICKS, axis=0)
        return replace(
            snapshot, sticking_nodes=int(np.count_nonzero(sticking)),
            sliding_nodes=int(np.count_nonzero(np.any(kinds == SLIDES, axis=0) & ~sticking)),
            deepest_node=max(-float(np.nanmin(gaps)), 0.0),
            surface_contact_held=snapshot.surface_contact_held and not lost
            and not self._is_inside(bodies, gaps, positions))

    def delete(self) -> None:
        """Release pass and record."""
        for record in {self._record, self._kept, self._spare, self._before_try}:
            if record is not None:
                record.delete()
        if self._polled is not None:
            self._polled.delete()
        self._near.delete()
        self._near_nodes.delete()
        self._near_blocks.delete()
        self._noting_program.delete()
        self._program.delete()
        self._foresight.delete()
        if self._surface is not None:
            self._surface.delete()

    def _is_inside(
            self, bodies: Sequence[Collider], gaps: np.ndarray, positions: np.ndarray) -> bool:
        """
        Return whether a node is inside a collider that no other one presses it into.

        Two that overlap each other beside it do not press on it: they leave it no place at all.

        :param gaps: of each collider and node [m], (n, rows, cols)
        :param positions: (rows, cols, 3) [m]
        """
        rounding = 0.2 * _ROUNDING * np.abs(positions).max(axis=-1)
        inside = -gaps > np.maximum(rounding, _INSIDE)
        for number, body in enumerate(bodies):
            places = positions[inside[number]]
            if not len(places):
                continue
            own_gaps, own_normals = gaps[number][inside[number]], body.normals(places)
            is_pressed = np.zeros(len(places), dtype=bool)
            for other, facing_body in enumerate(bodies):
                is_thin = {number, other} & set(self._scene.thin_colliders)
                facing = np.sum(own_normals * facing_body.normals(places), axis=-1)
                room = own_gaps + gaps[other][inside[number]]
                is_pressed |= (room < 0.0) & (room >= -2.0 * self.clearance - _INSIDE) & (
                    facing <= (FACING_THIN if is_thin else FACING))
            if not is_pressed.all():
                return True
        return False

    def _marks(self) -> np.ndarray:
        """Return the last entry of the record, (4,): the marks of substeps and solves."""
        marks = np.empty(4, dtype=np.float32)
        begin = self._record.bytes - _ENTRY_BYTES
        if self._polled is None:
            self._record.read_into(marks, begin)
        else:
            self._record.copy_to(self._polled, 0, _ENTRY_BYTES, begin)
            self._polled.read_into(marks)
        return marks

    def _read_record(self) -> np.ndarray:
        """Return change of velocity and kind of contact, (colliders, rows, cols, 4)."""
        stored = np.empty((len(self.colliders), self._layout.stored, 4), dtype=np.float32)
        self._record.read_into(stored)
        return np.stack([self._layout.load(each) for each in stored])

    def _poses(self, time: float) -> list[Pose]:
        return [self._paths.pose(collider.name, time) for collider in self.colliders]

    def _forget_touch(self) -> None:
        self._touch: Touch | None = None
        self._same_from, self._same_until = math.inf, -math.inf

    def _touch_in(self, begin: float, end: float) -> 'Touch':
        touch = self._touch
        if touch is not None and self._same_from <= begin and end <= self._same_until:
            return touch
        names = [collider.name for collider in self.colliders]
        motions = self._paths.motions(names, begin, end)
        touch = self._touch = Touch(self, motions)
        # If nothing moves, it is valid until something does.
        if motions.are_rest:
            self._same_from, self._same_until = begin, max(end, self.quiet_until(begin))
        else:
            self._same_until = -math.inf
        return touch

    def _set_motions(self, program: Program, touch: 'Touch', length: float) -> None:
        uniforms = touch.uniforms(length)
        for name, vectors in uniforms.vectors.items():
            program.set_vectors(name, vectors)
        for name, floats in uniforms.floats.items():
            program.set_floats(name, floats)

    def uniforms_of(self, motions: Motions, length: float) -> 'MotionUniforms':
        """Return the uniforms of contact.glsl for motions in a substep of ``length`` [s]."""
        centres, axes, velocities, turns = motions
        vectors = {
            'collider_centre': centres, 'collider_axes': axes, 'collider_velocity': velocities,
            'collider_turn': turns}
        if np.any(self.cores):
            vectors['near_core'] = self.near_cores(axes.reshape(-1, 3, 3))
        floats = {
            'near_limit': self.near_limits(velocities, length) + self.rounding_of(centres),
            'near_share': near_shares(turns.reshape(-1, 3, 3), length)}
        return MotionUniforms(*(
            {name: values.astype(np.float32) for name, values in each.items()}
            for each in (vectors, floats)))

    def _set_shapes(self, program: Program) -> None:
        shapes = list(SHAPES)
        program.set_floats(
            'collider_shape', [shapes.index(collider.shape) for collider in self.colliders])
        program.set_vectors('collider_size', [each.half_sizes for each in self.colliders])
        program.set_floats(
            'collider_friction', [collider.friction for collider in self.colliders])
        program.set_floats('collider_thickness', [
            min(collider.thickness, _ENDLESS) for collider in self.colliders])
        program.set_float('clearance', self.clearance)
        program.set_float('feature_reach', self.feature_reach)
        scene = self._scene
        program.set_float(
            'way_out_speed', _WAY_OUT_SPEED * math.sqrt(max(scene['width'], scene['height'])))
        program.set_float('compression', scene['contact.compression'] / scene.mass_per_area)
        program.set_float('node_area', scene.node_mass / scene.mass_per_area)
        program.set_int('record_stride', self._layout.stored)


class MotionUniforms(NamedTuple):
    """Arrays for the uniforms of contact.glsl that depend on motions, by name, in float32."""

    vectors: dict[str, np.ndarray]
    floats: dict[str, np.ndarray]


class Touch:
    """The colliders in one substep, and how they move in it."""

    def __init__(self, contacts: Contacts, motions: Motions) -> None:
        self._contacts = contacts
        self._motions = motions
        # For the last length of a substep: several passes ask for them.
        self._uniforms: tuple[float, MotionUniforms] | None = None

    def uniforms(self, length: float) -> MotionUniforms:
        """Return the uniforms of contact.glsl for a substep of ``length`` [s]."""
        if self._uniforms is None or self._uniforms[0] != length:
            self._uniforms = length, self._contacts.uniforms_of(self._motions, length)
        return self._uniforms[1]

    def set_in(self, program: Program, length: float) -> None:
        self._contacts.set_in(program, self, length)
        self._contacts.set_marks_in(program)

    def begin_explicit(self, step: Program, length: float, *, on_surface: bool) -> None:
        self._contacts.begin_explicit(self, step, length, on_surface=on_surface)

    def list_none(self) -> None:
        self._contacts.list_none()

    def act_after_limits(
            self, state: State, length: float, changes: Buffer, held_at: int,
            layers: Layers | None = None) -> None:
        self._contacts.act_after_limits(self, state, length, changes, held_at, layers)

    def act(self, held_at: int, *, on_surface: bool) -> None:
        self._contacts.act(held_at, on_surface=on_surface)

    def move_out(self, state: State, length: float) -> None:
        self._contacts.move_out(self, state, length)

    def act_beside(self, layers: Layers, held_at: int) -> None:
        self._contacts.act_beside(layers, held_at)

    def begin_try(self) -> None:
        self._contacts.begin_try()

    def undo_try(self) -> None:
        self._contacts.undo_try()

    def has_acted(self) -> bool:
        return self._contacts.has_acted()

    def foresee(self, state: State, forcing: Forcing, ahead: float) -> None:
        self._contacts.foresee(self, state, forcing, ahead)

    def begin_substep(self) -> None:
        self._contacts.begin_substep()

    def is_touched(self) -> bool:
        return self._contacts.is_touched()

    def begin_decision(self) -> None:
        self._contacts.begin_decision()

    def is_solve_due(self, *, is_exact: bool = False) -> bool:
        return self._contacts.is_solve_due(is_exact=is_exact)


def near_shares(turns: np.ndarray, length: float) -> np.ndarray:
    """Return the fractions of ``near_limits`` that remain with ``turns`` (..., 3, 3), (...)."""
    rates = np.linalg.norm(turns.reshape(*turns.shape[:-2], 9), axis=-1)
    return np.maximum(1.0 - length * rates, 0.0)
