# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is timed on one cloth: serial programs, the paper's shaders, and those of this project."""

from collections.abc import Callable
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.paper.cloths import PaperCloth
from cloth_sim_ros.study.paper.cloths import State
from cloth_sim_ros.study.paper.serial import serial_cloth
from cloth_sim_ros.study.paper.serial_model import serial_model
from cloth_sim_ros.study.paper.serial_model import TOLERANCE
from cloth_sim_ros.study.paper_figures import PAPER_ADAPTIVE
from cloth_sim_ros.study.paper_figures import PAPER_CONSTRAINT
from cloth_sim_ros.study.timed_solvers import PaperSolver

# Wall time of looking at a pair of constraints [s], below what was measured: to refuse what is
# bound to take too long before it begins.
_SERIAL_PAIR = 1e-8
_SOFTWARE_PAIR = 5e-8


class Program(Protocol):
    """A running cloth, one step a frame."""

    def set_state(self, positions: Any, velocities: Any) -> None:
        """Replace positions [m] and velocities [m/s], (rows, cols, 3)."""

    def step(self) -> None:
        """Make one step."""

    def finish(self) -> None:
        """Return when all steps are done."""

    def close(self) -> None:
        """Free all resources."""


@dataclass(frozen=True)
class Contender:
    """
    One way to step a cloth.

    :param start: makes the program from cloth, state and context
    :param pair_seconds: wall time for each pair of constraints that it is sure to take, on a CPU
        [s]; 0 for what looks at no pairs
    :param is_serial: one thread of the CPU, without OpenGL
    """

    name: str
    start: Callable[[PaperCloth, State, Context], Program]
    pair_seconds: float = 0.0
    is_serial: bool = False

    def least_seconds(self, cloth: PaperCloth, context: Context) -> float:
        """Return a wall time that a step is sure to take [s]."""
        if cloth.method != 'constraint' or not (self.is_serial or context.is_software):
            return 0.0
        return self.pair_seconds * cloth.springs**2


class PaperConstraintCloth:
    """
    The paper's constraint enforcement on the device; lambda goes to the nodes on the host.

    The passes of its Tab. 4 up to conjugate gradients are compute shaders, as in the paper.
    ConstraintForce() and UpdateNodes() are NumPy: below 1 % of the time of a step.
    """

    def __init__(self, scene: Scene, state: State, tolerance: float = TOLERANCE) -> None:
        """Compile the shaders."""
        self._positions, self._velocities = state
        self._dt: float = scene['dt']
        self._solver = PaperSolver(
            scene, *state, self._dt, tolerance=tolerance, families=scene['constraint.hard'])

    @property
    def positions(self) -> Any:
        """Return all positions [m], (rows, cols, 3)."""
        return self._positions

    @property
    def iterations(self) -> int:
        """Return the iterations of conjugate gradients in the last step."""
        return self._solver.report().iterations

    def set_state(self, positions: Any, velocities: Any) -> None:
        """Replace positions [m] and velocities [m/s], (rows, cols, 3)."""
        self._positions, self._velocities = positions, velocities

    def step(self) -> None:
        """Make one step of dt."""
        self._solver.set_state(self._positions, self._velocities)
        self._solver.solve()
        self._velocities = self._velocities + self._solver.solution()
        self._positions = self._positions + self._dt * self._velocities

    def finish(self) -> None:
        """Do nothing: the host has waited for the solution."""

    def close(self) -> None:
        """Free the buffers."""
        self._solver.delete()


def _serial(forms_matrix: bool) -> Callable[[PaperCloth, State, Context], Program]:
    def start(cloth: PaperCloth, state: State, _: Context) -> Program:
        model = serial_model(cloth.scene(**_PLAIN[cloth.method]))
        return serial_cloth(model.with_matrix() if forms_matrix else model, *state)
    return start


def _simulation(changes: Mapping[str, Any]) -> Callable[[PaperCloth, State, Context], Program]:
    def start(cloth: PaperCloth, state: State, context: Context) -> Program:
        run = Simulation(cloth.scene(**changes), context=context, check_stability=False)
        run.warm_up()
        run.set_state(*state)
        return run
    return start


def _paper_solver(cloth: PaperCloth, state: State, _: Context) -> Program:
    return PaperConstraintCloth(cloth.scene(), state)


# One step of the paper's method, which the serial programs make, too.
_PLAIN: Mapping[str, Mapping[str, Any]] = {
    'mass_spring': {},
    'constraint': PAPER_CONSTRAINT, 'adaptive': PAPER_ADAPTIVE}
_WITHOUT_MATRIX = Contender('serial, no matrix', _serial(False), is_serial=True)
_BY_PAIRS = Contender("serial, the paper's matrix", _serial(True), _SERIAL_PAIR, is_serial=True)
OURS = 'GLSL, defaults'
# The first of each method is the serial program of the paper.
CONTENDERS: Mapping[str, tuple[Contender, ...]] = {
    'mass_spring': (
        Contender('serial', _serial(False), is_serial=True),
        Contender("GLSL, the paper's two passes", _simulation({'layout': 'paper'})),
        Contender(OURS, _simulation({}))),
    'constraint': (
        _BY_PAIRS, _WITHOUT_MATRIX,
        Contender("GLSL, the paper's solver", _paper_solver, _SOFTWARE_PAIR),
        Contender('GLSL, one solve a step', _simulation(_PLAIN['constraint'])),
        Contender(OURS, _simulation({}))),
    'adaptive': (
        _BY_PAIRS, _WITHOUT_MATRIX,
        Contender("GLSL, the paper's scheme", _simulation(_PLAIN['adaptive'])),
        Contender(OURS, _simulation({}))),
}
