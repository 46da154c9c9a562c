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
# Say what is being done, show how far a long step is, and end it with the set-up.

"""
Compile the shaders of a scene in each mode, so that the driver has them in its cache.

    python scripts/setup/compile_shaders.py config/drape.yaml
"""

import sys

from cloth_sim_ros.api.scene_file import scene_from
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation


def compile_shaders(scene: Scene) -> None:
    """Compile all that each mode can need, for cloths of every size."""
    simulation = Simulation(scene)
    try:
        modes = simulation.available_modes
        for number, mode in enumerate(modes):
            print(f'{number} of {len(modes)} modes compiled', flush=True)
            simulation.set_mode(mode)
            simulation.engines.compile_all()
    finally:
        simulation.close()


def main() -> str | None:
    """Compile for the scene that is named; return why not."""
    try:
        compile_shaders(scene_from(sys.argv[1], {})[0])
    except (ClothSimError, DeviceError) as error:
        return str(error)
    return None


if __name__ == '__main__':
    sys.exit(main())
