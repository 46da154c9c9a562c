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

"""What brings edges back to their limit is paid from what the limit took."""

from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.modes.energy_tank import EnergyTank
from cloth_sim_ros.sim.modes.sweeps import Held
from cloth_sim_ros.sim.scene import Scene
import pytest

_SCENE = Scene({'rows': 4, 'cols': 5, 'node_mass': 0.1, 'gravity': [0.0, 0.0, 0.0]})
_NOWHERE = Forcing((0.0, 0.0, 0.0))
_SHORT = 1e-6


@pytest.fixture
def tank() -> EnergyTank:
    """Return the tank of a cloth in which edges may stretch by 1 mm."""
    return EnergyTank(_SCENE, 1e-3)


def _book(tank, taken, cost, square=0.0, forcing=_NOWHERE, length=_SHORT):
    tank.book(Held(pull=1.0, taken=taken, cost=cost, square=square), forcing, length)


def test_an_overshoot_nobody_pulls_at_comes_back_as_asked_for(tank):
    """A cloth that begins beyond its limit would wait for energy it does not need."""
    assert tank.share(0.7, _SHORT) == 0.7
    assert not tank.is_overdrawn


def test_what_was_taken_pays_for_what_comes_back(tank):
    """A caught cloth would be thrown, or would stay beyond its limit with energy to spare."""
    _book(tank, taken=0.3, cost=1.0)
    assert tank.share(0.2, _SHORT) == 0.2
    assert tank.share(0.9, _SHORT) == pytest.approx(0.3)
    _book(tank, taken=-0.1, cost=2.0)
    assert tank.share(0.9, _SHORT) == pytest.approx(0.1)


def test_without_energy_edges_come_back_slowly(tank):
    """An edge would stay beyond its limit for ever."""
    _book(tank, taken=-1.0, cost=1.0)
    assert tank.is_overdrawn
    assert tank.share(0.5, 3e-3) == pytest.approx(0.01)


def test_a_debt_is_forgotten(tank):
    """Energy that came from nothing once would keep edges beyond their limit from then on."""
    _book(tank, taken=-1.0, cost=1.0)
    for _ in range(500):
        _book(tank, taken=0.0, cost=1.0, length=1e-2)
    _book(tank, taken=1e-3, cost=1.0)
    assert not tank.is_overdrawn


def test_no_more_is_kept_than_brings_all_back(tank):
    """What a hard catch took would throw the cloth when it is caught again."""
    _book(tank, taken=100.0, cost=1.0)
    _book(tank, taken=0.0, cost=10.0)
    assert tank.share(1.0, _SHORT) == pytest.approx(0.1)


def test_credit_follows_what_moves_and_what_is_applied(tank):
    """A cloth at rest would sink below its limit, or a light one be thrown by its own credit."""
    # A hundredth of 0.5 m v^2 of all nodes.
    _book(tank, taken=0.0, cost=1.0, square=40.0)
    assert tank.share(1.0, _SHORT) == pytest.approx(0.01 * 0.5 * 0.1 * 40.0)
    # The weight of 20 nodes over 1 mm, and a push on two nodes besides.
    weight = Forcing((0.0, 0.0, -10.0))
    _book(tank, taken=0.0, cost=1.0, forcing=weight)
    assert tank.share(1.0, _SHORT) == pytest.approx(20 * 0.1 * 10.0 * 1e-3)
    pushed = Forcing((0.0, 0.0, -10.0), sum_in_regions=100.0)
    _book(tank, taken=0.0, cost=1.0, forcing=pushed)
    assert tank.share(1.0, _SHORT) == pytest.approx((20 * 10.0 + 100.0) * 0.1 * 1e-3)


def test_a_limit_that_holds_nothing_owes_nothing(tank):
    """A cloth would pay for what it did before it came within its limit."""
    _book(tank, taken=-1.0, cost=1.0)
    tank.book(Held(pull=0.0, taken=0.0, cost=0.0, square=1.0), _NOWHERE, _SHORT)
    assert not tank.is_overdrawn
    assert tank.share(0.4, _SHORT) == 0.4
