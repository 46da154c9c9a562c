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

// The matrix times a vector on the cloth, for a block: value in, product out. M + J^T diag(a) J
// over the node mass; the rows of pinned nodes are zero.

#include "solver/cloth_tile.glsl"

vec3 value[TILE][TILE];
vec3 product[TILE][TILE];

void add_to_product(int row, int col, int drow, int dcol, int family, int rest) {
    vec4 from = node[row][col];
    vec4 to = node[row + drow][col + dcol];
    vec3 d = from.xyz - to.xyz;
    float along = dot(d, value[row][col] - value[row + drow][col + dcol]);
    vec3 part = (weight_over_square(from, to, d, family) * along) * d;
    product[row][col] += part;
    product[row + drow][col + dcol] -= part;
}

void load_nodes(ivec2 first) {
    FOR_TILE {
        node[row][col] = load_system(cloth_entry(NODE, tile_index(first, row, col)));
    }
}

void load_values(ivec2 first, int field) {
    FOR_TILE {
        value[row][col] = load_vector(cloth_entry(field, tile_index(first, row, col)));
    }
}

void make_product() {
    FOR_TILE {
        product[row][col] = value[row][col];
    }
    FOR_CLOTH_EDGES(add_to_product)
    FOR_BLOCK {
        if (!is_free(node[row][col])) {
            product[row][col] = vec3(0.0);
        }
    }
}
