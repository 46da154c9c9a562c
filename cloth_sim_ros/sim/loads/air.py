# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What air does to the cloth: a load that a pass over the triangles works out, and its work."""

import math
from typing import Any

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.device.scene_program import Strips
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.push_field import PushField
from cloth_sim_ros.sim.model.wind import Wind
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Max. change of the velocity relative to the air until it is looked at again, over it [1]: drag
# goes with its square, and is off by up to twice as much.
_CHANGE = 0.1
# Max. part of the relative velocity that air takes while it is not looked at [1]: up to 1/2 of a
# quadratic drag, v - d v^2 grows with v.
_MOST_SHARE = 0.5
# Gravity that the speed of a falling cloth is taken at [m/s2], in scenes without any as well.
_GRAVITY = 9.81
# Speed of a node, over that of a cloth that falls its own size: more is not looked for [1].
_FASTEST = 4.0
# Fraction of a substep that counts as rounding [1].
_NOTHING = 1e-6


class AirWork:
    """
    Adds up the work of the present accelerations on the free nodes.

    Reads positions and accelerations back at each look of the air, which is slow.

    :param node_mass: [kg]
    :param shares: masses of nodes over it, (rows, cols)
    """

    def __init__(self, node_mass: float, shares: np.ndarray) -> None:
        """Begin with nothing done."""
        self._node_mass, self._shares = node_mass, shares[..., None]
        self._done = 0.0
        self._positions: np.ndarray | None = None
        self._accelerations: np.ndarray | None = None

    def settle(self, state: State) -> float:
        """Return the work until the present ``state`` [J]."""
        if self._positions is not None:
            positions = state.read_positions().astype(float)
            moves = ~state.pinned & (self._shares > 0.0)[..., 0]
            moved = np.where(moves[..., None], positions - self._positions, 0.0)
            self._done += self._node_mass * float(
                np.sum(self._shares * self._accelerations * moved))
            self._positions = positions
        return self._done

    def take(self, state: State, accelerations: np.ndarray) -> None:
        """Take ``accelerations`` (rows, cols, 3) [m/s2] for those in force from now on."""
        self.settle(state)
        self._positions = state.read_positions().astype(float)
        self._accelerations = accelerations


