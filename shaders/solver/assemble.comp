// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Invert the diagonal block of each node of the cloth.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/cloth_edge_block.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.yx);
    if (at.x >= ROWS || at.y >= COLS) {
        return;
    }
    Symmetric diagonal = scaled_identity(1.0);
#if HAS_STRUCTURAL
    diagonal += EDGE_BLOCKS(at, ivec2(0, 1), 0) + EDGE_BLOCKS(at, ivec2(1, 0), 1);
#endif
#if HAS_SHEAR
    diagonal += EDGE_BLOCKS(at, ivec2(1, 1), 2) + EDGE_BLOCKS(at, ivec2(1, -1), 3);
#endif
#if HAS_BEND
    diagonal += EDGE_BLOCKS(at, ivec2(0, 2), 4) + EDGE_BLOCKS(at, ivec2(2, 0), 5);
#endif
    float moves = load_node(at).w > 0.0 ? 1.0 : 0.0;
    Symmetric inverse_block = moves * inverse_above(diagonal, 1.0);
    int index = node_index(at.x, at.y);
    system_data[cloth_entry(INVERSE, index)] = vec4(inverse_block[0], 0.0);
    system_data[cloth_entry(INVERSE + 1, index)] = vec4(inverse_block[1], 0.0);
}
