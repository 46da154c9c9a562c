# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The pushes of a recording, in its own time."""

from dataclasses import replace

from cloth_sim_ros.analysis.recorded_values import parts
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.sim.push import Push

KEYS = ('inputs/push', 'inputs/command')


class PushHistory:
    """
    Takes up the messages of the topics KEYS one after the other.

    ``pushes`` are those known so far; one that was ended early has the duration it had.
    """

    def __init__(self) -> None:
        """Begin without a push."""
        self.pushes: list[Push] = []

    def read(self, entry: Entry) -> None:
        """Take up one message."""
        if entry.key == 'inputs/push':
            self.pushes.append(_push(entry))
        else:
            # Both commands, a reset and a removal of all pushes, end what acts.
            self.pushes = [
                _ended(push, entry.time) for push in self.pushes if push.start < entry.time]


def _push(entry: Entry) -> Push:
    message = entry.message
    stamp = message.header.stamp
    return Push(
        force=parts(message.force),
        # From the time of the run, which a reset puts back, to the time of the recording.
        start=message.start + entry.time - (stamp.sec + 1e-9 * stamp.nanosec),
        duration=message.duration, region=message.region, center=parts(message.center),
        radius=message.radius)


def _ended(push: Push, time: float) -> Push:
    return replace(push, duration=min(push.duration, time - push.start))
