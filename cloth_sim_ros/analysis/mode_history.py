# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The modes of a recording over its time."""

from dataclasses import dataclass

from cloth_sim_ros.analysis.recording import Entry

KEYS = ('inputs/mode', 'state')


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
    Takes up the messages of the topics KEYS one after the other.

    ``switches`` are those while it was recorded; ``first`` is the mode before them, empty where
    nothing tells it.
    """

    def __init__(self) -> None:
        """Begin without a mode."""
        self.first = ''
        self.switches: list[ModeSwitch] = []

    def read(self, entry: Entry) -> None:
        """Take up one message."""
        mode = entry.message.mode
        if not self._last and not self.switches:
            # A recording that was begun late may hold a switch from what it does not tell.
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
