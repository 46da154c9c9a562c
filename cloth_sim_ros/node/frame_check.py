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


"""Which frames a message may be given in."""

from cloth_sim_ros.files.echo import shown
from cloth_sim_ros.sim.errors import ClothSimError


def check_frame(given: str, own: str) -> None:
    """Raise ClothSimError unless the frame ``given`` is the cloth's ``own``, or empty."""
    if given not in ('', own):
        raise ClothSimError(
            f'its frame is {shown(given)} but the frame of the cloth is {shown(own)}: transform '
            'it to the latter, or choose that as the fixed frame')
