// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the edges of the marked blocks that come near a limit: a block an invocation.

#include "lattice.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "limit_lists.glsl"

layout(local_size_x = LIST_LOCAL) in;

#include "next_state.glsl"

#if LOADS_TEXTURE
layout(binding = LIMIT_CHANGES) uniform samplerBuffer changes;
vec4 load_change(int index) { return texelFetch(changes, index); }
#else
layout(std430, binding = LIMIT_CHANGES) readonly buffer Changes { vec4 changes[]; };
vec4 load_change(int index) { return changes[index]; }
#endif

uniform float substep;  // [s]
float h = READ_FIRST(substep);

#include "limit_list.glsl"

void main() {
    if (gl_GlobalInvocationID.x < marked_count) {
        list_block(int(lists[MARKED_AT + int(gl_GlobalInvocationID.x)]));
    }
}
