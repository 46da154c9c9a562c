// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The system of level 1 from the nodes of the cloth.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/edge_tensors.glsl"
#include "cells.glsl"
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

#if HAS_CONTACT
mat3 whole(Symmetric s) {
    return mat3(s[0].x, s[1].x, s[1].y, s[1].x, s[0].y, s[1].z, s[1].y, s[1].z, s[0].z);
}

// The directions that the surface in contact with a node blocks, as a projection.
mat3 taken(ivec2 at) {
    return load_node(at).w == 0.0 ? mat3(0.0)
        : is_fixed(at) ? mat3(1.0) : whole(taken_directions(node_index(at.x, at.y)));
}

bool is_tied(ivec2 at) {
    return load_node(at).w < 0.0 || load_contact(node_index(at.x, at.y)).w > 0.0;
}

// Stiffness between two nodes by the directions that are blocked in one of them only.
Symmetric tie(ivec2 at, ivec2 other, Symmetric block) {
    mat3 apart = taken(other) - taken(at);
    mat3 product = apart * whole(block) * apart;
    return Symmetric(
        vec3(product[0][0], product[1][1], product[2][2]),
        vec3(product[0][1], product[0][2], product[1][2]));
}
#else
bool is_tied(ivec2 at) { return is_fixed(at); }

Symmetric tie(ivec2 at, ivec2 other, Symmetric block) {
    return is_fixed(other) ? block : Symmetric(0.0);
}
#endif

// Stiffness that ties a free node to others, by the edges that begin or end here.
Symmetric ties(ivec2 at, ivec2 by, int edge) {
    return tie(at, at + by, edge_block(at, by, edge))
        + tie(at, at - by, edge_block(at - by, by, edge));
}

// The two kinds of a family are added to each other first: a mirrored cloth rounds alike.
#define ADD_TIES(SUMS, EDGE, DROW, DCOL, FAMILY, REST) \
    SUMS[FAMILY] += ties(at, ivec2(DROW, DCOL), EDGE);

Symmetric all_ties(ivec2 at) {
    Symmetric of_family[] =
        Symmetric[](Symmetric(0.0), Symmetric(0.0), Symmetric(0.0));
    EACH_EDGE(ADD_TIES, of_family)
    Symmetric sum = of_family[STRUCTURAL] + of_family[SHEAR] + of_family[BEND];
#if HAS_CONTACT && HAS_RIGIDITY
    // A kink of one node stores as much as edges of three times the rigidity.
    Symmetric along_row = scaled_identity(3.0 * bending_bound[0]);
    Symmetric along_column = scaled_identity(3.0 * bending_bound[1]);
    sum += tie(at, at + ivec2(0, 1), along_row) + tie(at, at - ivec2(0, 1), along_row);
    sum += tie(at, at + ivec2(1, 0), along_column) + tie(at, at - ivec2(1, 0), along_column);
#endif
    return sum;
}

bool has_tied_around(ivec2 first) {
    bool has_tied = false;
    for (int row = -REACH; row < 2 + REACH; ++row) {
        for (int col = -REACH; col < 2 + REACH; ++col) {
            has_tied = has_tied || is_tied(first + ivec2(row, col));
        }
    }
    return has_tied;
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
        vec4 node = load_node(first + ivec2(i / 2, i % 2));
        mass += node.w != 0.0 ? mass_share(node) : 0.0;
    }
#if HAS_CELLS
    mass = max(mass, 0.25);
#endif
    Symmetric ground = scaled_identity(mass);
    // A loop ends where no invocation beside this one goes on; a branch costs llvmpipe the same
    // either way.
    int near_tied = has_tied_around(first) ? 4 : 0;
    for (int i = 0; i < near_tied; ++i) {
        ivec2 at = first + ivec2(i / 2, i % 2);
        if (load_node(at).w > 0.0) {
            ground += all_ties(at);
        }
    }
#if HAS_CONTACT
    for (int i = 0; i < near_tied; ++i) {
        ivec2 at = first + ivec2(i / 2, i % 2);
        if (inside(0, at.x, at.y)) {
            ground += mass_share(load_node(at)) * grip_tensor(node_index(at.x, at.y));
        }
    }
#if HAS_SURFACE
    for (int i = 0; i < 4; ++i) {
        ivec2 at = first + ivec2(i / 2, i % 2);
        if (inside(0, at.x, at.y)) {
            ground += load_surface_ground(node_index(at.x, at.y));
        }
    }
#endif
#endif
    store_symmetric(level, GROUND, index, ground);
}