class Air:
    """
    Drag and friction of the air, docs/how_to/air.md.

    The acceleration of each node stands in a buffer, with what pushes on regions add. It holds
    until the relative velocity of air and cloth may have changed by a tenth, for whole
    substeps, and no longer than a step of dt.

    ``wind`` is the wind. ``work``, where one is set, adds up the work of the air.
    """

    work: AirWork | None = None
    _asked: tuple[float, float, float | None] | None
    _forcing: Forcing | None
    _since: float
    _until: float

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate the accelerations; the pass is compiled when it is first needed."""
        self._scene = scene
        self._layout = layout
        defines = {'HAS_AIR_FRICTION': int(scene['air.friction'] > 0.0), 'MEASURES_RATE': 0}
        self._program = SceneProgram('air.comp', scene, layout, defines)
        self._rate = SceneProgram(
            'air.comp', scene, layout, {**defines, **Strips.defines(), 'MEASURES_RATE': 1})
        self._strips = Strips(layout, 1)
        self._drag, self._friction = air_coefficients(scene)
        self._inverse_area = 1.0 / math.prod(scene.spacing)
        # Typical speed of a cloth: of a free fall by its own size on earth [m/s].
        size = math.hypot(scene['width'], scene['height'])
        self._own_speed = math.sqrt(2.0 * _GRAVITY * size)
        self._accelerations = Buffer(np.zeros((layout.stored, 4), dtype=np.float32))
        self._set: tuple[float, float, tuple[float, float, float]] | None = None
        self.begin_run()

    def begin_run(self) -> None:
        """Go back to the wind of the scene."""
        self.wind = Wind(self._scene['air.wind'], self._scene.gusts())
        self.begin_step(-math.inf)

    def begin_step(self, end: float) -> None:
        """Begin a step of dt that ends at ``end`` [s]."""
        self._step_end = end
        self._forget()

    def forcing(
            self, state: State, pushes: PushField, begin: float, end: float,
            kick: float | None = None) -> Forcing:
        """Return the accelerations of a substep, as Loads does, those of ``pushes`` among them."""
        asked = (begin, end, kick)
        forcing = self._forcing
        if forcing is not None and asked == self._asked:
            return forcing
        base = pushes.forcing(begin, end, kick)
        length = end - begin
        self._asked = asked
        if forcing is not None and base.parts == forcing.parts and (
                self._since < begin and end <= self._until + _NOTHING * length):
            return forcing
        return self._look(state, base, begin, length, length if kick is None else kick)

    def margin(self, state: State, begin: float, end: float, length: float) -> float:
        """
        Return ``length`` over the longest substep [s] in which air acts with all its force.

        Where something is pinned, air acts by the velocity at the start of a substep; in a longer
        one it would turn it round, and acts with less. 0 where it is that short at any speed
        which is to be expected.

        :param begin: of the time whose wind counts [s]
        :param end: of that time [s]
        """
        if not state.pinned.any():
            return 0.0
        speed = self.wind.fastest + _FASTEST * self._own_speed
        if (self._drag + self._friction) * speed * length < _MOST_SHARE:
            return 0.0
        return self.fastest_rate(state, begin, end) * length / _MOST_SHARE

    def fastest_rate(self, state: State, begin: float, end: float) -> float:
        """Return the fastest rate [1/s] at which air would slow a triangle of ``state``."""
        program = self._rate.use()
        program.set_float('drag', self._drag)
        program.set_float('friction', self._friction)
        program.set_float('inverse_area', self._inverse_area)
        program.set_float('lead', 0.0)
        program.set_float('most_rate', math.inf)
        program.set_vectors('past', tuple(self.wind.mean(begin, end)))
        state.bind_in()
        self._strips.dispatch(program)
        return float(self._strips.largest()[0])

    def quiet_until(self, now: float) -> float:
        """Return until when the accelerations hold [s], ``now`` where they don't."""
        return max(self._until, now)

    def at_nodes(self, nodes: np.ndarray) -> np.ndarray:
        """
        Return what the last substep had at ``nodes`` [m/s2], (n, 3); zero before the first.

        :param nodes: rows and columns, (n, 2) int
        """
        if self._forcing is None:
            return np.zeros((len(nodes), 3))
        return self._read()[tuple(nodes.T)].astype(float)

    def keep(self) -> Any:
        """Return what ``restore`` needs to come back to this moment."""
        return self.wind.keep()

    def restore(self, kept: Any) -> None:
        """Go back to the moment of ``keep``."""
        self.wind.restore(kept)
        self._forget()

    def delete(self) -> None:
        """Release pass and accelerations."""
        self._accelerations.delete()
        self._strips.delete()
        self._program.delete()
        self._rate.delete()

    def _forget(self) -> None:
        self._asked = None
        self._since, self._until = math.inf, -math.inf
        self._forcing = None

    def _look(
            self, state: State, base: Forcing, begin: float, length: float,
            kick: float) -> Forcing:
        count = self._substeps(begin, length)
        self._since, self._until = begin, begin + count * length
        self._forcing = forcing = Forcing(
            base.everywhere, base.pushed_everywhere, self._accelerations, base.parts,
            self._layout.texture_loads)
        acts_for = max(count * length, kick)
        lead = 0.0 if state.pinned.any() else 0.5 * acts_for
        past = self.wind.mean(begin, self._until) - lead * np.array(base.everywhere)
        program = self._use((lead, _MOST_SHARE / acts_for, tuple(past)))
        base.apply(program)
        base.bind()
        state.bind_in()
        self._accelerations.bind_storage(bindings.AIR_OUT)
        program.dispatch(*self._layout.node_groups)
        shader_writes_visible()
        if self.work is not None:
            self._tell_work(self.work, state, base)
        return forcing

    def _use(self, setting: tuple[float, float, tuple[float, float, float]]) -> Program:
        """Return the pass, in use and set; most looks are like the one before."""
        program = self._program.use()
        if self._set is None:
            program.set_float('inverse_area', self._inverse_area)
            program.set_float('drag', self._drag)
            program.set_float('friction', self._friction)
        if self._set != setting:
            lead, most_rate, past = self._set = setting
            program.set_float('lead', lead)
            program.set_float('most_rate', most_rate)
            program.set_vectors('past', past)
        return program

    def _tell_work(self, work: AirWork, state: State, base: Forcing) -> None:
        given = self._read().astype(float)
        if base.regions is not None:
            # What pushes give is not the air's.
            given -= self._load(base.regions)
        work.take(state, given)

    def _read(self) -> np.ndarray:
        return self._load(self._accelerations)

    def _load(self, buffer: Buffer) -> np.ndarray:
        stored = np.empty((self._layout.stored, 4), dtype=np.float32)
        buffer.read_into(stored)
        return self._layout.load(stored)[..., :3]

    def _substeps(self, begin: float, length: float) -> int:
        speed = self.wind.fastest + self._own_speed
        longest = _CHANGE / max((self._drag + self._friction) * speed, 1e-30)
        left = (self._step_end - begin) / length
        if left < 1.0:
            return 1
        # Looks are spread evenly over the step.
        looks = max(1, math.ceil(left * length / longest - _NOTHING))
        return math.ceil(left / looks - _NOTHING)


def air_coefficients(scene: Scene) -> tuple[float, float]:
    """Return rho Cn / (2 sigma) and rho Ct / (2 sigma) [1/m], sigma the mass per area."""
    per_drag = scene['air.density'] / (2.0 * scene.mass_per_area)
    return per_drag * scene['air.drag'], per_drag * scene['air.friction']
