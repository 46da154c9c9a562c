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

"""The simulation modes: small objects that know the passes of one substep."""

from cloth_sim_ros.sim.modes.adaptive import Adaptive
from cloth_sim_ros.sim.modes.constraint import Constraint
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.modes.mode import finish
from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.modes.mode import Pieces

__all__ = ('AVAILABLE', 'Mode', 'Pieces', 'finish')

AVAILABLE: dict[str, type[Mode]] = {
    mode.name: mode for mode in (MassSpring, Constraint, Adaptive)}
