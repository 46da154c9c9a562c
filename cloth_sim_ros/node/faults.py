# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Exceptions that nobody foresaw: logged with their trace and counted, and the node goes on."""

from collections.abc import Callable
import traceback

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.node.refusals import LogThrottle

# The same fault may come with every frame: its trace is logged once in this time [s].
QUIET = 10.0


class Faults:
    """
    Count and log unexpected exceptions.

    :param log: is given each text to log
    """

    def __init__(self, log: Callable[[str], object]) -> None:
        """Begin with none."""
        self._log = log
        self._throttle = LogThrottle(QUIET)
        self.count = 0
        self.latest = ''

    def note(self, error: BaseException, where: str) -> str:
        """
        Count and log ``error``, and return it in one line.

        :param where: what failed, in words
        """
        self.count += 1
        reason = cut(error)
        self.latest = f'{where}: {type(error).__name__}' + (f' ({reason})' if reason else '')
        missed = self._throttle.left_out(f'{where} {type(error).__name__} {_place(error)}')
        if missed is None:
            return self.latest
        repeats = f', and {missed} times since this was last logged' if missed else ''
        trace = ''.join(traceback.format_exception(error))
        self._log(
            f'unexpected error in {self.latest}{repeats}; the node continues: report it with this '
            f'trace\n{trace}')
        return self.latest


def _place(error: BaseException) -> str:
    trace = traceback.extract_tb(error.__traceback__)
    return f'{trace[-1].filename}:{trace[-1].lineno}' if trace else ''
