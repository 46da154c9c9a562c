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

"""How many substeps explicit springs need, and whether they are allowed."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import MOST_SUBSTEPS
from cloth_sim_ros.sim.stability import choose_substeps
from cloth_sim_ros.sim.stability import safe_substep
from cloth_sim_ros.sim.stability import stability_limit


def spring_substeps(scene: Scene, mode: str, *, check_stability: bool = True) -> int:
    """
    Return the substeps of dt that ``scene`` asks for, or those that are stable.

    :param mode: its name, for the message
    :raises ClothSimError: when they are too many, or too long to be stable
    """
    substeps = choose_substeps(scene) if scene['auto_substeps'] else scene['substeps']
    limit = stability_limit(scene)
    if substeps > MOST_SUBSTEPS:
        most = safe_substep(scene) * MOST_SUBSTEPS
        raise ClothSimError(
            f'dt {scene["dt"]:g} s would take {substeps:.3g} substeps of the {limit:.3g} s that '
            f'are stable, more than {MOST_SUBSTEPS}: set dt <= {most:.3g}, or take softer '
            'springs, less damping or a larger node mass')
    if check_stability and scene['dt'] / substeps > limit:
        most = safe_substep(scene) * substeps
        raise ClothSimError(
            f'dt {scene["dt"]:g} s in {substeps} substeps is above the stability limit '
            f'{limit:.3g} s of a substep in mode {mode} (node mass {scene.node_mass:.3g} kg): '
            f'set dt <= {most:.3g}, or auto_substeps: true')
    return substeps
