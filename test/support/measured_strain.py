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

"""A run of an adaptive reference, with what the tables hold."""

from cloth_sim_ros.reference.limited_cloth import LimitedCloth
import numpy as np


def strain_and_energy(cloth: LimitedCloth, seconds: float) -> tuple[float, float, float]:
    """Run ``cloth``; return its largest strain, its peak kinetic energy and switches a frame."""
    strains, energies, switches, substeps = [], [], [], []
    for _ in range(round(seconds / cloth.dt)):
        cloth.step()
        strains.append(cloth.max_strain())
        energies.append(cloth.energies().kinetic)
        switches.append(cloth.switched)
        substeps.append(cloth.substeps)
    print(f'measured: {type(cloth).__name__} {cloth.scene.cols} nodes dt {cloth.dt} '
          f'force {cloth.scene["pushes.force"][2]:.3g} N: strain {max(strains):.4f} '
          f'kinetic energy {max(energies):.4g} J switched {np.mean(switches):.2%} a frame '
          f'substeps {sum(substeps) / seconds:.0f} a second')
    return max(strains), max(energies), float(np.mean(switches))
