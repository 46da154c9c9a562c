# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The memory layout of the lattice, and the compile-time choices for a device."""

from dataclasses import dataclass
from dataclasses import replace

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.device.bindings import DEFINES
from cloth_sim_ros.sim.device.low_parts import LOW_PART_BYTES
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.device.tuning import BUILT_IN
from cloth_sim_ros.sim.device.tuning import Choice
from cloth_sim_ros.sim.device.tuning import tuned_choice
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Nodes beside a block that its springs reach [1]: bend springs span two.
HALO = 2
# Nodes along each side of a block of one invocation [1], measured on llvmpipe,
# docs/notes/performance.md; a GPU hides latency with many small invocations.
_SOFTWARE_BLOCK = 4
# Of cloths too narrow for half a workgroup of such blocks, and with damped bending, which keeps
# more of a tile than registers hold: 4 takes three times as long.
_SMALL_SOFTWARE_BLOCK = 2
_GPU_BLOCK = 1
# Invocations of a workgroup along a row and along a column. Software runs whole workgroups. Of
# those measured on a GPU (gpu_suite.py tuning), 32 x 4 is within 2 % of the fastest up to 1024 x
# 1024, and 16 x 8 half as fast at 4096 x 4096.
_SOFTWARE_LOCAL = (8, 4)
_GPU_LOCAL = (32, 4)
# Size of a position or velocity, a vec4, and what one texel of a texture holds [bytes].
_VECTOR_BYTES = 16


