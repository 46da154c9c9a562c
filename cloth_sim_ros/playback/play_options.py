# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What of a recording is played, and how."""

from dataclasses import dataclass

from cloth_sim_ros.sim.errors import ClothSimError


@dataclass(frozen=True)
class PlayOptions:
    """
    The wishes of whoever plays a recording.

    :param rate: time of the recording per wall time
    :param loop: True to begin again at the end
    :param start: where to begin, after the begin of the recording [s]
    :param duration: how much to play [s]; infinite for all
    :param topics: names of those to play; empty for all
    :param paused: True to wait for ~/pause with data: false
    :param clock: True to publish simulated time where the recording has no /clock
    :param delay: wall time before the first message, in which readers find the player [s]
    :param node: name of the recorded node, with its namespace
    :param played_node: name that its topics get instead; empty to leave it
    :raises ClothSimError: for a number outside its range
    """

    rate: float = 1.0
    loop: bool = False
    start: float = 0.0
    duration: float = float('inf')
    topics: tuple[str, ...] = ()
    paused: bool = False
    clock: bool = False
    delay: float = 1.0
    node: str = 'cloth_sim'
    played_node: str = ''

    def __post_init__(self) -> None:
        """Check the numbers."""
        # A slower rate than this stands for a slip of the hand; so does a faster one.
        for name, value, low, high in (
                ('--rate', self.rate, 1e-6, 1e6), ('--start', self.start, 0.0, 1e9),
                ('--duration', self.duration, 0.0, float('inf')),
                ('--delay', self.delay, 0.0, 1e6)):
            if not low <= value <= high:
                raise ClothSimError(
                    f'{name} {value:g} is outside its range: give a value from {low:g} to '
                    f'{high:g}')

    def played_name(self, topic: str) -> str:
        """Return the name under which the recorded ``topic`` is played."""
        recorded = f'/{self.node.strip("/")}/'
        if self.played_node and topic.startswith(recorded):
            return f'/{self.played_node.strip("/")}/{topic.removeprefix(recorded)}'
        return topic
