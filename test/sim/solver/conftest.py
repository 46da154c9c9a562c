# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A solver over a cloth in some state, beside the float64 system it should solve."""

from collections.abc import Callable
from collections.abc import Iterator
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import choose_layout
from cloth_sim_ros.sim.observer import Observer
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import implicit_springs
from cloth_sim_ros.sim.solver.solver import PRECONDITIONERS
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.state import State
from implicit_system import ImplicitSystem
import numpy as np
import pytest

GRAVITY = (0.0, 0.0, -9.81)
# The unit scene of docs/numerics.md, k = 1000 N/m.
UNIT = {
    'stiffness.structural': 1000.0, 'stiffness.shear': 1000.0, 'stiffness.bend': 100.0,
    'damping.structural': 0.5, 'damping.shear': 0.5, 'damping.bend': 0.05,
}


class SolverCase:
    """A solver set up for one state, and its float64 system."""

    def __init__(
            self, context: Context, values: dict[str, Any], law: EdgeLaw, hard: bool,
            state: tuple[np.ndarray, np.ndarray] | None = None, **options: Any) -> None:
        """Disturb the start pose by a random state unless one is given."""
        context.make_current()
        self.scene = Scene(values)
        self.free = ~self.scene.pinned_nodes()[..., None]
        positions, velocities = state or _scrambled(self.scene)
        self.positions = positions.astype(np.float32)
        self.velocities = (velocities * self.free).astype(np.float32)
        families = ('structural', 'shear') if hard else FAMILIES
        self.layout = choose_layout(self.scene, context)
        self.state = State(self.layout, self.positions, self.scene.pinned_nodes())
        self.state.write(self.positions, self.velocities)
        self.solver = Solver(self.scene, self.layout, families=families, **options)
        self.solver.set_law(law)
        self.solver.assemble(self.state)
        self.make_right_side()
        self.system = ImplicitSystem(
            self.scene, law, self.positions, self.velocities, GRAVITY)

    def make_right_side(self) -> None:
        """Make the right side of the state that is on the device."""
        self.solver.make_right_side(self.state, Forcing(GRAVITY))

    def solve(self) -> np.ndarray:
        """Return the solution of the step."""
        self.solver.solve()
        return self.solver.solution()

    def read_state(self) -> tuple[np.ndarray, np.ndarray]:
        """Return positions and velocities, (rows, cols, 3) each."""
        observer = Observer(self.scene, self.layout)
        records = observer.record(self.state, Forcing(GRAVITY), ())[1]
        observer.delete()
        return tuple(
            np.stack([records[name] for name in names], axis=-1)
            for names in (('x', 'y', 'z'), ('vx', 'vy', 'vz')))

    def random_vector(self, seed: int) -> np.ndarray:
        """Return a random vector that is zero at pinned nodes."""
        random = np.random.default_rng(seed)
        return (random.normal(size=self.positions.shape) * self.free).astype(np.float32)

    def delete(self) -> None:
        """Give the buffers back."""
        self.solver.delete()
        self.state.delete()


def _scrambled(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(7)
    positions = scene.rest_positions()
    reach = 0.2 * min(scene.spacing)
    return (positions + random.uniform(-reach, reach, positions.shape),
            random.normal(size=positions.shape))


@pytest.fixture(scope='module')
def context() -> Iterator[Context]:
    """Return one context for all solvers of a file."""
    context = Context(single_thread=True)
    yield context
    context.close()


@pytest.fixture
def make_case(context: Context) -> Iterator[Callable[..., SolverCase]]:
    """Return a function from scene values and step to a solver case."""
    made = []

    def make(
            values: dict[str, Any], *, dt: float = 0.01, hard: bool = False,
            **options: Any) -> SolverCase:
        scene = Scene({**UNIT, **values})
        law = hard_edges(dt) if hard else implicit_springs(scene, dt)
        made.append(SolverCase(context, scene.values, law, hard, **options))
        return made[-1]

    yield make
    for case in made:
        case.delete()


@pytest.fixture(params=PRECONDITIONERS)
def preconditioner(request: pytest.FixtureRequest) -> str:
    """Return each preconditioner."""
    return request.param
