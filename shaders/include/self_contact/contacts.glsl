// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts of the cloth with itself, and what they do to nodes. Impulses of a node are sums of
// whole numbers, which are the same in any order.

struct SelfContact {
    ivec4 nodes;
    vec4 normal;    // from the second feature to the first, and the gap [m]
    vec4 impulse;   // on the first [m/s of a node amid the cloth], and the pair as bits
    vec3 weights;   // of the first three nodes; all four add up to 0
    float share;    // what an impulse of 1 changes at most, whatever other contacts do [1]
};

struct SelfNode {
    int impulse[3];
    uint shares;     // of its weights in contacts, in parts of SHARE_PARTS
    int way[3];      // out of layers that are too near
    uint cut;        // bits of the share of its way that it may go
    uint listed;     // of the list of nodes with contacts, which stands here: a node
    uint spare[3];   // so that it is three texels
};

#define SHARE_PARTS 1048576.0

layout(std430, binding = SELF_NODES) buffer SelfNodes { SelfNode self_nodes[]; };

// Largest impulse of a contact over the speed in a substep [1], and range of whole numbers over it.
#define IMPULSE_RANGE 64.0
#define SUM_RANGE 4096.0

uniform float least_speed_unit;  // [m/s] that gravity gives in a substep

// Speed by which impulses are measured [m/s].
float speed_unit() {
    return half_diagonal(least_speed, most_speed) + least_speed_unit;
}

// Unit of whole numbers [m/s].
float impulse_unit(float speed) { return speed * (SUM_RANGE / 2147483648.0); }

float last_weight(vec3 weights) { return -(weights.x + weights.y + weights.z); }

vec4 all_weights(vec3 weights) { return vec4(weights, last_weight(weights)); }

ivec3 in_units(float weight, vec3 impulse, float unit) {
    return ivec3(round(weight * impulse / unit));
}
