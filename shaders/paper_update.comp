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
// The paper's second pass (Tab. 2): velocity and position of each node from force and mass, in
// place. Pinned nodes keep the velocity of their pin, which the paper leaves out.

#include "lattice.glsl"
#include "applied_acceleration.glsl"

layout(local_size_x = UPDATE_LOCAL) in;

layout(std430, binding = POSITION_IN) buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY_IN) buffer Velocity { vec4 velocity[]; };
layout(std430, binding = FORCE) buffer Force { vec4 force[]; };
layout(std430, binding = MASS) readonly buffer Mass { float mass[]; };

uniform float substep;  // [s]

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= ROWS * COLS) {
        return;
    }
    int i = node_index(node / COLS, node % COLS);
    vec3 a = applied_acceleration(i) + force[i].xyz / mass[i];
    velocity[i].xyz += velocity[i].w * substep * a;
    position[i].xyz += substep * velocity[i].xyz;
    force[i] = vec4(0.0);
}
