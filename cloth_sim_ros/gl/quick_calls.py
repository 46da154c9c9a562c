# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The calls that make up a step, without PyOpenGL's look for errors after each.

That look costs as much as the call. What goes wrong in these calls is a fault of the program, and
shows in the next call that is looked at. All arguments are numbers, an address too: PyOpenGL
converts others in Python, and an interrupt that comes meanwhile is lost in an ArgumentError.
"""

from collections.abc import Callable
from collections.abc import Iterable
from ctypes import c_size_t
from ctypes import c_uint
from functools import cache
from typing import NamedTuple

from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.libraries import PLATFORM
from OpenGL.raw.GL import _types as gl_type

# A call to be made over and over, and its arguments.
Call = tuple[Callable[..., None], tuple[int, ...]]


def make(calls: Iterable[Call]) -> None:
    """Make calls one after another."""
    for call, arguments in calls:
        call(*arguments)


def _quick(name: str, *types: type) -> Callable[..., None]:
    return PLATFORM.constructFunction(name, PLATFORM.GL, None, types)


def _quick_vectors(name: str) -> Callable[..., None]:
    return _quick(name, gl_type.GLint, gl_type.GLsizei, c_size_t)


# Display, two surfaces and context; returns 0 when it fails.
make_current: Callable[..., int] = PLATFORM.constructFunction(
    'eglMakeCurrent', PLATFORM.EGL, c_uint, 4 * (c_size_t,))
use_program = _quick('glUseProgram', gl_type.GLuint)
set_uniform_int = _quick('glUniform1i', gl_type.GLint, gl_type.GLint)
# Sets an int of a program that need not be in use.
set_program_int = _quick(
    'glProgramUniform1i', gl_type.GLuint, gl_type.GLint, gl_type.GLint)
set_uniform_float = _quick('glUniform1f', gl_type.GLint, gl_type.GLfloat)
# A place, how many vectors, and the address of their components.
set_uniform_floats = _quick_vectors('glUniform1fv')
set_uniform_vec3s = _quick_vectors('glUniform3fv')
set_uniform_ivec2s = _quick_vectors('glUniform2iv')
set_uniform_ivec4s = _quick_vectors('glUniform4iv')
dispatch = _quick('glDispatchCompute', *3 * (gl_type.GLuint,))
dispatch_indirect = _quick('glDispatchComputeIndirect', gl_type.GLintptr)
memory_barrier = _quick('glMemoryBarrier', gl_type.GLbitfield)
bind_buffer = _quick('glBindBuffer', gl_type.GLenum, gl_type.GLuint)
bind_buffer_base = _quick('glBindBufferBase', gl_type.GLenum, gl_type.GLuint, gl_type.GLuint)
# To or from an address, which is a number: making a pointer of it takes as long as the call.
read_buffer = _quick(
    'glGetBufferSubData', gl_type.GLenum, gl_type.GLintptr, gl_type.GLsizeiptr, c_size_t)
write_buffer = _quick(
    'glBufferSubData', gl_type.GLenum, gl_type.GLintptr, gl_type.GLsizeiptr, c_size_t)
# From a target and to another, from one offset and to another, how many bytes.
copy_buffer = _quick(
    'glCopyBufferSubData', gl_type.GLenum, gl_type.GLenum, gl_type.GLintptr, gl_type.GLintptr,
    gl_type.GLsizeiptr)
# A target, the format of its texels, an offset and how many bytes, then the format, the type and
# the address of what fills them: 0 for zeros.
clear_buffer = _quick(
    'glClearBufferSubData', gl_type.GLenum, gl_type.GLenum, gl_type.GLintptr, gl_type.GLsizeiptr,
    gl_type.GLenum, gl_type.GLenum, c_size_t)
activate_texture = _quick('glActiveTexture', gl_type.GLenum)
bind_texture = _quick('glBindTexture', gl_type.GLenum, gl_type.GLuint)


class MultiBind(NamedTuple):
    """
    The calls of GL 4.4 that bind many objects to successive places, by the address of their names.

    :param bind_buffers: to blocks, of a target
    :param bind_textures: to units, each to its own target
    """

    bind_buffers: Callable[..., None]
    bind_textures: Callable[..., None]


@cache
def multi_bind() -> MultiBind | None:
    """Return those calls; None where the driver of the context that is current lacks them."""
    if not (GL.glBindBuffersBase and GL.glBindTextures):
        return None
    return MultiBind(
        _quick('glBindBuffersBase', gl_type.GLenum, gl_type.GLuint, gl_type.GLsizei, c_size_t),
        _quick('glBindTextures', gl_type.GLuint, gl_type.GLsizei, c_size_t))
