// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Find the impulses that hold the listed edges within their limits at the end of a substep, and
// give them to their nodes: one workgroup, docs/explanation/adaptive.md.
// LISTS 1: list them before, where ``lists_first`` is set. A dispatch of limit/list.comp takes as
// long as the listing, on software and a small cloth.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "limit_lists.glsl"
#include "limit_law.glsl"

layout(local_size_x = LOCAL) in;

uniform float substep;  // [s]

#include "limit_impulses.glsl"
#include "limit_give.glsl"

// What was solved for since the host has looked, and in this step of dt.
struct Tally {
    uint substeps;      // in which edges were listed
    uint most_listed;   // in a substep
    uint most_active;
    uint most_rounds;
    uint unreached;     // substeps in which the rounds did not suffice
    float edge_rounds;  // listed edges times rounds, of all substeps
    float energy;       // that impulses have given to the nodes, over their mass [m2/s2]
    uint missed;        // edges far beyond their limit that had no impulse before
};
layout(std430, binding = LIMIT_TALLY) buffer Tallies { Tally tallies[2]; };

#include "limit_tolerance.glsl"

#if LISTS
#define WRITES_NEXT 1
#include "next_state.glsl"

#if LOADS_TEXTURE
layout(binding = LIMIT_CHANGES) uniform samplerBuffer changes_before;
vec4 load_change(int index) { return texelFetch(changes_before, index); }
#else
vec4 load_change(int index) { return changes[index]; }
#endif
uniform bool lists_first;
#include "limit_list.glsl"
#endif

uniform float most_scale;  // of the impulses of the previous substep at most
uniform int round_limit;
uniform int begins_step;
uniform int work_limit;    // of edges of an invocation times rounds

#define LANE int(gl_LocalInvocationID.x)
#define PREVIOUS_AT (2 * STORED)

shared uint counts[LOCAL];
shared vec4 partial[LOCAL];

// How many entries invocations before this one have, and how many all have together.
uvec2 places(uint own) {
    counts[LANE] = own;
    barrier();
    uint before = 0u, total = 0u;
    for (int lane = 0; lane < LOCAL; ++lane) {
        uint each = counts[lane];
        before += lane < LANE ? each : 0u;
        total += each;
    }
    barrier();
    return uvec2(before, total);
}

// Sums of x, y and z, and the largest w, over all invocations.
vec4 together(vec4 own) {
    partial[LANE] = own;
    barrier();
    vec4 all = vec4(0.0);
    for (int lane = 0; lane < LOCAL; ++lane) {
        vec4 each = partial[lane];
        all = vec4(all.xyz + each.xyz, max(all.w, each.w));
    }
    barrier();
    return all;
}

// Whether the edge is the one that lists its start, or its end: the first of those listed there.
bool lists_start(int index, int kind) {
    uint edges = (MASK(index) | MASK(index) >> 4) & 15u;
    return findLSB(edges) == kind;
}

bool lists_end(int index, int kind) {
    if (MASK(index) != 0u) {
        return false;
    }
    bool is_first = true;
    for (int before = 0; before < kind; ++before) {
        is_first = is_first && !is_listed(START(index, before), before);
    }
    return is_first;
}

