# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mode constraint for a cloth whose layers touch each other."""

from typing import Any

from cloth_sim_ros.sim.contact.self_contact import SelfContact
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.constraint import Constraint
from cloth_sim_ros.sim.modes.layered_substeps import LayeredSubsteps
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.state import SubstepEnds
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop

# Change of a node's displacement by the impulses of layers over a cell [1], up to which they need
# no further solve; chosen: from 1e-5 to 1e-3 less changes than by half the tolerance, solves go
# from +6 to -22 % (constants.py --only _LAYERS_UNSOLVED).
_LAYERS_UNSOLVED = 1e-4
# The same [1], above which `solver_reached` is false after the last solve.
_LAYERS_LEFT = 1e-3
# Max. solves of a substep while layers change what acts on nodes [1]; chosen:
# from 6 to 48 less changes than by half the tolerance, time by -27 to +61 %
# (constants.py --only _MOST_LAYER_SOLVES).
_MOST_LAYER_SOLVES = 12


class LayeredConstraint(Constraint):
    """
    Implicit substeps in which solves and rounds of layers alternate.

    Rounds find impulses as if nodes were free of each other, and a solve what comes of them: no
    impulse acts that has not gone through a solve. As edges only add to what nodes resist with,
    the turns converge.
    """

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Compile the solver."""
        self._layers = LayeredSubsteps(scene, layout, is_implicit=True)
        # In the present substep: the contact of layers, None where none touch; its length and
        # the time that forces act for [s]; and how a caller leaves it early.
        self._touching: SelfContact | None = None
        self._length = self._kick_now = scene['dt']
        self._stop = never
        self._cell = min(scene.spacing)
        # Substeps of the present step in which the impulses of layers did not converge [1].
        self._unsolved_layers = 0
        super().__init__(scene, layout, check_stability=check_stability)

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self._layers.begin_step()
        self._unsolved_layers = 0
        super().step(state, begin, loads, stop)

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make a substep of a scratch ``state``, held and free."""
        super().run_all_passes(state, loads, stop)
        self._layers.run_all_passes(state, loads, self._dt, self)
        state.end_substep()
        self.forget()

    def forget(self) -> None:
        """Drop what earlier steps left, with impulses and lists of pairs."""
        super().forget()
        self._layers.forget()

    def report(self) -> dict[str, Any]:
        """Return how the solves of the last dt ended, and what layers did to each other."""
        found = {**super().report(), **self._layers.report()}
        if self._unsolved_layers:
            found['solver_reached'] = False
        return found

    def delete(self) -> None:
        """Release everything."""
        super().delete()
        self._layers.delete()

    # As Motion.

    def kick(self, length: float) -> float:
        """Return for how long [s] forces act in a substep of ``length`` [s]."""
        return self._kick(length)

    def write(
            self, state: State, forcing: Forcing, loads: Loads, length: float,
            kick: float) -> None:
        """Find the state after ``length`` [s] by a first solve."""
        state.begin_substep()
        if forcing.touch is not None:
            forcing.touch.begin_try()
        self._layers.contact.begin_substep(length)
        self._length, self._kick_now = length, kick
        self._begin_substep(state, forcing, loads, length, kick, self._stop)

    def ends(self, state: State) -> SubstepEnds:
        """Return the states that the substep begins and ends with."""
        return state.ends_of_substep

    def act(
            self, state: State, forcing: Forcing, length: float,
            layers: SelfContact | None) -> None:
        """Apply self-contact in further solves."""
        self._touching = layers
        self._solve_further(state, self._kick_now, self._stop)
        if layers is not None:
            self._layers.begin_contact(forcing, length)
            layers.go_on(state.ends_of_substep)
            if self._held_at >= 0:
                assert state.impulses is not None  # it has given held_at
                state.impulses.bind()
            layers.give(self._held_at)

    def end(self, state: State, forcing: Forcing, loads: Loads, length: float) -> None:
        """Go on from a substep that was solved for."""
        state.end_substep()
        self._end_substep(state, loads, length)

    def undo(self, state: State, forcing: Forcing) -> None:
        """Go back to where the substep began; the next solve expects nothing."""
        state.undo_substep()
        self._solver.expect_nothing()
        self._free_motion.forget()
        if forcing.touch is not None:
            forcing.touch.undo_try()

    # What ImplicitStep does in a substep.

    def _make_substep(
            self, state: State, start: float, length: float, loads: Loads, stop: Stop) -> None:
        self._stop = stop
        self._layers.advance(state, start, length, loads, self)

    def _solve(self, state: State, forcing: Forcing, stop: Stop, **how: Any) -> bool:
        self._layers.contact.bind_driven()
        return super()._solve(
            state, forcing, stop, is_driven=self._layers.contact.drives, **how)

    def _is_solve_due(self, state: State, solves: int) -> bool:
        """Apply self-contact to the solution; return whether another solve is needed."""
        is_due = super()._is_solve_due(state, solves)
        if self._touching is None:
            return is_due
        self._layers.begin_contact(self._forcing, self._length)
        self._touching.go_on(state.ends_of_substep)
        self._touching.let_act()
        change = self._touching.drive(state.ends_of_substep) * self._length / self._cell
        if solves >= _MOST_LAYER_SOLVES:
            self._unsolved_layers += change > _LAYERS_LEFT
            return False
        return is_due or change > _LAYERS_UNSOLVED
