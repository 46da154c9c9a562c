# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Publish serialised messages while the other thread works.

rclpy holds Python's lock while the middleware copies and sends a message, and copies it once more
before. The device thread, which needs the lock after each dispatch, would wait for as long
(docs/notes/performance.md).
"""

from ctypes import byref
from ctypes import c_char
from ctypes import c_char_p
from ctypes import c_size_t
from ctypes import c_void_p
from ctypes import cast
from ctypes import CDLL
from ctypes import Structure

from rclpy._rclpy_pybind11 import RCLError
from rclpy.publisher import Publisher


class _SerializedMessage(Structure):
    """rcl_serialized_message_t: the fields of rcutils_uint8_array_t, and its allocator."""

    _fields_ = [
        ('buffer', c_void_p), ('buffer_length', c_size_t), ('buffer_capacity', c_size_t),
        ('allocator', 5 * c_void_p)]


class _ErrorString(Structure):
    """rcutils_error_string_t."""

    _fields_ = [('text', 1024 * c_char)]


# Libraries that rclpy has loaded already.
_publish = CDLL('librcl.so').rcl_publish_serialized_message
_publish.argtypes = (c_void_p, c_void_p, c_void_p)
_get_error = CDLL('librcutils.so').rcutils_get_error_string
_get_error.restype = _ErrorString
_reset_error = CDLL('librcutils.so').rcutils_reset_error
_reset_error.restype = None


def publish(publisher: Publisher, data: bytes) -> None:
    """
    Publish ``data``, a serialised message.

    :raises RCLError: when the middleware refuses it, or ROS is shut down
    """
    message = _SerializedMessage(cast(c_char_p(data), c_void_p), len(data), len(data))
    with publisher.handle:
        code = _publish(publisher.handle.pointer, byref(message), None)
    if code:
        reason = _get_error().text.decode(errors='replace')
        # Left there, it would be taken for one of the next call that fails.
        _reset_error()
        raise RCLError(f'Failed to publish: {reason}')
