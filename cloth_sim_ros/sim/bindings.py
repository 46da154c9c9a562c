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

"""Which buffer stands where for the shaders: numbers that stand once, for both sides."""

POSITION_IN = 0
VELOCITY_IN = 1
POSITION_OUT = 2
VELOCITY_OUT = 3
REGION_PUSHES = 4
AIR_OUT = 5
FORCE = 5
MASS = 7
RECORDS = 5
PARTIAL_SUMS = 6
SOLVER_SUMS = 2
SOLVER_DISPATCHES = 3
SOLVER_VECTORS = 5
SOLVER_SYSTEM = 6
SOLVER_SCALARS = 7
SOLVER_TENSION = 7
SOLVER_TALLY = 3
TENSION = 5
AT_LIMIT = 7

DEFINES = {name: value for name, value in list(globals().items()) if name.isupper()}
