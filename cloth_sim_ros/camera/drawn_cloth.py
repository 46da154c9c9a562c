# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of a cloth on the device, for the shaders that draw its surface."""

from cloth_sim_ros.camera.lens import Lens
from cloth_sim_ros.camera.subject import RUNNING
from cloth_sim_ros.camera.subject import Subject
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.sim.state import StoredPositions
import numpy as np

# Units of camera/lattice.glsl.
_POSITIONS, _CELLS = 0, 1
_TEXEL = 4  # floats


class DrawnCloth:
    """
    Holds the drawing data of one subject at a time.

    The positions of a running cloth stay in its own buffers; those of a Snapshot are uploaded.

    :param most_texels: that a texture of the device has
    """

    def __init__(self, most_texels: int) -> None:
        """Begin without memory."""
        self._most_texels = most_texels
        self._uploaded: Buffer | None = None
        self._cells: Buffer | None = None
        self._cells_of: np.ndarray | None = None
        self._shape = (0, 0)
        self._stored: StoredPositions | None = None

    @property
    def defines(self) -> dict[str, int]:
        """Return what shaders need that draw it: nothing for a whole rectangle."""
        return {} if self._cells_of is None else {'HAS_GAPS': 1}

    def load(self, subject: Subject, stored: StoredPositions | None) -> None:
        """
        Keep the nodes of ``subject``, for ``bind``.

        :param stored: where the device has them; None for a Snapshot
        :raises DeviceError: when the cloth is too large for the device
        """
        if stored is None:
            assert not isinstance(subject.cloth, RUNNING)
            stored = self._upload(subject.cloth.positions)
        if stored.buffer.bytes // (4 * _TEXEL) > self._most_texels:
            raise DeviceError(
                f'a cloth of {subject.shape[0]} x {subject.shape[1]} nodes is too large for '
                f'this device: it can draw at most {self._most_texels} nodes')
        self._shape, self._stored = subject.shape, stored
        self._load_cells(subject.cells)

    def bind(self) -> None:
        """Let the shaders read the nodes."""
        assert self._stored is not None
        self._stored.buffer.bind_texture(_POSITIONS)
        if self._cells_of is not None and self._cells is not None:
            self._cells.bind_texture(_CELLS)

    def draw(self, program: RenderProgram, lens: Lens) -> None:
        """Draw the surface with ``program``, of camera/cloth.vert and in use."""
        lens.set_in(program)
        self.draw_surface(program)

    def draw_surface(self, program: RenderProgram) -> None:
        """Draw the surface as another eye sees it, with what is set in ``program``."""
        assert self._stored is not None
        rows, cols = self._shape
        _, first, pitch = self._stored
        program.set_int_vectors('lattice', np.array([(rows, cols, pitch, first)]))
        if self._cells_of is None:
            program.draw_strips(2 * cols, rows - 1)
        else:
            program.draw_triangles(6 * (cols - 1), rows - 1)

    def _upload(self, positions: np.ndarray) -> StoredPositions:
        packed = np.zeros((*positions.shape[:2], _TEXEL), np.float32)
        is_there = np.isfinite(positions).all(axis=-1)
        packed[..., :3] = np.where(is_there[..., None], positions, 0.0)
        packed[..., 3] = is_there
        if self._uploaded is None or self._uploaded.bytes != packed.nbytes:
            if self._uploaded is not None:
                self._uploaded.delete()
            self._uploaded = Buffer(packed)
        else:
            self._uploaded.write(packed)
        return StoredPositions(self._uploaded, 0, positions.shape[1])

    def _load_cells(self, cells: np.ndarray | None) -> None:
        if cells is None:
            self._cells_of = None
            return
        if cells is not self._cells_of:
            padded = np.pad(cells, ((0, 1), (0, 1))).astype(np.float32).ravel()
            padded = np.pad(padded, (0, -len(padded) % _TEXEL))
            if self._cells is not None:
                self._cells.delete()
            self._cells, self._cells_of = Buffer(padded), cells
