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


"""Hard edges that become stiffer, by shorter substeps or by hardening, gain no energy."""

from collections.abc import Iterator
from contextlib import closing

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.layout import choose_layout
from cloth_sim_ros.sim.modes.rest_offsets import RestOffsets
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.study.random_limits import random_scene
import numpy as np
import pytest

_HARD = ('structural', 'shear')
_STRETCH = 1.01


class _Offsets:
    """Offsets of a cloth stretched by 1 %, and what is read back of them."""

    def __init__(self, context: Context, time: float = 0.3) -> None:
        """Stretch it."""
        self.scene = Scene({'rows': 5, 'cols': 4, 'mode': 'constraint'})
        layout = choose_layout(self.scene, context)
        self.state = State(
            layout, _STRETCH * self.scene.rest_positions(), self.scene.pinned_nodes())
        self._solver = Solver(self.scene, layout, families=_HARD, keeps_tension=True)
        self.offsets = RestOffsets(self.scene, layout, _HARD, time, self._solver.tensions)

    def hold(self, length: float, hardness: float = 1.0) -> None:
        """Let edges be held so from now on."""
        self.offsets.take_up(
            self.state, edge_law(self.scene, length, hard=_HARD, springs=(), hardness=hardness))

    def largest(self) -> float:
        """Return the largest offset along a row, over the extension of such an edge."""
        tensions = self._solver.tensions
        values = np.empty(tensions._zeros.shape, dtype=np.float32)
        tensions.buffer.read_into(values)
        return float(np.abs(values[2, :, 0]).max() / (
            (_STRETCH - 1.0) * self.scene.spacing[0]))

    def close(self) -> None:
        """Give everything back."""
        self._solver.delete()
        self.state.delete()


@pytest.fixture
def context() -> Iterator[Context]:
    """Return a context."""
    context = Context(single_thread=True)
    yield context
    context.close()


def test_shorter_substeps_keep_the_tension(context):
    """A stretched edge would pull four times as hard, with four times the energy."""
    with closing(_Offsets(context)) as cloth:
        cloth.hold(0.002)
        assert cloth.largest() == 0.0
        cloth.hold(0.001)
        # e / 4 is left of the extension e, at 4 times the stiffness.
        assert cloth.largest() == pytest.approx(0.75, rel=1e-4)
        cloth.hold(0.0005)
        assert cloth.largest() == pytest.approx(1.0 - 1.0 / 16.0, rel=1e-4)


def test_longer_substeps_give_it_back(context):
    """A hanging cloth would creep, as its substeps go to and fro."""
    with closing(_Offsets(context)) as cloth:
        for length in (0.002, 0.001, 0.002):
            cloth.hold(length)
        assert cloth.largest() == pytest.approx(0.0, abs=1e-4)
        cloth.hold(0.004)
        assert cloth.largest() == pytest.approx(0.0, abs=1e-4)


def test_hardening_keeps_the_tension(context):
    """Hardening would lift a cloth that hangs in soft springs, and throw it."""
    with closing(_Offsets(context)) as cloth:
        cloth.hold(0.001, hardness=0.0)
        cloth.hold(0.001, hardness=0.5)
        laws = [edge_law(cloth.scene, 0.001, hard=_HARD, hardness=hardness)
                for hardness in (0.0, 0.5)]
        assert cloth.largest() == pytest.approx(
            1.0 - laws[0].pulls[0] / laws[1].pulls[0], rel=1e-4)


def test_offsets_decay(context):
    """Edges would stay too long for ever."""
    with closing(_Offsets(context, time=0.2)) as cloth:
        cloth.hold(0.002)
        cloth.hold(0.001)
        cloth.offsets.spend(0.2)
        assert cloth.offsets.share(0.0) == pytest.approx(np.exp(-1.0))
        cloth.hold(0.001)
        assert cloth.largest() == pytest.approx(0.75 * np.exp(-1.0), rel=1e-4)
        assert cloth.offsets.share(0.0) == 1.0


def test_an_edge_that_came_back_needs_none(context):
    """Edges would push where nothing has pressed them."""
    with closing(_Offsets(context)) as cloth:
        cloth.hold(0.002)
        cloth.hold(0.001)
        rest = cloth.scene.rest_positions()
        cloth.state.write(rest, np.zeros_like(rest))
        cloth.hold(0.001)
        assert cloth.largest() == pytest.approx(0.0, abs=1e-3)


def test_no_time_has_no_offsets(context):
    """People could not have the paper's method."""
    with closing(_Offsets(context, time=0.0)) as cloth:
        cloth.hold(0.002)
        cloth.hold(0.001)
        assert cloth.largest() == 0.0
        assert cloth.offsets.share(0.001) == 0.0


@pytest.mark.parametrize(('seed', 'steps'), [(1, 14), (9, 10)])
def test_a_cloth_that_is_caught_gains_no_energy(context, seed, steps):
    """Each catch would throw it up again, higher than it came from."""
    with closing(Simulation(
            Scene({**random_scene(seed), 'mode': 'constraint'}), context=context)) as run:
        account = EnergyAccount(run)
        longest, most = 0.0, 0
        for _ in range(steps):
            seen = account.step()
            longest, most = max(longest, seen.max_strain), max(most, seen.substeps)
        print(f'measured scene {seed}: gain {account.gained:.1e}, strain {longest:.1e}, '
              f'{most} substeps')
        # It was caught: without that nothing is shown.
        assert most >= 4
        assert account.gained <= 0.02
        assert longest <= 0.05
