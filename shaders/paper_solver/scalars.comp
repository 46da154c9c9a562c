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

#version 430 core
// What conjugate gradients make of a scalar product.

#include "paper_solver/buffers.glsl"

layout(local_size_x = 1) in;

#define AT_START 0
#define AFTER_PRODUCT 1
#define AFTER_UPDATE 2

uniform int group_count;
uniform int stage;

void main() {
    float sum = 0.0;
    for (int group = 0; group < group_count; ++group) {
        sum += scalars[GROUP_SUMS + group];
    }
    if (stage == AFTER_PRODUCT) {
        scalars[STEP_LENGTH] = scalars[SQUARE] / sum;
        return;
    }
    if (stage == AT_START) {
        scalars[SQUARE_START] = sum;
    } else {
        scalars[KEEP] = sum / scalars[SQUARE];
    }
    scalars[SQUARE] = sum;
}
