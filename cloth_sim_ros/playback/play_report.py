# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What came of playing a recording."""

from dataclasses import dataclass
from dataclasses import field

# Later than this [s] is worth a word; schedulers alone make a few milliseconds.
_LATE = 0.05


@dataclass
class PlayReport:
    """
    What came of playing a recording.

    :param messages: that were published
    :param rounds: begun, more than one with --loop
    :param furthest_behind: of any message, behind its time on the wall clock [s]
    :param slipped: by how much the schedule was moved, as it could not be kept [s]
    :param overruns: messages sent to readers that had not taken those before, by topic
    """

    messages: int = 0
    rounds: int = 0
    furthest_behind: float = 0.0
    slipped: float = 0.0
    overruns: dict[str, int] = field(default_factory=dict)

    def sentences(self) -> list[str]:
        """Return it in words: what was played, then what went wrong."""
        rounds = f' in {self.rounds} rounds' if self.rounds > 1 else ''
        behind = 'in time' if self.furthest_behind < _LATE else (
            f'at most {self.furthest_behind:.2g} s late')
        found = [f'played {self.messages} messages{rounds}, {behind}']
        if self.slipped:
            found.append(
                f'this took {self.slipped:.2g} s longer than intended, as the machine or the '
                'subscribers could not keep up: nothing was dropped, but use a lower --rate')
        for topic, count in self.overruns.items():
            found.append(
                f'a subscriber of {topic} may have lost up to {count} messages, as it did not '
                'read them in time: use a lower --rate, or a deeper queue in that subscriber')
        return found
