// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Pairs of features that may touch: a node and a triangle, or two edges. They are in no order, which
// changes nothing; those of a node and its edges are a chain.

struct Pair {
    uint own;        // feature: 4 times the node that owns it, and which one
    uint other;      // edge likewise, or triangle: twice the node that owns it, and which one
    float distance;  // [m] as it was found last, and what the cells of both had gone by then
    uint next;       // pair of the same node, one more than its place; 0 for none
};

// Room for pairs: those of a node and a triangle stand from the first place on, those of two edges
// from the last one back.
uniform int most_pairs;

layout(binding = SELF_PAIRS) uniform samplerBuffer pair_texels;

// Software reads one texel much faster than four numbers.
Pair pair_of(vec4 texel) {
    return Pair(
        floatBitsToUint(texel.x), floatBitsToUint(texel.y), texel.z, floatBitsToUint(texel.w));
}

Pair load_pair(uint place) { return pair_of(texelFetch(pair_texels, int(place))); }

#ifdef OF_EDGES
// Number of the pair k of an invocation, which has PAIRS_EACH, in rows of at most MOST_GROUPS workgroups.
uint pair_number(int k) {
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * uint(MOST_GROUPS);
    return (group * uint(PAIRS_EACH) + uint(k)) * uint(SELF_LOCAL) + gl_LocalInvocationID.x;
}

// Its place; all are of one kind, as software evaluates all branches that some take.
uint pair_place(int k) {
    uint i = pair_number(k);
    return OF_EDGES == 1 ? uint(most_pairs) - 1u - i : i;
}

bool has_pair(int k) {
    return pair_number(k) < (OF_EDGES == 1 ? edge_pairs : vertex_pairs);
}

layout(binding = SELF_WAYS) uniform samplerBuffer way_texels;

// What both cells of a pair have gone, as cell_ways.glsl has it.
vec2 ways_of(Pair pair) {
    int own = int(pair.own >> 2), other = int(pair.other >> (OF_EDGES == 1 ? 2 : 1));
    return texelFetch(way_texels, own).xy + texelFetch(way_texels, other).xy;
}

// The nodes of a pair: one and the three of a triangle, or two and two.
ivec4 pair_nodes(uint own, uint other) {
#if OF_EDGES
    return ivec4(edge_nodes(int(own)), edge_nodes(int(other)));
#else
    return ivec4(int(own >> 2), face_nodes(int(other)));
#endif
}
#endif