@dataclass(frozen=True)
class Layout:
    """
    The stored lattice: nodes, two ghosts on each side, and filling up to whole blocks.

    :param kind: fused or paper
    :param texture_loads: True when shaders read the state through textures
    :param block: nodes along each side of an invocation
    :param local: invocations of a workgroup, x and y
    :param cloth_rows: of each cloth, where several are stacked; 0 for one cloth
    :param is_asynchronous: True when the device computes while the host goes on
    :param node_bytes: of a node in the largest of the buffers of the state
    :param own_bodies: True where the bodies of each cloth of a stack are at places of their own
    """

    rows: int
    cols: int
    kind: str
    texture_loads: bool
    block: int
    local: tuple[int, int]
    cloth_rows: int = 0
    is_asynchronous: bool = False
    node_bytes: int = _VECTOR_BYTES
    own_bodies: bool = False

    @property
    def period(self) -> int:
        """Rows from one cloth of a stack to the next: whole blocks, and ghosts between."""
        return _round_up((self.cloth_rows or self.rows) + HALO, self.block)

    def stacked(self, count: int, context: Context) -> 'Layout':
        """
        Return the layout of ``count`` such cloths, one below the other.

        :raises DeviceError: when they do not fit into the device's buffers
        """
        layout = replace(
            self, rows=(count - 1) * self.period + self.rows, cloth_rows=self.rows)
        _refuse_too_large(layout, context)
        return layout

    @property
    def pitch(self) -> int:
        """Entries of a stored row."""
        return _round_up(self.cols, self.block) + 2 * HALO

    @property
    def stored(self) -> int:
        """Entries of a buffer."""
        return self.pitch * (_round_up(self.rows, self.block) + 2 * HALO)

    @property
    def block_count(self) -> int:
        """Invocations with a node, one for each block."""
        return -(-self.rows // self.block) * -(-self.cols // self.block)

    @property
    def groups(self) -> tuple[int, int]:
        """Workgroups that cover the cloth, x and y."""
        return self._groups_of(self.block)

    @property
    def node_groups(self) -> tuple[int, int]:
        """Workgroups that cover the cloth with one node an invocation, x and y."""
        return self._groups_of(1)

    def index(self, row: int, col: int) -> int:
        """Return where the node (row, col) is stored."""
        return (row + HALO) * self.pitch + col + HALO

    def store(self, values: np.ndarray) -> np.ndarray:
        """Return (rows, cols, ...) ``values`` as stored, zero where there is no node."""
        stored = np.zeros((self.stored // self.pitch, self.pitch, *values.shape[2:]), values.dtype)
        stored[HALO:HALO + self.rows, HALO:HALO + self.cols] = values
        return stored

    def stored_rows(self, values: np.ndarray) -> np.ndarray:
        """Return (n, cols, ...) ``values`` of some rows as stored, with ghosts on both sides."""
        stored = np.zeros((len(values), self.pitch, *values.shape[2:]), values.dtype)
        stored[:, HALO:HALO + self.cols] = values
        return stored

    def load(self, stored: np.ndarray) -> np.ndarray:
        """Return the (rows, cols, ...) part of ``stored`` values that belongs to nodes."""
        lattice = stored.reshape(-1, self.pitch, *stored.shape[1:])
        return lattice[HALO:HALO + self.rows, HALO:HALO + self.cols]

    def _groups_of(self, block: int) -> tuple[int, int]:
        across, down = (
            -(-nodes // (block * local))
            for nodes, local in zip((self.cols, self.rows), self.local))
        return across, down

    def set_in(self, program: Program) -> None:
        """Set the uniform of lattice.glsl in the program in use."""
        program.set_int_vectors(
            'lattice', np.array([(self.rows, self.cols, self.pitch, self.stored)]))
        program.set_int_vectors('stack', np.array([(self.cloth_rows or self.rows, self.period)]))

    @property
    def choice(self) -> Choice:
        """Return what `cloth_sim tune` chooses from, as parameters of a scene."""
        return Choice('texture' if self.texture_loads else 'storage', self.block)

    def defines(self) -> dict[str, object]:
        """Return the choices that every shader on this lattice compiles in, its size aside."""
        return {
            **DEFINES, 'LOADS_TEXTURE': int(self.texture_loads), 'BLOCK': self.block,
            'LOCAL_X': self.local[0], 'LOCAL_Y': self.local[1],
            'OWN_BODIES': int(self.own_bodies),
        }


def choose_layout(scene: Scene, context: Context, *, tuned: bool = True) -> Layout:
    """
    Return the layout ``scene`` asks for, with what suits the device where it leaves it open.

    :param tuned: False leaves out what `cloth_sim tune` has found for the device
    :raises DeviceError: when the cloth does not fit into the device's buffers
    :raises ClothSimError: when the scene asks for what its layout can't do
    """
    given = Choice(scene['loads'], scene['block'])
    if scene['layout'] == 'paper':
        if given.loads == 'texture' or given.block > 1:
            raise ClothSimError(
                f'layout paper reads storage, one node per invocation, got loads {given.loads} '
                f'and block {given.block}: set loads: storage and block: 1, or layout: fused')
        layout = Layout(scene.rows, scene.cols, 'paper', False, 1, (16, 16),
                        is_asynchronous=not context.is_software, node_bytes=_node_bytes(scene))
        _refuse_too_large(layout, context)
        return layout
    if tuned and given == BUILT_IN:
        found = tuned_choice(scene, context.device, context.version)
        layout = _fused(scene, context, found)
        # It was measured on cloths that may have been smaller than this one.
        if layout.stored <= _most_stored(layout, context):
            return layout
    layout = _fused(scene, context, given)
    if layout.texture_loads and not context.max_texture_texels:
        raise DeviceError(
            f'loads: texture needs texture buffers, which {context.device} lacks: set loads: '
            'storage, or auto')
    _refuse_too_large(layout, context)
    return layout


def _fused(scene: Scene, context: Context, choice: Choice) -> Layout:
    has_textures = context.is_software and context.max_texture_texels > 0
    return Layout(
        scene.rows, scene.cols, 'fused',
        choice.loads == 'texture' or (choice.loads == 'auto' and has_textures),
        choice.block or _best_block(scene, context),
        _SOFTWARE_LOCAL if context.is_software else _GPU_LOCAL,
        is_asynchronous=not context.is_software, node_bytes=_node_bytes(scene))


def _best_block(scene: Scene, context: Context) -> int:
    if not context.is_software:
        return _GPU_BLOCK
    halves = (_SOFTWARE_BLOCK * side // 2 for side in _SOFTWARE_LOCAL)
    is_narrow = any(count <= half for count, half in zip((scene.cols, scene.rows), halves))
    return _SMALL_SOFTWARE_BLOCK if is_narrow or scene.has_bending_damping else _SOFTWARE_BLOCK


def _refuse_too_large(layout: Layout, context: Context) -> None:
    limit = _most_stored(layout, context)
    if layout.stored > limit:
        side = int(limit**0.5) - 2 * HALO - layout.block
        raise DeviceError(
            f'rows {layout.rows} x cols {layout.cols} need {layout.stored} stored nodes, the '
            f'buffers of {context.device} hold {limit}: use up to about {side} x {side}')


def _most_stored(layout: Layout, context: Context) -> int:
    limit = context.max_buffer_bytes // layout.node_bytes
    if not layout.texture_loads:
        return limit
    return min(limit, context.max_texture_texels * _VECTOR_BYTES // layout.node_bytes)


def _node_bytes(scene: Scene) -> int:
    return LOW_PART_BYTES if needs_low_parts(scene) else _VECTOR_BYTES


def _round_up(value: int, multiple: int) -> int:
    return -(-value // multiple) * multiple
