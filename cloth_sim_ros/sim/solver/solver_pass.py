# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One pass of the solver, and the list of workgroup counts that reduce.comp switches off."""

from collections.abc import Sequence

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.buffer import WRITES_VISIBLE
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import Call

_BYTES_PER_DISPATCH = 12


class SolverPass:
    """
    A program with the workgroups it always runs on.

    :param level: what the program's uniform ``level`` is set to; None leaves it alone
    :param goes_up: what the program's uniform ``goes_up`` is set to; None leaves it alone
    """

    def __init__(
            self, program: Program, groups: tuple[int, int], level: int | None = None,
            goes_up: bool | None = None) -> None:
        """Remember how to run ``program``."""
        self.groups = groups
        self._program = program
        uniforms = {'level': level, 'goes_up': goes_up}
        self._uniforms = {
            name: int(value) for name, value in uniforms.items() if value is not None}
        self._offset = 0

    def set_int(self, name: str, value: int) -> None:
        """Set an int uniform of the program."""
        self._program.use()
        self._program.set_int(name, value)

    def set_float(self, name: str, value: float) -> None:
        """Set a float uniform of the program."""
        self._program.use()
        self._program.set_float(name, value)

    def set_vectors(self, name: str, vectors: Sequence[float]) -> None:
        """Set a vec3 uniform of the program."""
        self._program.use()
        self._program.set_vectors(name, vectors)

    def switch(self, dispatches: list[tuple[int, int]]) -> None:
        """Take the pass's place in ``dispatches``, the workgroup counts that can be switched."""
        if self.groups not in dispatches:
            dispatches.append(self.groups)
        self._offset = dispatches.index(self.groups) * _BYTES_PER_DISPATCH

    def run(self) -> None:
        """Run the pass and order what follows after it."""
        self._use()
        self._program.dispatch(*self.groups)
        shader_writes_visible()

    def calls_if_going(self) -> list[Call]:
        """Return what runs the pass unless the device has decided to stop."""
        return [*self._program.indirect_calls(self._offset, **self._uniforms), WRITES_VISIBLE]

    def submitted(self, count: int) -> None:
        """Count ``count`` times that ``calls_if_going`` were made."""
        self._program.submitted(count)

    def _use(self) -> None:
        self._program.use()
        for name, value in self._uniforms.items():
            self._program.set_int(name, value)
