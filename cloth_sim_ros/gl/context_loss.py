# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A GL context that was lost: the GPU was reset, or its driver taken away.

From then on GL calls do nothing, and what was read from the device means nothing.
"""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.libraries import error
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.libraries import PLATFORM
from OpenGL.GL.ARB.robustness import glGetGraphicsResetStatusARB

_REASONS = {
    GL.GL_GUILTY_CONTEXT_RESET: 'because of this process',
    GL.GL_INNOCENT_CONTEXT_RESET: 'because of another process',
    GL.GL_UNKNOWN_CONTEXT_RESET: 'for an unknown reason',
}


def reset_status() -> int:
    """Return why the context that is current was lost; GL_NO_ERROR when it was not."""
    ask = _status_call()
    return GL.GL_NO_ERROR if ask is None else ask()


def refuse_lost_context() -> None:
    """Raise DeviceError when the context that is current was lost."""
    status = reset_status()
    if status != GL.GL_NO_ERROR:
        raise DeviceError(
            f'the GL device was reset {_REASONS.get(status, f"({status:#x})")}, and its contents '
            'are lost: restart and, if it happens again, use a smaller cloth or another device')


@contextmanager
def loss_noticed() -> Iterator[None]:
    """Raise DeviceError in place of what GL calls give in a context that was lost."""
    try:
        yield
    except error.GLError:
        refuse_lost_context()
        raise
    refuse_lost_context()


@cache
def _status_call() -> Callable[[], int] | None:
    """Return the call of the driver, without PyOpenGL's look for errors; None without one."""
    for call in (GL.glGetGraphicsResetStatus, glGetGraphicsResetStatusARB):
        if call:
            return PLATFORM.constructFunction(
                call.__name__, PLATFORM.GL, int, (), extension=None, force_extension=True)
    return None
