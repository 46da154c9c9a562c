# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A solver over a cloth in some state, beside the float64 system it should solve."""

from collections.abc import Callable
from collections.abc import Iterator
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.observer import Observer
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import BETA
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.solver.solver import PRECONDITIONERS
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.state import State
from implicit_system import ImplicitSystem
from implicit_system import Solve
import numpy as np
import pytest

GRAVITY = (0.0, 0.0, -9.81)
# The unit scene of docs/explanation/numerics.md, k = 1000 N/m.
UNIT = {
    'stiffness.structural': 1000.0, 'stiffness.shear': 1000.0, 'stiffness.bend': 100.0,
    'damping.structural': 0.5, 'damping.shear': 0.5, 'damping.bend': 0.05,
}
HARD = ('structural', 'shear')
# A scrambled cloth has some edges beyond such a limit, and most within.
LIMIT = 0.2


def law_of(kind: str, scene: Scene, dt: float, geometric: float = 0.0) -> EdgeLaw:
    """Return the law of one of KINDS."""
    if kind == 'springs':
        return spring_law(scene, dt, geometric=geometric)
    if kind == 'hard':
        return hard_edges(scene, dt, geometric=geometric)
    options = {
        'limited': {'limited': HARD, 'limit': LIMIT},
        'hard, bend springs': {'hard': HARD, 'springs': ('bend',)}}
    return edge_law(scene, dt, geometric=geometric, **options[kind])


# With bend edges and without, with limits that are in force and some that are not.
KINDS = ('springs', 'hard', 'limited', 'hard, bend springs')


class SolverCase:
    """
    A solver set up for one state, and its float64 system.

    Where the law has the geometric mass term, a solve has been made before, for its tensions.

    ``left`` is the residual of the previous solve (rows, cols, 3) [m/s].

    :param kick: that gravity acts for [s]; None takes the length of the step
    :param is_new: leave that solve out
    """

    def __init__(
            self, context: Context, values: dict[str, Any], law: EdgeLaw,
            families: tuple[str, ...], state: tuple[np.ndarray, np.ndarray] | None = None,
            kick: float | None = None, foresees_turn: bool = False, is_new: bool = False,
            **options: Any) -> None:
        """Disturb the start pose by a random state unless one is given."""
        context.make_current()
        self.scene = Scene(values)
        self.law = law
        self.free = ~self.scene.pinned_nodes()[..., None]
        positions, velocities = state or _scrambled(self.scene)
        self.positions = positions.astype(np.float32)
        self.velocities = (velocities * self.free).astype(np.float32)
        self.layout = choose_layout(self.scene, context)
        self.state = State(self.layout, self.positions, self.scene.pinned_nodes())
        self.state.write(self.positions, self.velocities)
        # As in a run: else shaders are compiled once more.
        textures = self.layout.texture_loads
        self.forcing = Forcing(
            GRAVITY, reads_texture=textures, stand_in=self.state.buffer if textures else None)
        self._kick = kick
        self._foresees_turn = foresees_turn
        self.solver = Solver(
            self.scene, self.layout, families=families, foresees_turn=foresees_turn,
            **{'tolerance': 1e-2, 'max_iterations': 12, **options})
        self.solver.set_law(law)
        self.forget()
        self.prepare()
        if law.geometric and not is_new:
            self.solver.solve()
            self.prepare()

    def prepare(self, *, is_further: bool = False) -> None:
        """Prepare a solve of the state that is on the device, and the system that it is of."""
        found = None if self._is_new else self.solver.tensions()
        self.left = np.zeros(self.positions.shape) if self._is_new else (
            self.system.right_side + self.left - self.system.times(self.solver.solution()))
        is_next = self.solver.tally().solves > 0
        self.solver.prepare(
            self.state, self.forcing, kick=self._kick, is_further=is_further)
        self.system = ImplicitSystem(
            self.scene, self.law, *self.read_state(), GRAVITY, Solve(
                self._kick, self._foresees_turn, found,
                self.law.length * self._accelerations, is_further, is_next))
        self._is_new = False

    def exact(self) -> np.ndarray:
        """Return the exact solution of the system, of what was left as well."""
        return self.system.solve(self.system.right_side + self.left)

    def apply(self, *, further: bool = False) -> None:
        """Apply the solution."""
        change = self.solver.solution().astype(float) / self.law.length
        self._accelerations = change + self._accelerations * further
        self.solver.apply(self.state, further=further)

    def forget(self) -> None:
        """Take the state as a new one."""
        self.solver.forget()
        self._is_new = True
        # What the last step has changed velocities by, over its length [m/s2].
        self._accelerations = np.zeros(self.positions.shape)

    def solve(self) -> np.ndarray:
        """Return the solution of the step."""
        self.solver.solve()
        return self.solver.solution()

    def solve_for(self, right_side: np.ndarray) -> np.ndarray:
        """Return the solution for another right side, (rows, cols, 3)."""
        self.solver.prepare(self.state, self.forcing, kick=self._kick)
        self.solver.set_right_side(right_side)
        return self.solve()

    def least_change(self, kick: float = 0.01) -> float:
        """Return 0.001 of the norm of all velocities that gravity adds in ``kick`` [s]."""
        return 1e-3 * kick * 9.81 * float(np.sqrt(np.count_nonzero(self.free)))

    def read_state(self) -> tuple[np.ndarray, np.ndarray]:
        """Return positions and velocities, (rows, cols, 3) each."""
        observer = Observer(self.scene, self.layout, set(self.scene.families))
        records = observer.record(self.state, self.forcing, None)[1]
        observer.delete()
        return tuple(
            np.stack([records[name] for name in names], axis=-1)
            for names in (('x', 'y', 'z'), ('vx', 'vy', 'vz')))

    def random_vector(self, seed: int) -> np.ndarray:
        """Return a random vector that is zero at pinned nodes."""
        random = np.random.default_rng(seed)
        return (random.normal(size=self.positions.shape) * self.free).astype(np.float32)

    def delete(self) -> None:
        """Free the buffers."""
        self.solver.delete()
        self.state.delete()


def _scrambled(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(7)
    positions = scene.rest_positions()
    reach = 0.2 * min(scene.spacing)
    return (positions + random.uniform(-reach, reach, positions.shape),
            random.normal(size=positions.shape))


@pytest.fixture
def make_case(context: Context) -> Iterator[Callable[..., SolverCase]]:
    """Return a function from scene values and step to a solver case."""
    made = []

    def make(
            values: dict[str, Any], *, dt: float = 0.01, kind: str = 'springs',
            geometric: float = 0.0, **options: Any) -> SolverCase:
        scene = Scene({**UNIT, **values})
        law = law_of(kind, scene, dt, geometric)
        families = HARD if kind == 'hard' else FAMILIES
        made.append(SolverCase(context, scene.values, law, families, **options))
        return made[-1]

    yield make
    for case in made:
        case.delete()


@pytest.fixture(params=PRECONDITIONERS)
def preconditioner(request: pytest.FixtureRequest) -> str:
    """Return each preconditioner."""
    return request.param


@pytest.fixture(params=KINDS)
def kind(request: pytest.FixtureRequest) -> str:
    """Return each kind of law."""
    return request.param


@pytest.fixture(params=[0.0, BETA], ids=['without K_geo', 'with K_geo'])
def geometric(request: pytest.FixtureRequest) -> float:
    """Return beta of the geometric mass term."""
    return request.param
