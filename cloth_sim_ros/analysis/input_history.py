# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The pushes and the modes of a recording over its time."""

from dataclasses import dataclass
from dataclasses import replace

from cloth_sim_ros.analysis.recorded_values import parts
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.sim.model.push import Push

PUSH_KEYS = ('inputs/push', 'inputs/command')


class PushHistory:
    """
    The pushes of a recorded run, from the messages of the topics PUSH_KEYS in order.

    ``pushes`` are those known so far; one that was ended early has the duration it had.
    """

    def __init__(self) -> None:
        """Begin without a push."""
        self.pushes: list[Push] = []

    def read(self, entry: Entry) -> None:
        """Apply one message."""
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
        # Convert the time of the run, which a reset sets to 0, to the time of the recording.
        start=message.start + entry.time - (stamp.sec + 1e-9 * stamp.nanosec),
        duration=message.duration, region=message.region, center=parts(message.center),
        radius=message.radius)


def _ended(push: Push, time: float) -> Push:
    return replace(push, duration=min(push.duration, time - push.start))


# The modes of a recording over its time.

MODE_KEYS = ('inputs/mode', 'state')


@dataclass(frozen=True)
class ModeSwitch:
    """
    A switch of the mode.

    :param time: [s] of the recording
    """

    time: float
    previous: str
    mode: str


class ModeHistory:
    """
    The modes of a recorded run, from the messages of the topics MODE_KEYS in order.

    ``switches`` are those while it was recorded; ``first`` is the mode before them, empty if the
    recording does not contain it.
    """

    def __init__(self) -> None:
        """Begin without a mode."""
        self.first = ''
        self.switches: list[ModeSwitch] = []

    def read(self, entry: Entry) -> None:
        """Apply one message."""
        mode = entry.message.mode
        if not self._last and not self.switches:
            # A late recording may begin with a switch, whose previous mode is then the first.
            self.first = getattr(entry.message, 'previous_mode', '') or mode
        if mode != self._last:
            self.switches.append(ModeSwitch(entry.time, self._last, mode))

    @property
    def _last(self) -> str:
        return self.switches[-1].mode if self.switches else self.first

    @property
    def modes(self) -> list[str]:
        """Get each mode once, in the order they came."""
        named = [self.first, *(switch.mode for switch in self.switches)]
        return list(dict.fromkeys(filter(None, named)))

    def at(self, time: float) -> str:
        """Return the mode that led to the state at ``time`` [s]; a frame comes before a switch."""
        before = [switch.mode for switch in self.switches if switch.time < time]
        return before[-1] if before else self.first
