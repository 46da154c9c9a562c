# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Who is told of a run that is made again."""

from cloth_sim_ros.sim.handling import InputListener


class Listener(InputListener):
    """
    Hears inputs as they are given, and frames, in the order of the recording.

    The simulation is at the moment they belong to. To be derived from; does nothing by itself.

    ``path`` is where what was heard is kept; empty where it is not.
    """

    path = ''

    @property
    def problem(self) -> str:
        """Why what was heard is not kept whole; empty where it is."""
        return ''

    def begin(self) -> None:
        """Hear that all is set that holds at the beginning."""

    def frame(self, step_wall_time: float, real_time_factor: float) -> None:
        """
        Hear that the present moment is one of the recording's frames.

        :param step_wall_time: of a step since the frame before [s]; 0 when there was none
        :param real_time_factor: simulated time per wall time in these steps
        """

    def stop(self) -> None:
        """Hear that the run has stopped, at its last finite state."""

    def close_interrupted(self) -> None:
        """Hear that there is no more to come, since somebody broke it off."""

    def close(self) -> None:
        """Hear that there is no more to come."""
