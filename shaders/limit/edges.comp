// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A round over the listed edges all over the lattice: the impulse of each by the velocities of its
// nodes; or what the impulses of the substep before take from the energy by them, and whether edges
// were missed in it.
// BLOCK x BLOCK nodes an invocation, with the edges that start there.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "limit_lists.glsl"
#include "limit_law.glsl"
#include "limit_lattice.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#if LOADS_TEXTURE
layout(binding = LIMIT_CHANGES) uniform samplerBuffer changes;
vec4 load_work(int index) { return texelFetch(changes, WORK_AT + index); }
#else
layout(std430, binding = LIMIT_CHANGES) readonly buffer Changes { vec4 changes[]; };
vec4 load_work(int index) { return changes[WORK_AT + index]; }
#endif
layout(std430, binding = LIMIT_IMPULSES_OUT) writeonly buffer ImpulsesOut { vec4 impulses_out[]; };
layout(std430, binding = LIMIT_FIGURES) writeonly buffer Figures { vec2 block_figures[]; };

uniform float substep;  // [s]
uniform bool finds_gain;
float h = READ_FIRST(substep);

// Impulses of the edges that start at a node, after the last round, and before it.
Impulses4 last, previous;
Impulses4 found;
// How far the round overshoots in the block, and the largest change of a length by it [m].
vec2 figures;

void act_on(int index, vec4 here, vec4 from, uint mask, int edge) {
    int code = edge + ((mask & 16u << edge) != 0u ? SHORTEST : 0);
    int end = index + end_offset(edge);
    vec4 to = load_work(end);
    Edge it = edge_between(here, load_position(end), code);
    // As in solver/contact.comp, software would run the body of a branch for every edge.
    for (uint asks = finds_gain ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        figures.x += gain_of(it, code, of_edge(last, edge), to.xyz - from.xyz, h, taken.x);
        figures.y += is_missed(it, code, of_edge(last, edge)) ? 1.0 : 0.0;
    }
    bool is_in = !finds_gain;
    vec3 y = taken.x * of_edge(last, edge) + taken.y * of_edge(previous, edge);
    float per_impulse = h * (from.w + to.w);
    vec3 z = impulse_for(
        it, code, h * (to.xyz - from.xyz) + per_impulse * y, per_impulse);
    z = is_in ? z : vec3(0.0);
    vec3 step = z - y;
    vec3 before = (taken.x + taken.y) * of_edge(last, edge);
    figures.x -= is_in ? (from.w + to.w) * dot(step, z - before) : 0.0;
    figures.y = max(figures.y, is_in ? length(step) * per_impulse : 0.0);
    found = set_edge(found, edge, z);
}

void main() {
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    ivec2 first = block * BLOCK;
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    figures = vec2(0.0);
    // One node after another, and one edge: in one copy of the law, which llvmpipe compiles once.
    int nodes = has_listed_edges(block) ? BLOCK * BLOCK : 0;
    for (int inside = 0; inside < nodes; ++inside) {
        int index = node_index(first.y + inside / BLOCK, first.x + inside % BLOCK);
        uint mask = MASK(index);
        last = Impulses4(
            load_impulses(3 * index), load_impulses(3 * index + 1),
            load_impulses(3 * index + 2));
        previous = Impulses4(
            load_previous(3 * index), load_previous(3 * index + 1),
            load_previous(3 * index + 2));
        found = Impulses4(vec4(0.0), vec4(0.0), vec4(0.0));
        vec4 here = load_position(index);
        vec4 velocity = load_work(index);
        for (uint edges = (mask | mask >> 4) & 15u; edges != 0u; edges &= edges - 1u) {
            act_on(index, here, velocity, mask, findLSB(edges));
        }
        for (uint asks = finds_gain ? 0u : 1u; asks != 0u; asks &= asks - 1u) {
            impulses_out[3 * index] = found.first;
            impulses_out[3 * index + 1] = found.second;
            impulses_out[3 * index + 2] = found.third;
        }
    }
    block_figures[block.y * BLOCKS_ACROSS + block.x] = figures;
}
