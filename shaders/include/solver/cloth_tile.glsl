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

// The tile of cloth nodes that a block needs, and a walk over all its edges.

#include "solver/edge_weight.glsl"
#include "block_edges.glsl"

#if HAS_BEND
#define REACH 2
#else
#define REACH 1
#endif
#define TILE (BLOCK + 2 * REACH)

vec4 node[TILE][TILE];

ivec2 first_of_block() { return ivec2(gl_GlobalInvocationID.xy) * BLOCK; }

bool in_cloth(ivec2 first) { return first.x < COLS && first.y < ROWS; }

int tile_index(ivec2 first, int row, int col) {
    return node_index(first.y + row - REACH, first.x + col - REACH);
}

bool is_in_block(int row, int col) {
    return row >= REACH && row < REACH + BLOCK && col >= REACH && col < REACH + BLOCK;
}

// ADD(row, col, drow, dcol, family, rest)
#if HAS_STRUCTURAL
#define FOR_STRUCTURAL(ADD) \
    FOR_BLOCK_EDGES(0, 1, ADD(row, col, 0, 1, STRUCTURAL, 0)) \
    FOR_BLOCK_EDGES(1, 0, ADD(row, col, 1, 0, STRUCTURAL, 1))
#else
#define FOR_STRUCTURAL(ADD)
#endif
#if HAS_SHEAR
#define FOR_SHEAR(ADD) \
    FOR_BLOCK_EDGES(1, 1, ADD(row, col, 1, 1, SHEAR, 2)) \
    FOR_BLOCK_EDGES(1, -1, ADD(row, col, 1, -1, SHEAR, 2))
#else
#define FOR_SHEAR(ADD)
#endif
#if HAS_BEND
#define FOR_BEND(ADD) \
    FOR_BLOCK_EDGES(0, 2, ADD(row, col, 0, 2, BEND, 3)) \
    FOR_BLOCK_EDGES(2, 0, ADD(row, col, 2, 0, BEND, 4))
#else
#define FOR_BEND(ADD)
#endif
#define FOR_CLOTH_EDGES(ADD) FOR_STRUCTURAL(ADD) FOR_SHEAR(ADD) FOR_BEND(ADD)
