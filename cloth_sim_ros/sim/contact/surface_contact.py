# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Contacts of thin colliders with edges and faces of the cloth, in explicit substeps."""

from collections.abc import Iterator
import warnings

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.loads.forcing import Layers
from cloth_sim_ros.sim.model.colliders import mask_of
from cloth_sim_ros.sim.model.colliders import rows_of
from cloth_sim_ros.sim.model.colliders import surface_defines
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Invocations of the workgroup [1]: on the CPU as many as a vector has lanes; on a GPU.
_LOCAL_OF_SOFTWARE, _LOCAL_OF_GPU = 8, 64
# Size of an entry of each kind in surface_rows.glsl and surface_nodes.glsl [bytes].
_ROW_BYTES, _NODE_BYTES, _HEAD_BYTES = 96, 48, 48
# In the head: offset of what the next substep reuses, offset of the length of the last substep,
# and size of the impulse of a row [bytes].
_KEPT_AT, _LENGTH_AT, _KEPT_BYTES = 32, 36, 16
# Additional size of a row in a scene of several colliders [bytes].
_FACING_BYTES = 16
# Additional rows of a node and thin collider there [1]: the pressure on its triangles.
_PRESSED_ROWS = 2
# Size of a node with self-contact [bytes]: it includes the sum of its impulses.
_LAYERED_NODE_BYTES = 64
# Alternations between thin colliders and layers in a substep [1].
_TURNS = 4
# Parts of surface_contact.comp, between which layers are handled.
_LISTS, _ACTS, _GIVES = 1, 2, 4


