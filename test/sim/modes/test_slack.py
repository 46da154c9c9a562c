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

"""A cloth that comes stretched far beyond its limit is brought to it gently, and for good."""

from contextlib import closing

from cloth_sim_ros.sim.modes.slack import Slack
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.limit_scenes import unit_scene
import pytest


def test_slack_begins_where_the_cloth_is_and_goes():
    """The limit jumps, never comes to its place, or begins anew at each look."""
    slack = Slack(0.1)
    slack.see(0.14)
    slack.see(0.6)
    assert slack.limit == 0.1
    slack.forget()
    slack.see(0.6)
    assert slack.limit == pytest.approx(0.6)
    limits = []
    for _ in range(4000):
        slack.spend(0.001)
        slack.see(slack.limit + 0.04)
        limits.append(slack.limit)
    assert limits[0] == pytest.approx(0.6, abs=1e-5)
    assert all(after <= before for before, after in zip(limits, limits[1:]))
    assert limits[-1] == 0.1


def test_a_stretched_cloth_comes_to_its_limit_without_energy():
    """A cloth from mode mass_spring is thrown together, or stays beyond its limit."""
    values = unit_scene(12, 0.0, 0.005, mode='mass_spring')
    with closing(Simulation(Scene(values))) as simulation:
        simulation.advance(0.6)
        start = simulation.snapshot()
        assert start.max_strain > 1.0
        simulation.set_mode('adaptive')
        energies, strains = [], []
        while simulation.time < 3.6:
            simulation.advance(0.05)
            snapshot = simulation.snapshot()
            energies.append(snapshot.total_energy)
            strains.append(snapshot.max_strain)
    scale = start.kinetic_energy + start.elastic_energy
    print(f'measured {(max(energies) - start.total_energy) / scale:.1e} of 0.01 allowed: energy '
          f'gained, strain {strains[-1]:.3f} of 0.12 after 3 s')
    assert max(energies) <= start.total_energy + 0.01 * scale
    assert strains[-1] <= 0.12
