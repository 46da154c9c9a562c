// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The systems of the last levels, each from that of the level above, and the inverses of their
// diagonal blocks, in one workgroup.

#define LEVEL_VARIES
#define SYSTEM_ACCESS coherent
#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/coarsen_level.glsl"
#include "solver/invert_level.glsl"

layout(local_size_x = TOGETHER_LOCAL) in;

uniform int first_level;   // whose system is there where it is level 1
uniform int coarsest;

#define FOR_NODES \
    for (int i = int(gl_LocalInvocationIndex), cols = level_shape[level].y, \
            nodes = level_shape[level].x * cols; i < nodes; i += TOGETHER_LOCAL)

void main() {
    for (level = max(first_level, 2); level <= coarsest; ++level) {
        FOR_NODES {
            coarsen_node(i / cols, i % cols);
        }
        memoryBarrierBuffer();
        barrier();
    }
    for (level = first_level; level <= coarsest; ++level) {
        FOR_NODES {
            invert_node(i / cols, i % cols);
        }
    }
}
