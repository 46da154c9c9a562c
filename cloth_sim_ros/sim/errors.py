# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Errors that a user can correct: rule, value and remedy in one sentence."""

from cloth_sim_ros.files.errors import ClothSimError
from cloth_sim_ros.files.errors import NameTakenError
from cloth_sim_ros.files.errors import NotFoundError
from cloth_sim_ros.files.errors import WrongStateError

__all__ = (
    'ClothSimError', 'NameTakenError', 'NonFiniteStateError', 'NotFoundError', 'WrongStateError')


class NonFiniteStateError(ClothSimError):
    """
    The state became invalid: a position or velocity is not finite, or far too large.

    The simulation keeps the last finite state, and can be inspected, changed, reset or
    retried.

    :param steps: made since the start or the last reset until the state that is kept
    :param node: row and col of the node that was fastest among those that were lost; None where
        that is not known
    """

    def __init__(
            self, message: str, *, steps: int, node: tuple[int, int] | None = None) -> None:
        """Keep the parts of the message."""
        super().__init__(message)
        self.steps = steps
        self.node = node