// Fill the lists of edges and nodes in the order of the lattice; return their lengths.
ivec2 fill_lists() {
    int each = (blocks + LOCAL - 1) / LOCAL;
    int begin = LANE * each;
    int end = min(begin + each, blocks);
    uint count = 0u;
    for (int block = begin; block < end; ++block) {
        count += lists[COUNTS_AT + block];
    }
    uvec2 place = places(count);
    int edges = int(place.y);
    if (edges == 0) {
        return ivec2(0);
    }
    int at = EDGES_AT + int(place.x);
    int across = (COLS + BLOCK - 1) / BLOCK;
    for (int block = begin; block < end; ++block) {
        uint left = lists[COUNTS_AT + block];
        for (int inside = 0; left > 0u && inside < BLOCK * BLOCK; ++inside) {
            int index = node_index(
                block / across * BLOCK + inside / BLOCK, block % across * BLOCK + inside % BLOCK);
            for (uint mask = MASK(index); mask != 0u; mask &= mask - 1u) {
                lists[at++] = uint(CODES * index + findLSB(mask));
                --left;
            }
        }
    }
    barrier();
    each = (edges + LOCAL - 1) / LOCAL;
    begin = LANE * each;
    end = min(begin + each, edges);
    count = 0u;
    for (int i = begin; i < end; ++i) {
        int entry = int(lists[EDGES_AT + i]);
        int start = entry / CODES, kind = entry & 3;
        count += lists_start(start, kind) ? 1u : 0u;
        count += lists_end(start + end_offset(kind), kind) ? 1u : 0u;
    }
    place = places(count);
    at = NODES_AT + int(place.x);
    for (int i = begin; i < end; ++i) {
        int entry = int(lists[EDGES_AT + i]);
        int start = entry / CODES, kind = entry & 3;
        if (lists_start(start, kind)) {
            lists[at++] = uint(start);
        }
        if (lists_end(start + end_offset(kind), kind)) {
            lists[at++] = uint(start + end_offset(kind));
        }
    }
    barrier();
    return ivec2(edges, int(place.y));
}

Edge edge_at(int index, int code) {
    return edge_between(
        load_position(index), load_position(index + end_offset(code)), code);
}

// The velocity of a node that has velocity v by the springs [m/s].
vec3 velocity_by_impulses(int index, vec4 v) {
    return after_contact(index, v.xyz + v.w * impulse_on(index), v.w > 0.0);
}

Edge edge_of(int entry) { return edge_at(entry / CODES, entry % CODES); }

vec3 impulse_of(int entry) { return impulse(entry / CODES, entry & 3); }

// What the impulse of an edge takes from the energy, for each part of it that is given: limit_law.
float pull_by(int entry, vec3 dv, float part) {
    return gain_of(edge_of(entry), entry % CODES, impulse_of(entry), dv, h, part);
}

float pull_on(int entry, float part) {
    int start = entry / CODES;
    return pull_by(entry, changes[WORK_AT + start + end_offset(entry % CODES)].xyz - changes[WORK_AT + start].xyz, part);
}

