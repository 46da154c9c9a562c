// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The system of level 1 from the nodes of the cloth.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/edge_tensors.glsl"
#include "solver/cloth_edge_block.glsl"
#include "solver/free_directions.glsl"
#if HAS_RIGIDITY
#include "solver/coarse_bending.glsl"
#endif

#if HAS_BEND
#define REACH 2
#else
#define REACH 1
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

Symmetric finer_edge(ivec2 at, int direction) {
    return edge_block(at, TOWARDS[direction], direction);
}

#include "solver/average_edges.glsl"

// 1 for a node that stays where it is.
bool is_fixed(ivec2 at) {
    return load_node(at).w < 0.0 || is_held(node_index(at.x, at.y));
}

// What ties a free node to a fixed one: by an edge that begins here, or ends here.
Symmetric ties(ivec2 at, ivec2 by, int edge) {
    Symmetric sum = Symmetric(0.0);
    if (is_fixed(at + by)) {
        sum += edge_block(at, by, edge);
    }
    if (is_fixed(at - by)) {
        sum += edge_block(at - by, by, edge);
    }
    return sum;
}

// The two kinds of a family are added to each other first: a mirrored cloth rounds alike.
#define ADD_TIES(SUMS, EDGE, DROW, DCOL, FAMILY, REST) \
    SUMS[FAMILY] += ties(at, ivec2(DROW, DCOL), EDGE);

Symmetric all_ties(ivec2 at) {
    Symmetric of_family[] =
        Symmetric[](Symmetric(0.0), Symmetric(0.0), Symmetric(0.0));
    EACH_EDGE(ADD_TIES, of_family)
    return of_family[STRUCTURAL] + of_family[SHEAR] + of_family[BEND];
}

bool has_fixed_around(ivec2 first) {
    bool has_fixed = false;
    for (int row = -REACH; row < 2 + REACH; ++row) {
        for (int col = -REACH; col < 2 + REACH; ++col) {
            has_fixed = has_fixed || is_fixed(first + ivec2(row, col));
        }
    }
    return has_fixed;
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
        int bend = 4 + direction;
        edge += edge_block(first, by, bend) + edge_block(first + ivec2(0, 1), by, bend)
            + edge_block(first + ivec2(1, 0), by, bend)
            + edge_block(first + ivec2(1, 1), by, bend);
    }
#endif
#if HAS_RIGIDITY
    edge += bending_edge(level, direction);
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
    int near_fixed = has_fixed_around(first) ? 4 : 0;
    for (int i = 0; i < near_fixed; ++i) {
        ivec2 at = first + ivec2(i / 2, i % 2);
        if (load_node(at).w > 0.0) {
            ground += all_ties(at);
        }
    }
#if HAS_CONTACT
    for (int i = 0; i < 4; ++i) {
        ivec2 at = first + ivec2(i / 2, i % 2);
        if (inside(0, at.x, at.y)) {
            ground += grip_tensor(node_index(at.x, at.y));
        }
    }
#endif
    store_symmetric(level, GROUND, index, ground);
}
