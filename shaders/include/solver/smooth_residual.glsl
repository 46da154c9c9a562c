// Copyright 2026 the cloth_sim_ros authors
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

// The first smoothing of the cloth, or the whole preconditioner when that is block-Jacobi.

#include "solver/smoothing_steps.glsl"

void smooth_residual(int index, vec3 residual) {
    store_vector(
        cloth_entry(SMOOTHED_INTO, index), first_step * times(load_cloth_inverse(index), residual));
}
