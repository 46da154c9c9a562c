# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The stamp of a message that was not decoded."""

from builtin_interfaces.msg import Time

# Of the 4 bytes before a serialised message the second says how its numbers are laid out.
_ENCAPSULATION = 4
_STAMP = 8


def has_header(message_class: type) -> bool:
    """Tell whether messages of this class begin with a std_msgs/Header."""
    fields = message_class.get_fields_and_field_types()
    return next(iter(fields.items()), None) == ('header', 'std_msgs/Header')


def header_stamp(data: bytes) -> Time:
    """Return the stamp of ``data``, a serialised message that begins with a header."""
    order = 'little' if data[1] & 1 else 'big'
    parts = data[_ENCAPSULATION:_ENCAPSULATION + _STAMP]
    return Time(
        sec=int.from_bytes(parts[:4], order, signed=True),
        nanosec=int.from_bytes(parts[4:], order))