class SurfaceContact:
    """The passes of surface_contact.comp, and their buffers of rows and nodes."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate; the passes are compiled when they are first used."""
        numbers = scene.thin_colliders
        local = _LOCAL_OF_SOFTWARE if layout.texture_loads else _LOCAL_OF_GPU
        defines = {
            'SURFACE_LOCAL': local, 'SURFACE_STORED': layout.stored,
            **surface_defines(scene.colliders, numbers), 'PRESS_ON_TRIANGLES': mask_of(numbers)}
        # Key: whether changes of velocity are noted for the strain limits.
        self._impulses = {notes: SceneProgram(
            'surface_contact.comp', scene, layout,
            {**defines, 'WAYS_OUT': 0, 'NOTES_CHANGES': int(notes), 'FINDS_IMPULSES': 1})
            for notes in (False, True)}
        self._others = {notes: SceneProgram(
            'contact.comp', scene, layout,
            {'NOTES_CHANGES': int(notes), 'HAS_SURFACE': 1,
             'PRESS_ON_TRIANGLES': mask_of(numbers)}) for notes in (False, True)}
        self._ways = SceneProgram(
            'surface_contact.comp', scene, layout,
            {**defines, 'WAYS_OUT': 1, 'NOTES_CHANGES': 0, 'FINDS_IMPULSES': 1})
        self._entries = SceneProgram(
            'surface_contact.comp', scene, layout,
            {**defines, 'WAYS_OUT': 0, 'NOTES_CHANGES': 0, 'FINDS_IMPULSES': 0})
        self._pins = SceneProgram('surface_pins.comp', scene, layout, defines)
        self._near_nodes = SceneProgram(
            'near_nodes.comp', scene, layout, {**defines, 'HAS_SURFACE': 1})
        self._layout = layout
        self._has_warned = False
        # Substeps whose iteration had not converged, at the last query.
        self._unsettled = 0
        self._most_entries = scene.node_count * len(numbers)
        has_several = len(scene.colliders) > 1
        row_bytes = _ROW_BYTES + (_FACING_BYTES if has_several else 0)
        rows = max(rows_of(scene.colliders[number]) for number in numbers)
        rows += _PRESSED_ROWS if has_several else 0
        self._has_layers: bool = scene['self_contact.enabled']
        node_bytes = _LAYERED_NODE_BYTES if self._has_layers else _NODE_BYTES
        self._nodes = Buffer(np.zeros(layout.stored * node_bytes // 4, dtype=np.float32))
        kept_bytes = _KEPT_BYTES * layout.stored * len(numbers) * rows
        self._rows = Buffer(np.zeros(
            (_HEAD_BYTES + kept_bytes + self._most_entries * rows * row_bytes) // 4,
            dtype=np.float32))
        # Size of what the next substep reuses [bytes], and a copy of it for ``restore``.
        self._kept_bytes = _HEAD_BYTES - _KEPT_AT + kept_bytes
        self._copy: Buffer | None = None
        self._has_acted = False

    def programs(self, *, notes_changes: bool) -> Iterator[Program]:
        """Yield each pass, in use, for setting its uniforms of a substep."""
        yield self._others[notes_changes].use()
        yield from self._set(self._near_nodes, self._impulses[notes_changes], self._ways)

    def programs_of_ways(self) -> Iterator[Program]:
        """Yield the passes that only move edges and faces out, as ``programs`` does."""
        yield from self._set(self._near_nodes, self._entries, self._ways)

    def forget(self) -> None:
        """Drop the impulses of the last substep, which do not belong to the next state."""
        if self._has_acted:
            self._rows.write(np.zeros(1, dtype=np.float32), _LENGTH_AT)
            self._has_acted = False

    def keep(self) -> bool:
        """Copy the impulses of the last substep for ``restore``; return whether there are any."""
        if self._has_acted:
            if self._copy is None:
                self._copy = Buffer(self._kept_bytes)
            self._rows.copy_to(self._copy, 0, self._kept_bytes, _KEPT_AT)
        return self._has_acted

    def restore(self, kept: bool) -> None:
        """Restore the impulses of the last ``keep``, which returned ``kept``."""
        self.forget()
        if kept:
            assert self._copy is not None  # keep made it
            self._copy.copy_to(self._rows, _KEPT_AT, self._kept_bytes)
            self._has_acted = True

    def bind(self) -> None:
        """Bind the buffers of rows and nodes."""
        self._nodes.bind_storage(bindings.SURFACE_NODES)
        self._rows.bind_storage(bindings.SURFACE_ROWS)

    def list_nodes(self, groups: int) -> None:
        """
        List the nodes near colliders, pinned ones as well.

        :param groups: offset of the workgroups in the buffer of dispatches [bytes]
        """
        self._near_nodes.use().dispatch_indirect(groups)

    def act(self, groups: int, held_at: int, *, notes_changes: bool) -> None:
        """
        Find the contacts and their impulses, apply them, and apply contact to all other nodes.

        :param groups: offset of the workgroups in the buffer of dispatches [bytes]
        :param held_at: first entry of the substep in held.glsl, which is bound; -1 for none
        """
        self._has_acted = True
        program = self._impulses[notes_changes].use()
        if self._has_layers:
            program.set_int('parts', _LISTS | _ACTS | _GIVES)
            program.set_float('layer_unit', 0.0)
        program.dispatch(1)
        shader_writes_visible()
        self._act_on_pins(held_at)
        self._others[notes_changes].use().dispatch_indirect(groups)

    def act_beside(
            self, layers: Layers, groups: int, held_at: int, *, notes_changes: bool) -> None:
        """
        Do the same in alternation with ``layers``, whose contacts have been found.

        :param groups: offset of the workgroups in the buffer of dispatches [bytes]
        :param held_at: first entry of the substep in held.glsl, which is bound; -1 for none
        """
        self._has_acted = True
        program = self._impulses[notes_changes].use()
        program.set_float('layer_unit', layers.impulse_unit)
        self._nodes.bind_texture(bindings.SURFACE_NODES)
        self._run_part(_LISTS, program)
        # Nodes without a contact of an edge, face or layer.
        self._others[notes_changes].use().dispatch_indirect(groups)
        shader_writes_visible()
        for _ in range(_TURNS):
            self._run_part(_ACTS, program)
            layers.let_act()
        self._run_part(_GIVES, program)
        self._act_on_pins(held_at)
        layers.give(held_at, notes_changes=notes_changes)

    @staticmethod
    def _run_part(part: int, program: Program) -> None:
        program.use()
        program.set_int('parts', part)
        program.dispatch(1)
        shader_writes_visible()

    def _act_on_pins(self, held_at: int) -> None:
        if held_at >= 0:
            pins = self._pins.use()
            pins.set_int('held_at', held_at)
            pins.dispatch(1)

    def move_out(self) -> None:
        """Move edges and faces out of colliders that they are still inside."""
        self._ways.use().dispatch(1)
        shader_writes_visible()

    def list_entries(self) -> None:
        """Make the lists of ``act`` for ``move_out``, and move nodes out."""
        self._entries.use().dispatch(1)
        shader_writes_visible()

    def warn_of_losses(self) -> int:
        """
        Wait; return how many contacts could not be held, and warn once.

        Each substep since the last call whose iteration did not converge counts as one.
        """
        head = np.empty(_HEAD_BYTES // 4, dtype=np.uint32)
        self._rows.read_into(head)
        lost = int(head[1]) + int(head[2])
        if lost and not self._has_warned:
            self._has_warned = True
            warnings.warn(
                f'{lost} contacts of edges or faces were not held, as they are longer than 1.5 '
                'diagonals of a cell: use a stiffer cloth, or smaller steps', stacklevel=4)
        unsettled = int(head[6]) - self._unsettled
        self._unsettled = int(head[6])
        return lost + unsettled

    def delete(self) -> None:
        """Release everything."""
        for program in (
                *self._impulses.values(), *self._others.values(), self._ways, self._entries,
                self._near_nodes, self._pins):
            program.delete()
        for buffer in (self._nodes, self._rows, self._copy):
            if buffer is not None:
                buffer.delete()

    def _set(self, *parts: SceneProgram) -> Iterator[Program]:
        for part in parts:
            program = part.use()
            program.set_int_anywhere('most_entries', self._most_entries)
            yield program
