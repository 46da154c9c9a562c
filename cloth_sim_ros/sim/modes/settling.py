# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A limit that takes the lengths of a cloth as they are, and closes in on hard edges."""

# [s]: slowly beside the time in which a cloth of a metre falls.
_TIME = 0.3
# A smaller strain is held at once: what hard edges hold of it as energy is lost in a few steps.
_NOTABLE = 0.01


class Settling:
    """
    The strain within which hard edges are springs yet, for a while.

    ``is_new`` says that no strain has been taken yet.

    A cloth can come stretched from where nothing limited it. Its energy is that of springs: held
    at once, it would have that of hard edges from nothing, and be thrown together.
    """

    is_new: bool

    def __init__(self) -> None:
        """Wait for a cloth."""
        self.forget()

    @property
    def limit(self) -> float:
        """Return the strain limit that holds now; 0 for hard edges."""
        left = 1.0 - min(self._age / _TIME, 1.0)
        return self._first * left * left * (3.0 - 2.0 * left)

    def begin(self, strain: float) -> None:
        """Take the largest ``strain`` of a cloth; only that of a new one counts."""
        if self.is_new:
            self._first = first_limit(strain)
        self.is_new = False

    def spend(self, length: float) -> None:
        """Go on by ``length`` [s]."""
        if self._first:
            self._age += length
            if self._age >= _TIME:
                self._first = 0.0

    def forget(self) -> None:
        """Wait for another cloth."""
        self._first = self._age = 0.0
        self.is_new = True


def first_limit(strain: float) -> float:
    """Return the limit that a cloth of the largest ``strain`` begins with; 0 for hard edges."""
    # What is no number is held at once, and seen.
    return strain if strain > _NOTABLE else 0.0
