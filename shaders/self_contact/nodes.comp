// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The velocity of each node with contacts after a round, with what colliders do to it. IS_SUM 1: by the
// impulses of layers alone, whose sums are stored. IS_LAST 1: write the state to come instead.
// IS_IMPLICIT 1: solves give nodes their velocities, and include impulses of layers; layers that are
// too near are moved apart last.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#define ASKS_BODIES (HAS_CONTACT && !IS_SUM)
#if ASKS_BODIES
#include "contact.glsl"
#endif
#include "low_parts.glsl"
#include "self_contact/head.glsl"
#include "self_contact/contacts.glsl"
#include "self_contact/entries.glsl"

layout(local_size_x = SELF_LOCAL) in;

#if IS_LAST
layout(std430, binding = POSITION_OUT) buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) buffer VelocityOut { vec4 velocity_out[]; };
layout(binding = POSITION_OUT) uniform samplerBuffer position_texels;
#endif
// Software reads texels much faster than numbers.
layout(binding = VELOCITY_OUT) uniform samplerBuffer velocity_texels;
layout(binding = SELF_NODES) uniform samplerBuffer node_texels;
layout(std430, binding = SELF_VELOCITIES) writeonly buffer SelfVelocities { vec4 velocities[]; };
#if ASKS_BODIES && IS_LAST && !IS_IMPLICIT
#include "contact_record.glsl"
#endif
#if IS_IMPLICIT
layout(binding = SELF_APPLIED) uniform samplerBuffer applied;
#endif
#if HAS_HELD
#include "held.glsl"
#endif
#if NOTES_CHANGES
layout(std430, binding = LIMIT_CHANGES) buffer Changes { vec4 changes[]; };
#endif

#if HAS_SURFACE && !IS_SUM
// Nodes of surface_nodes.glsl, four texels each.
layout(binding = SURFACE_NODES) uniform samplerBuffer surface_texels;
#endif

uniform float substep;  // [s]
uniform float way_unit;  // [m]
uniform int is_summed;   // whether the sums of impulses that are stored are those of now

#if IS_LAST
// Displacement of a node out of layers, over its inverse mass.
vec3 out_of_layers_at(int index) {
    return way_unit * vec3(floatBitsToInt(texelFetch(node_texels, 3 * index + 1).xyz));
}
#endif

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= self_node_count) {
        return;
    }
    int index = floatBitsToInt(texelFetch(node_texels, 3 * int(i) + 2).x);
    uvec4 own = floatBitsToUint(texelFetch(node_texels, 3 * index + 2));
    // llvmpipe runs the body of a branch for all nodes, but skips a loop without rounds.
    ivec3 sum = sum_of_entries(own.z, is_summed == 1 ? 0u : own.w);
    sum = is_summed == 1 ? floatBitsToInt(texelFetch(node_texels, 3 * index).xyz) : sum;
    vec4 free = texelFetch(velocity_texels, index);
    vec3 x = load_position(index).xyz;
    vec3 impulse = impulse_unit * vec3(sum);
#if IS_LAST
    vec3 out_of_layers = free.w * out_of_layers_at(index);
#endif
#if IS_IMPLICIT
    free.xyz -= free.w * texelFetch(applied, index).xyz;
#endif
#if HAS_SURFACE && !IS_SUM
    // Thin colliders have changed the velocity already.
    vec4 without = texelFetch(surface_texels, 4 * index);
    bool is_listed = floatBitsToInt(without.w) == 1;
    bool is_held = is_listed && floatBitsToInt(texelFetch(surface_texels, 4 * index + 1).z) == 1;
    free.xyz = is_listed ? without.xyz : free.xyz;
    vec3 by_rows = texelFetch(surface_texels, 4 * index + 3).xyz;
    vec3 v = free.xyz + free.w * (impulse + (is_held ? by_rows : vec3(0.0)));
#else
    vec3 v = free.xyz + free.w * impulse;
#endif
#if ASKS_BODIES
#if IS_IMPLICIT && IS_LAST
    // Layers that are moved apart may be moved into a body.
    v += out_of_layers / substep;
#endif
    uint bodies = free.w > 0.0 ? near_bodies(x, 0.0, substep * length(v)) : 0u;
    touched_count = 0;
    int kind = FREE;
    if (bodies != 0u) {
        Contact contact = contact_with(bodies, x, v, v, substep);
        v = contact.velocity;
        kind = contact.kind;
    }
#endif
#if IS_SUM || IS_LAST
    self_nodes[index].impulse = int[3](sum.x, sum.y, sum.z);
#endif
#if IS_SUM
    velocities[index] = vec4(v, 0.0);
#elif !IS_LAST
    uint shares = floatBitsToUint(texelFetch(node_texels, 3 * index).w);
    velocities[index] = vec4(v, free.w * float(shares) / SHARE_PARTS);
#else
#if HAS_HELD
    vec4 position = load_position(index);
    if (is_held_by_pin(position, free)) {
        held[held_entry(index)].xyz += impulse;
    }
#endif
    self_nodes[index].way = int[3](0, 0, 0);
    if (free.w > 0.0) {
        vec3 way = out_of_layers;
#if !IS_IMPLICIT
        way += substep * (v - free.xyz);
#endif
        vec3 to = changed_position(index, texelFetch(position_texels, index).xyz, way);
#if ASKS_BODIES
        if (touched_count > 0) {
            to = moved_out(to, substep);
#if !IS_IMPLICIT
            record_contacts(index, kind);
#endif
        }
#endif
#if NOTES_CHANGES
        changes[index].xyz += v - texelFetch(velocity_texels, index).xyz;
#endif
#if !IS_IMPLICIT
        velocity_out[index].xyz = v;
#endif
        position_out[index].xyz = to;
    }
#endif
}
