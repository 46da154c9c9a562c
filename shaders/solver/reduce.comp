// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Reduce the partial sums where passes leave them to one of its own.

layout(local_size_x = REDUCE_LOCAL) in;

#if LOADS_TEXTURE
layout(binding = SOLVER_SUMS) uniform samplerBuffer sums_in;
#define LOAD_SUMS(i) texelFetch(sums_in, i).xyz
#else
layout(std430, binding = SOLVER_SUMS) readonly buffer PartialSums { vec4 partial_sums[]; };
#define LOAD_SUMS(i) partial_sums[i].xyz
#endif

#include "solver/reduction.glsl"

void main() {
    reduce(int(gl_LocalInvocationIndex));
}
