# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
