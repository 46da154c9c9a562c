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
// A row of J, and what stands on the right side for it: disConstraint(), Vect() and Rhs() of the
// paper, with unit rows. Begins conjugate gradients from zero.

#include "paper_solver/buffers.glsl"

layout(local_size_x = 1024) in;

uniform float substep;  // [s]

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= CONSTRAINTS) {
        return;
    }
    ivec2 ends = ivec2(edges[i].xy);
    vec3 d = nodes[ends.x].xyz - nodes[ends.y].xyz;
    vec3 direction = d / length(d);
    for (int axis = 0; axis < 3; ++axis) {
        a[VALUES * i + axis] = direction[axis];
        a[VALUES * i + 3 + axis] = -direction[axis];
        ja[VALUES * i + axis] = 3 * ends.x + axis;
        ja[VALUES * i + 3 + axis] = 3 * ends.y + axis;
    }
    vec3 relative = nodes[NODES + ends.x].xyz - nodes[NODES + ends.y].xyz;
    float right = (length(d) - edges[i].z) / (substep * substep)
        + dot(direction, relative) / substep;
    ENTRY(LAMBDA, i) = 0.0;
    ENTRY(RESIDUAL, i) = right;
    ENTRY(DIRECTION, i) = right;
    row_count[i] = 0u;
}
