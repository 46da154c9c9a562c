# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Idle programs, kept for the next use of the same shaders."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from collections.abc import Iterator
import threading
from typing import Any

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.libraries import GL
import numpy as np

# More than the programs of all modes of a scene; a program has about 1 MiB on a software device.
_MOST_IDLE = 128
_SETTERS = {
    GL.GL_FLOAT: (GL.glUniform1fv, 1, np.float32),
    GL.GL_FLOAT_VEC2: (GL.glUniform2fv, 2, np.float32),
    GL.GL_FLOAT_VEC3: (GL.glUniform3fv, 3, np.float32),
    GL.GL_FLOAT_VEC4: (GL.glUniform4fv, 4, np.float32),
    GL.GL_INT: (GL.glUniform1iv, 1, np.int32),
    GL.GL_INT_VEC2: (GL.glUniform2iv, 2, np.int32),
    GL.GL_INT_VEC3: (GL.glUniform3iv, 3, np.int32),
    GL.GL_INT_VEC4: (GL.glUniform4iv, 4, np.int32),
    GL.GL_UNSIGNED_INT: (GL.glUniform1uiv, 1, np.uint32),
}


class PooledProgram:
    """A linked program: its name in GL, and where its uniforms are."""

    def __init__(self, name: int) -> None:
        """Begin without known uniforms."""
        self.name = name
        self.locations: dict[str, int] = {}
        self._clearing: list[tuple[Callable[..., None], tuple[Any, ...]]] | None = None

    def clear_uniforms(self) -> None:
        """Set all uniforms to the zero of a new program, but samplers, which have bindings."""
        GL.glUseProgram(self.name)
        if self._clearing is None:
            self._clearing = list(_clearing_calls(self.name))
        quick_calls.make(self._clearing)


class ProgramPool:
    """
    The idle programs of a context and of those beside it.

    Compiling costs more than all else that a small simulation does: a study, a test or an
    environment that makes one simulation after the other in a context compiles once.
    """

    def __init__(self) -> None:
        """Begin with none."""
        self._idle: OrderedDict[tuple[str, ...], list[PooledProgram]] = OrderedDict()
        self._count = 0
        # A second context compiles on a thread of its own.
        self._lock = threading.Lock()

    def take(self, texts: tuple[str, ...]) -> PooledProgram | None:
        """Return a program of these shaders, whose uniforms are as new; None where none idles."""
        with self._lock:
            program = self._remove(texts) if texts in self._idle else None
            # Here the context is current, as it need not be where a program is given back.
            while self._count > _MOST_IDLE:
                GL.glDeleteProgram(self._remove(next(iter(self._idle))).name)
        if program is not None:
            program.clear_uniforms()
        return program

    def give_back(self, texts: tuple[str, ...], program: PooledProgram) -> None:
        """Keep an unused program; those that idle longest are dropped."""
        with self._lock:
            self._idle.setdefault(texts, []).append(program)
            self._idle.move_to_end(texts)
            self._count += 1

    def _remove(self, texts: tuple[str, ...]) -> PooledProgram:
        program = self._idle[texts].pop()
        self._count -= 1
        if not self._idle[texts]:
            del self._idle[texts]
        return program


class _Current(threading.local):
    """The pool of the context that is current on each thread."""

    pool: ProgramPool | None = None


_current = _Current()


def current_pool() -> ProgramPool | None:
    """Return the pool of the context that is current on this thread."""
    return _current.pool


def set_current_pool(pool: ProgramPool | None) -> None:
    """Return whose context is current on this thread."""
    _current.pool = pool


def _clearing_calls(program: int) -> Iterator[tuple[Callable[..., None], tuple[Any, ...]]]:
    for index in range(GL.glGetProgramiv(program, GL.GL_ACTIVE_UNIFORMS)):
        name, count, kind = GL.glGetActiveUniform(program, index)
        location = GL.glGetUniformLocation(program, name)
        if location < 0:
            continue
        if kind == GL.GL_FLOAT_MAT4:
            zeros = np.zeros((count, 4, 4), np.float32)
            yield GL.glUniformMatrix4fv, (location, count, GL.GL_FALSE, zeros)
        elif count == 1 and kind == GL.GL_FLOAT:
            yield quick_calls.set_uniform_float, (location, 0.0)
        elif count == 1 and kind in (GL.GL_INT, GL.GL_BOOL):
            yield quick_calls.set_uniform_int, (location, 0)
        elif kind in _SETTERS:
            setter, width, number = _SETTERS[kind]
            yield setter, (location, count, np.zeros(width * count, number))
