// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts of the cloth with itself, and what they do to nodes. Impulses of a node are sums of
// whole numbers, which are the same in any order.

struct SelfContact {
    ivec4 nodes;
    vec4 normal;    // from the second feature to the first, and the gap [m]
    // On the first when it was found [m/s of a node amid the cloth], and the pair as bits.
    vec4 impulse;
    vec3 weights;   // of the first three nodes; all four add up to 0
    float least;    // [m] distance at which it acts; negative until it does
};

struct SelfNode {
    int impulse[3];
    uint shares;     // of its weights in contacts that act, in parts of SHARE_PARTS
    int way[3];      // out of layers that are too near
    uint cut;        // bits of the share of its way that it may go
    uint listed;     // of the list of nodes with contacts, which stands here: a node
    uint contacts;   // of it, whether they act or not
    uint first;      // texel of its entries, two in each
    uint entries;    // of it: contacts that act
};

#define SHARE_PARTS 1048576.0

layout(std430, binding = SELF_NODES) buffer SelfNodes { SelfNode self_nodes[]; };

// Largest impulse of a contact over the speed in a substep [1], and range of whole numbers over it.
#define IMPULSE_RANGE 64.0
#define SUM_RANGE 4096.0

uniform float impulse_unit;  // [m/s] of a 1: at least the speed in a substep over their range

// Largest impulse of a contact [m/s].
float most_impulse() { return impulse_unit * (2147483648.0 / SUM_RANGE * IMPULSE_RANGE); }

// Gap of a contact [m]; within what positions are rounded by, there is none.
float gap_of(float gap, vec3 x) {
    float rounding = 4e-7 * max(abs(x.x), max(abs(x.y), abs(x.z))) + 1e-9;
    return sign(gap) * max(abs(gap) - rounding, 0.0);
}

float last_weight(vec3 weights) { return -(weights.x + weights.y + weights.z); }

vec4 all_weights(vec3 weights) { return vec4(weights, last_weight(weights)); }

uint in_shares(float weight) { return uint(ceil(abs(weight) * SHARE_PARTS)); }

#if LISTS_ACTING
// The contacts that act, in no order: impulse [m/s of a node amid the cloth], and place as bits.
layout(std430, binding = SELF_ACTING) writeonly buffer SelfActing { vec4 acting[]; };
// Number of a contact that acts, and bits of the weight of a node in it [1]: in no order, those of a
// node side by side.
layout(std430, binding = SELF_ENTRIES) writeonly buffer SelfEntries { uvec2 entries[]; };

// List a contact among those that act, and among those of its nodes.
void list_acting(uint place, ivec4 nodes, vec4 weights, vec3 impulse) {
    uint at = atomicAdd(acting_count, 1u);
    acting[at] = vec4(impulse, uintBitsToFloat(place));
    atomicAdd(acting_groups[0], at % SELF_LOCAL == 0u ? 1u : 0u);
    for (int k = 0; k < 4; ++k) {
        uint share = in_shares(weights[k]);
        if (share > 0u) {
            atomicAdd(self_nodes[nodes[k]].shares, share);
            uint entry = atomicAdd(self_nodes[nodes[k]].entries, 1u);
            entries[2u * self_nodes[nodes[k]].first + entry] =
                uvec2(at, floatBitsToUint(weights[k]));
        }
    }
}
#endif
