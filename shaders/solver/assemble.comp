// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Invert the diagonal block of each node of the cloth.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "cells.glsl"
#include "solver/cloth_edge_block.glsl"
#if HAS_CONTACT
#include "solver/free_directions.glsl"
#endif
#if HAS_RIGIDITY

uniform float bending_bound[2];  // with damping in any direction, over the node mass
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

// The two kinds of a family are added to each other first: a mirrored cloth rounds alike.
#define ADD_BLOCKS(SUMS, EDGE, DROW, DCOL, FAMILY, REST) \
    SUMS[FAMILY] += edge_blocks(at, ivec2(DROW, DCOL), EDGE);

#if HAS_RIGIDITY
float share_of_line(ivec2 centre, ivec2 by) {
    return line_share(load_node(centre - by), load_node(centre), load_node(centre + by), by.x);
}

// The squares of a node's parts in the lines of three that it is in, by their shares.
float bending_at(ivec2 at, ivec2 by) {
    return share_of_line(at - by, by) + 4.0 * share_of_line(at, by)
        + share_of_line(at + by, by);
}
#endif

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.yx);
    if (at.x >= ROWS || at.y >= COLS) {
        return;
    }
    Symmetric of_family[] =
        Symmetric[](Symmetric(0.0), Symmetric(0.0), Symmetric(0.0));
    EACH_EDGE(ADD_BLOCKS, of_family)
#if HAS_CELLS
    // Not 0 where there is no node, whose inverse has to be finite.
    float mass = max(mass_share(load_node(at)), 0.25);
#else
    float mass = 1.0;
#endif
    Symmetric diagonal = scaled_identity(mass);
    diagonal += of_family[STRUCTURAL];
    diagonal += of_family[SHEAR];
    diagonal += of_family[BEND];
#if HAS_RIGIDITY
    diagonal += scaled_identity(
        bending_bound[0] * bending_at(at, ivec2(0, 1))
        + bending_bound[1] * bending_at(at, ivec2(1, 0)));
#endif
    float moves = load_node(at).w > 0.0 ? 1.0 : 0.0;
    int index = node_index(at.x, at.y);
#if HAS_SURFACE
    diagonal += load_surface_ground(index);
#endif
    Symmetric inverse_block = moves * inverse_above(diagonal, mass);
#if HAS_CONTACT
    vec4 contact = load_contact(index);
    // As in coarsen_cloth.comp.
    for (uint asks = contact.w > 0.0 ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        vec4 grip = load_grip(index);
        diagonal += mass * grip.w * (scaled_identity(1.0) - outer_square(grip.xyz));
        inverse_block = moves * inverse_above(diagonal, mass);
        // Inverse of the block along the surface, or the line, that the node slides on.
        vec3 image = times(inverse_block, contact.xyz);
        Symmetric in_surface =
            inverse_block - outer_square(image) / max(dot(contact.xyz, image), 1e-30);
        Symmetric on_line = moves * outer_square(contact.xyz)
            / max(dot(contact.xyz, times(diagonal, contact.xyz)), mass);
        inverse_block = contact.w == 2.0 ? in_surface : on_line;
        inverse_block *= contact.w == 1.0 ? 0.0 : 1.0;
    }
#endif
    system_data[cloth_entry(INVERSE, index)] = vec4(inverse_block[0], 0.0);
    system_data[cloth_entry(INVERSE + 1, index)] = vec4(inverse_block[1], 0.0);
}
