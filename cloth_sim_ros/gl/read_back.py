# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Read buffers asynchronously: begin a read, let the device do other work, finish the read."""

from collections.abc import Callable
from collections.abc import Sequence

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.context import loss_noticed
from cloth_sim_ros.gl.libraries import GL
import numpy as np

# Between two looks at whether the context was lost [ns].
_PATIENCE = 10**9


class ReadBack:
    """
    Has buffers copied on the device, and reads the copies once they are complete.

    A buffer that is read itself would have to wait for all that was submitted since. The memory
    for the copies is allocated when they are first requested.
    """

    def __init__(self) -> None:
        """Allocate nothing yet."""
        self._staging: Buffer | None = None
        self._pending: _Pending | None = None

    def begin(self, parts: Sequence[tuple[Buffer, np.ndarray]]) -> Callable[[], None]:
        """
        Have the first bytes of each buffer copied for the (contiguous) array beside it.

        What was begun before is finished first.

        :return: waits for the copies and fills the arrays; does nothing when called again. A
            context that shares the buffers has to be current then.
        """
        self._settle()
        size = sum(target.nbytes for _, target in parts)
        if self._staging is None or self._staging.bytes < size:
            self.delete()
            self._staging = Buffer(size, is_staging=True)
        begin = 0
        for buffer, target in parts:
            buffer.copy_to(self._staging, begin, target.nbytes)
            begin += target.nbytes
        self._pending = _Pending(self._staging, [target for _, target in parts])
        return self._pending.finish

    def delete(self) -> None:
        """Finish a pending read, then free the memory."""
        self._settle()
        if self._staging is not None:
            self._staging.delete()
            self._staging = None

    def _settle(self) -> None:
        if self._pending is not None:
            self._pending.finish()
            self._pending = None


class _Pending:
    def __init__(self, staging: Buffer, targets: Sequence[np.ndarray]) -> None:
        self._staging = staging
        self._targets = targets
        with loss_noticed():
            self._fence = GL.glFenceSync(GL.GL_SYNC_GPU_COMMANDS_COMPLETE, 0)
            # Otherwise a driver may keep it all to itself until it has more to submit.
            GL.glFlush()

    def finish(self) -> None:
        if self._fence is None:
            return
        is_signalled = False
        while not is_signalled:
            with loss_noticed():
                status = GL.glClientWaitSync(self._fence, 0, _PATIENCE)
            is_signalled = status != GL.GL_TIMEOUT_EXPIRED
        GL.glDeleteSync(self._fence)
        self._fence = None
        begin = 0
        for target in self._targets:
            self._staging.read_into(target, begin)
            begin += target.nbytes
