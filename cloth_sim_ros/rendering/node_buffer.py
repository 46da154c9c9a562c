# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The nodes that shaders draw, on the device."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.errors import DeviceError
import numpy as np

_UNIT = 0      # render/nodes.glsl
_WORDS = 8     # x y z strain, normal and flags
UNKNOWN_STRAIN = -1.0


class NodeBuffer:
    """
    Holds one frame at a time, and grows when a larger one comes.

    :param most_texels: that a texture of the device has
    """

    def __init__(self, most_texels: int) -> None:
        """Begin without memory."""
        self._most_texels = most_texels
        self._buffer: Buffer | None = None

    def load(self, frame: Frame, middle: np.ndarray) -> None:
        """
        Upload ``frame`` for the shaders.

        :param middle: origin of the shaders' positions [m]: far from the world's origin, single
            precision would be too coarse
        :raises DeviceError: when the cloth is too large for the device
        """
        packed = np.empty((*frame.records.shape, _WORDS), np.float32)
        packed[..., :3] = frame.positions - middle
        packed[..., 3] = np.nan_to_num(frame.strain, nan=UNKNOWN_STRAIN)
        packed[..., 4:7] = frame.normals
        packed[..., 7] = frame.records['flags']
        self._load(packed)

    def load_points(
            self, points: np.ndarray, middle: np.ndarray,
            flags: np.ndarray | None = None) -> None:
        """
        Upload positions without strain: of a line, (n, 3) [m], or of a cloth.

        :param flags: of the nodes; None for none
        :raises DeviceError: when they are too many for the device
        """
        packed = np.full((*points.shape[:-1], _WORDS), UNKNOWN_STRAIN, np.float32)
        packed[..., :3] = points - middle
        if flags is not None:
            packed[..., 7] = flags
        self._load(packed)

    def load_surface(self, points: np.ndarray, normals: np.ndarray, middle: np.ndarray) -> None:
        """
        Upload a surface without strain or flags.

        :param points: (rows, cols, 3) [m]
        :param normals: (rows, cols, 3)
        :raises DeviceError: when it has too many points for the device
        """
        packed = np.zeros((*points.shape[:-1], _WORDS), np.float32)
        packed[..., :3] = points - middle
        packed[..., 3] = UNKNOWN_STRAIN
        packed[..., 4:7] = normals
        self._load(packed)

    def _load(self, packed: np.ndarray) -> None:
        nodes = packed.size // _WORDS
        if 2 * nodes > self._most_texels:
            raise DeviceError(
                f'a cloth of {" x ".join(map(str, packed.shape[:-1]))} nodes is too large for '
                f'this device: it can render at most {self._most_texels // 2} nodes')
        if self._buffer is None or self._buffer.bytes < packed.nbytes:
            if self._buffer is not None:
                self._buffer.delete()
            self._buffer = Buffer(packed)
        else:
            self._buffer.write(packed)
        self._buffer.bind_texture(_UNIT)
