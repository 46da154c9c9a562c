# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Warnings of messages that make no sense."""

from cloth_sim_ros.node.ignored_messages import IgnoredMessages


def test_a_flood_does_not_fill_the_log():
    """A client at 1 kHz would write a line a millisecond, or its messages vanish uncounted."""
    warnings = []
    ignored = IgnoredMessages(warnings.append)
    for _ in range(100):
        ignored.note('~/push', ValueError('too much: take less'))
    ignored.note('~/pins/target', ValueError('no pin: pin it'))
    assert warnings == [
        'a message on ~/push is ignored: too much: take less',
        'a message on ~/pins/target is ignored: no pin: pin it']
    assert ignored.count == 101
