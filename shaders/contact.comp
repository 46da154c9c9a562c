// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Apply contact with colliders to the new state of an explicit substep, at the nodes listed by
// near_nodes.comp. NOTES_CHANGES 1: also add the change of velocity of each node to the buffer that
// strain limits use.

#include "lattice.glsl"
#include "state_in.glsl"
#include "contact.glsl"
#include "near_blocks.glsl"
#include "low_parts.glsl"
#if HAS_SURFACE
#include "surface_nodes.glsl"
#endif
#if HAS_SELF
// Nodes of self_contact/contacts.glsl, three texels each.
layout(binding = SELF_NODES) uniform samplerBuffer self_texels;
#endif

layout(local_size_x = NEAR_LOCAL) in;

layout(std430, binding = POSITION_OUT) buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) buffer VelocityOut { vec4 velocity_out[]; };

#define WRITES_NEXT 1
#include "next_state.glsl"
#define RECORD_TEXELS LOADS_TEXTURE
#include "contact_record.glsl"
#if NOTES_CHANGES
layout(std430, binding = LIMIT_CHANGES) buffer Changes { vec4 changes[]; };
#endif

uniform float substep;    // [s]
uniform int block_count;  // in all

void main() {
    float h = READ_FIRST(substep);
    uint nodes_at = uint(READ_FIRST(block_count));
    if (gl_GlobalInvocationID.x >= listed_nodes()) {
        return;
    }
    Near node = listed_at_place(nodes_at + gl_GlobalInvocationID.x);
    int index = int(node.index);
#if OWN_BODIES
    take_bodies(index / PITCH - HALO);
#endif
#if HAS_SURFACE
    // Handled by surface_contact.comp, or pinned.
    if (surface_nodes[index].is_held == 1 || load_next_velocity(index).w == 0.0) {
        return;
    }
#endif
#if HAS_SELF
    // Handled by self_contact/nodes.comp.
    if (floatBitsToUint(texelFetch(self_texels, 3 * index + 2).y) > 0u) {
        return;
    }
#endif
    vec3 v = load_next_velocity(index).xyz;
    vec3 x = load_position(index).xyz;
    Contact contact = contact_with(node.bodies, x, v, v, h);
    if (touched_count == 0) {
        return;
    }
    vec3 to = load_next_position(index).xyz;
    if (contact.kind != FREE) {
#if HAS_LOW_PARTS
        to = changed_position(index, to, h * (contact.velocity - v));
#else
        to = x + h * contact.velocity;
#endif
#if NOTES_CHANGES
        changes[index].xyz += contact.velocity - v;
#endif
        velocity_out[index].xyz = contact.velocity;
    }
    position_out[index].xyz = moved_out(to, h);
    record_contacts(index, contact.kind);
}