void main() {
#if LISTS
    for (int i = LANE; lists_first && i < int(marked_count); i += LOCAL) {
        list_block(int(lists[MARKED_AT + i]));
    }
    barrier();
#endif
    ivec2 size = fill_lists();
    int edges = size.x, nodes = size.y;
    if (LANE == 0 && begins_step != 0) {
        tallies[1] = Tally(0u, 0u, 0u, 0u, 0u, 0.0, 0.0, 0u);
    }
    if (edges == 0) {
        return;
    }
    // The impulses of the previous substep, times what takes most from the energy.
    vec4 gain = vec4(0.0);
#if HAS_CONTACT
    for (int i = LANE; i < nodes; i += LOCAL) {
        int index = int(lists[NODES_AT + i]);
        vec4 v = velocity_out[index];
        changes[WORK_AT + index].xyz = after_contact(index, v.xyz, v.w > 0.0);
    }
    barrier();
    for (int i = LANE; i < edges; i += LOCAL) {
        gain.x += pull_on(int(lists[EDGES_AT + i]), 0.0);
    }
    barrier();
#endif
    for (int i = LANE; i < nodes; i += LOCAL) {
        int index = int(lists[NODES_AT + i]);
        vec4 v = velocity_out[index];
        changes[WORK_AT + index] = vec4(velocity_by_impulses(index, v), v.w * listed_at(index));
    }
    barrier();
    for (int i = LANE; i < edges; i += LOCAL) {
        int entry = int(lists[EDGES_AT + i]);
        gain.y += pull_on(entry, 1.0);
        gain.z += is_missed(edge_of(entry), entry % CODES, impulse_of(entry)) ? 1.0 : 0.0;
#if !HAS_CONTACT
        int start = entry / CODES;
        gain.x += pull_by(
            entry, velocity_out[start + end_offset(entry % CODES)].xyz - velocity_out[start].xyz,
            0.0);
#endif
    }
    gain = together(gain);
    gain.y = gain.x - gain.y;
    float scale = gain.y > 0.0 ? clamp(gain.x / gain.y, 0.0, most_scale) : 0.0;
    for (int i = LANE; i < edges; i += LOCAL) {
        int entry = int(lists[EDGES_AT + i]);
        int index = entry / CODES, edge = entry & 3;
        vec3 start = scale * impulse(index, edge);
        set_impulse(index, edge, start);
        changes[PREVIOUS_AT + i].xyz = start;
    }
    barrier();
    // Jacobi rounds, accelerated (Nesterov), restarted when they overshoot.
    float momentum = 1.0;
    float enough = 0.0;
    int rounds = 0;
    int most = min(round_limit, max(work_limit / (edges / LOCAL + 1), 2));
    bool is_reached = false;
    while (rounds < most && !is_reached) {
        for (int i = LANE; i < nodes; i += LOCAL) {
            int index = int(lists[NODES_AT + i]);
            vec4 v = velocity_out[index];
            changes[WORK_AT + index].xyz = velocity_by_impulses(index, v);
        }
        barrier();
        vec4 change = vec4(0.0);
        for (int i = LANE; i < edges; i += LOCAL) {
            int entry = int(lists[EDGES_AT + i]);
            int index = entry / CODES, code = entry % CODES;
            vec4 from = changes[WORK_AT + index];
            vec4 to = changes[WORK_AT + index + end_offset(code)];
            float per_impulse = h * (from.w + to.w);
            vec3 y = impulse(index, code & 3);
            vec3 z = impulse_for(
                edge_at(index, code), code,
                h * (to.xyz - from.xyz) + per_impulse * y, per_impulse);
            vec3 way = z - changes[PREVIOUS_AT + i].xyz;
            change.x += (from.w + to.w) * dot(y - z, way);
            change.w = max(change.w, length(z - y) * per_impulse);
            set_impulse(index, code & 3, z);
            changes[PREVIOUS_AT + i].xyz = way;
        }
        change = together(change);
        ++rounds;
        enough = rounds == 1 ? sufficient(change.w) : enough;
        is_reached = change.w <= enough;
        momentum = change.x > 0.0 ? 1.0 : momentum;
        float next = 0.5 * (1.0 + sqrt(1.0 + 4.0 * momentum * momentum));
        float extra = is_reached || rounds == most ? 0.0 : (momentum - 1.0) / next;
        momentum = next;
        for (int i = LANE; i < edges; i += LOCAL) {
            int entry = int(lists[EDGES_AT + i]);
            int index = entry / CODES, edge = entry & 3;
            vec3 z = impulse(index, edge);
            set_impulse(index, edge, z + extra * changes[PREVIOUS_AT + i].xyz);
            changes[PREVIOUS_AT + i].xyz = z;
        }
        barrier();
    }
    vec2 given = vec2(0.0);
    for (int i = LANE; i < nodes; i += LOCAL) {
        given += give(int(lists[NODES_AT + i]));
    }
    vec4 total = together(vec4(given, 0.0, 0.0));
    if (LANE == 0) {
        for (int i = 0; i < 2; ++i) {
            Tally tally = tallies[i];
            tallies[i] = Tally(
                tally.substeps + (gives ? 1u : 0u), max(tally.most_listed, uint(edges)),
                max(tally.most_active, uint(total.x)), max(tally.most_rounds, uint(rounds)),
                tally.unreached + (is_reached || !gives ? 0u : 1u),
                tally.edge_rounds + float(edges) * float(rounds),
                tally.energy + (gives ? total.y : 0.0),
                tally.missed + uint(gain.z));
        }
    }
}
