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
// The system of level 1 from the nodes of the cloth.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/edge_weight.glsl"
#include "solver/edge_tensors.glsl"

#if HAS_BEND
#define REACH 2
#else
#define REACH 1
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

vec4 load_node(ivec2 at) { return load_system(cloth_entry(NODE, node_index(at.x, at.y))); }

Symmetric edge_between(vec4 from, vec4 to, int family) {
    vec3 d = from.xyz - to.xyz;
    return weight_over_square(from, to, d, family) * outer_square(d);
}

Symmetric edge_from(ivec2 at, ivec2 by, int family) {
    return edge_between(load_node(at), load_node(at + by), family);
}

Symmetric finer_edge(ivec2 at, int direction) {
    return edge_from(at, TOWARDS[direction], direction < 2 ? STRUCTURAL : SHEAR);
}

#include "solver/average_edges.glsl"

// What ties a free node to a pinned one.
Symmetric tie(vec4 here, ivec2 at, int family) {
    vec4 there = load_node(at);
    if (there.w >= 0.0) {
        return Symmetric(0.0);
    }
    return edge_between(here, there, family);
}

Symmetric ties(vec4 here, ivec2 at, ivec2 by, int family) {
    return tie(here, at + by, family) + tie(here, at - by, family);
}

Symmetric all_ties(vec4 here, ivec2 at) {
    Symmetric sum = Symmetric(0.0);
#if HAS_STRUCTURAL
    sum += ties(here, at, ivec2(0, 1), STRUCTURAL) + ties(here, at, ivec2(1, 0), STRUCTURAL);
#endif
#if HAS_SHEAR
    sum += ties(here, at, ivec2(1, 1), SHEAR) + ties(here, at, ivec2(1, -1), SHEAR);
#endif
#if HAS_BEND
    sum += ties(here, at, ivec2(0, 2), BEND) + ties(here, at, ivec2(2, 0), BEND);
#endif
    return sum;
}

bool has_pin_around(ivec2 first) {
    float least = 0.0;
    for (int row = -REACH; row < 2 + REACH; ++row) {
        for (int col = -REACH; col < 2 + REACH; ++col) {
            least = min(least, load_node(first + ivec2(row, col)).w);
        }
    }
    return least < 0.0;
}

Symmetric coarse_edge(int row, int col, int direction) {
    if (!stays_inside(row, col, direction)) {
        return Symmetric(0.0);
    }
    ivec2 first = 2 * ivec2(row, col);
    Symmetric edge = average_edge(first, direction);
#if HAS_BEND
    // A bend edge of the cloth is as long as an edge here.
    if (direction < 2) {
        ivec2 by = 2 * TOWARDS[direction];
        edge += edge_from(first, by, BEND) + edge_from(first + ivec2(0, 1), by, BEND)
            + edge_from(first + ivec2(1, 0), by, BEND) + edge_from(first + ivec2(1, 1), by, BEND);
    }
#endif
    return edge;
}

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (!inside(level, row, col)) {
        return;
    }
    int index = level_index(level, row, col);
    ivec2 first = 2 * ivec2(row, col);
    Symmetric edges[DIRECTIONS];
    for (int i = 0; i < DIRECTIONS; ++i) {
        edges[i] = coarse_edge(row, col, i);
    }
    store_edges(level, index, edges);
    float mass = 0.0;
    for (int i = 0; i < 4; ++i) {
        mass += load_node(first + ivec2(i / 2, i % 2)).w != 0.0 ? 1.0 : 0.0;
    }
    Symmetric ground = scaled_identity(mass);
    // A loop ends where no invocation beside this one goes on; a branch costs llvmpipe the same
    // either way.
    int near_pin = has_pin_around(first) ? 4 : 0;
    for (int i = 0; i < near_pin; ++i) {
        ivec2 at = first + ivec2(i / 2, i % 2);
        vec4 here = load_node(at);
        if (is_free(here)) {
            ground += all_ties(here, at);
        }
    }
    store_symmetric(level, GROUND, index, ground);
}
