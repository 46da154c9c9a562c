// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Candidates for contact in an explicit substep: blocks of nodes, listed by mass_spring_step.comp,
// and their nodes, listed by near_nodes.comp for contact.comp; in no order. Each
// list has the workgroups of the pass that reads it.

#define NEAR_LOCAL 32u
// Blocks that a workgroup of near_nodes.comp takes.
#define BLOCKS_AT_ONCE (NEAR_LOCAL / uint(BLOCK * BLOCK))

struct Near {
    uint index;   // of a node, or of the first one of a block
    uint bodies;  // that it may come near to, one bit each
};

layout(std430, binding = NEAR_BLOCKS) buffer NearBlocks {
    uint block_groups_x;
    uint block_groups_y;
    uint block_groups_z;
    uint near_block_count;
    uint node_groups_x;
    uint node_groups_y;
    uint node_groups_z;
    uint near_node_count;
    Near near[];  // blocks, and nodes after them
};

// What another pass has listed, by the texels that software loads faster (state_in.glsl): two of
// the counts, and one for each two entries.
#if LOADS_TEXTURE
layout(binding = NEAR_BLOCKS) uniform samplerBuffer near_texels;

uint listed_blocks() { return floatBitsToUint(texelFetch(near_texels, 0).w); }

uint listed_nodes() { return floatBitsToUint(texelFetch(near_texels, 1).w); }

Near listed_at_place(uint place) {
    uvec4 two = floatBitsToUint(texelFetch(near_texels, 2 + int(place / 2u)));
    return place % 2u == 0u ? Near(two.x, two.y) : Near(two.z, two.w);
}
#else
uint listed_blocks() { return near_block_count; }

uint listed_nodes() { return near_node_count; }

Near listed_at_place(uint place) { return near[place]; }
#endif
