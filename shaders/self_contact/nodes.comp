// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The velocity of each node that touches the cloth after a round, with what colliders do to it. The last
// round writes the state to come. IS_IMPLICIT 1: solves give nodes their velocities, and include impulses
// of layers; the last round moves layers that are too near apart.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#if HAS_CONTACT
#include "contact.glsl"
#endif
#include "low_parts.glsl"
#include "self_contact/head.glsl"
#include "self_contact/contacts.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(std430, binding = POSITION_OUT) buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) buffer VelocityOut { vec4 velocity_out[]; };
layout(std430, binding = SELF_VELOCITIES) writeonly buffer SelfVelocities { vec4 velocities[]; };
#if HAS_CONTACT && !IS_IMPLICIT
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

#if HAS_SURFACE
// Nodes of surface_nodes.glsl, four texels each.
layout(binding = SURFACE_NODES) uniform samplerBuffer surface_texels;
#endif

uniform float substep;  // [s]
uniform float way_unit;  // [m]
uniform int is_last;

vec3 of_numbers(int numbers[3], float unit) {
    return unit * vec3(numbers[0], numbers[1], numbers[2]);
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= self_node_count) {
        return;
    }
    int index = int(self_nodes[i].listed);
    SelfNode node = self_nodes[index];
    vec4 free = velocity_out[index];
    vec3 x = load_position(index).xyz;
    vec3 impulse = of_numbers(node.impulse, impulse_unit(speed_unit()));
#if IS_IMPLICIT
    free.xyz -= free.w * texelFetch(applied, index).xyz;
#endif
#if HAS_SURFACE
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
#if HAS_CONTACT
#if IS_IMPLICIT
    // Layers that are moved apart may be moved into a body.
    v += float(is_last) * free.w / substep * of_numbers(node.way, way_unit);
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
    velocities[index] = vec4(v, free.w * float(node.shares) / SHARE_PARTS);
    if (is_last == 0) {
        return;
    }
#if HAS_HELD
    vec4 position = load_position(index);
    if (is_held_by_pin(position, free)) {
        held[held_entry(index)].xyz += impulse;
    }
#endif
    self_nodes[index].impulse = int[3](0, 0, 0);
    self_nodes[index].way = int[3](0, 0, 0);
    self_nodes[index].shares = 0u;
    if (free.w > 0.0) {
        vec3 way = free.w * of_numbers(node.way, way_unit);
#if !IS_IMPLICIT
        way += substep * (v - free.xyz);
#endif
        vec3 to = changed_position(index, position_out[index].xyz, way);
#if HAS_CONTACT
        if (touched_count > 0) {
            to = moved_out(to, substep);
#if !IS_IMPLICIT
            record_contacts(index, kind);
#endif
        }
#endif
#if NOTES_CHANGES
        changes[index].xyz += v - velocity_out[index].xyz;
#endif
#if !IS_IMPLICIT
        velocity_out[index].xyz = v;
#endif
        position_out[index].xyz = to;
    }
}
