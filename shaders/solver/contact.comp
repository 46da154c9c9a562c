// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Decide which nodes touch a collider, docs/explanation/contact.md. Where one can't go on as it
// does, its velocity is made right in that direction; what the impulse along the surface lacks is
// left to the next solve.
// STAGE BEGIN: before the first solve of a substep, by the velocities that are expected.
// STAGE AGAIN: after a solve, by the velocity that a node would have without its colliders.
// STAGE END: after the last one. Whatever was not found by then is held off the surface.

#define BEGIN 0
#define AGAIN 1
#define END 2

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/state_index.glsl"
#include "state_in.glsl"
#include "state_out.glsl"
#if STAGE == BEGIN
#include "applied_acceleration.glsl"
#endif
#include "contact.glsl"
#include "contact_record.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;        // [s]
#if STAGE == BEGIN
uniform float kick;           // [s] that what is applied acts for
uniform float guess;          // share of the last change that is expected; 0: none known
#else
uniform float most_unsolved;  // [m] that a node may be moved by without another solve
#endif

void keep(int index, Contact contact, vec3 reaction, vec3 left) {
    system_data[cloth_entry(CONTACT, index)] = vec4(contact.normal, float(contact.kind));
    store_vector(cloth_entry(REACTION, index), reaction);
    store_vector(cloth_entry(GIVEN, index), left);
    if (contact.kind != FREE) {
        note_contact();
    }
}

// The part of an impulse in directions in which the node can go.
vec3 along_surface(Contact contact, vec3 impulse) {
    vec3 along = dot(contact.normal, impulse) * contact.normal;
    return contact.kind == SLIDES ? impulse - along
        : contact.kind == SLIDES_ON_TWO ? along : vec3(0.0);
}

// What the velocity v has to change by at once: all but that.
vec3 change_at_once(Contact contact, vec3 v) {
    vec3 change = contact.velocity - v;
    return contact.kind == FREE ? vec3(0.0) : change - along_surface(contact, change);
}


#if STAGE == BEGIN
void decide(int at, int index, inout vec4 x, inout vec4 v) {
    store_vector(cloth_entry(BEGIN_POSITION, index), x.xyz);
    store_vector(cloth_entry(BEGIN_VELOCITY, index), v.xyz);
    if (v.w == 0.0) {
        return;
    }
    vec3 last = load_vector(cloth_entry(CHANGE, index));
    vec3 expected = guess > 0.0
        ? guess * (last - load_vector(cloth_entry(REACTION, index)))
        : kick * applied_acceleration(at);
    vec3 without = v.xyz + expected;
    Contact contact = contact_at(x.xyz, without, substep);
    vec3 change = change_at_once(contact, v.xyz);
    // The impulse of the last substep may be none of this one: where edges that are let go have
    // made it large, friction by it would throw the node that it is to stop.
    vec3 friction = along_surface(contact, contact.velocity - without);
    float most = length(along_surface(contact, v.xyz - surface_velocity(touched[0], x.xyz)))
        + kick * length(applied_acceleration(at));
    friction *= min(most / max(length(friction), 1e-30), 1.0);
    keep(index, contact, change, friction);
    vectors[cloth_entry(REACTION, index)].w = 0.0;
    v.xyz += change;
    if (contact.kind == STICKS) {
        v.xyz = contact.velocity;
        store_vector(cloth_entry(CHANGE, index), vec3(0.0));
    } else if (contact.kind != FREE) {
        // What the solve starts with is nothing where the node can't go.
        store_vector(cloth_entry(CHANGE, index), along_surface(contact, last));
    }
}
#elif STAGE == AGAIN
void decide(int at, int index, inout vec4 x, inout vec4 v) {
    int was = int(system_data[cloth_entry(CONTACT, index)].w);
    vec3 begin = load_vector(cloth_entry(BEGIN_POSITION, index));
    vec3 reaction = load_vector(cloth_entry(REACTION, index));
    vec3 without = v.xyz - reaction;
    Contact contact = contact_at(begin, without, substep);
    // Hard edges would have nodes change to and fro: in a substep, one that sticks goes on to,
    // and one that was let go once does neither stick nor is it let go again.
    float was_let_go = vectors[cloth_entry(REACTION, index)].w;
    bool goes_on = was == STICKS && (contact.kind == SLIDES || contact.kind == SLIDES_ON_TWO)
        || was != FREE && contact.kind == FREE && was_let_go == 1.0;
    if (goes_on) {
        contact = Contact(v.xyz, system_data[cloth_entry(CONTACT, index)].xyz, was);
    } else if (contact.kind == STICKS && was_let_go == 1.0 && touched_count == 1) {
        contact.kind = SLIDES;
        contact.normal = surface[0].xyz;
    } else if (was != FREE && contact.kind == FREE) {
        vectors[cloth_entry(REACTION, index)].w = 1.0;
    }
    if (v.w == 0.0 || (was == FREE && contact.kind == FREE)) {
        store_vector(cloth_entry(GIVEN, index), vec3(0.0));
        return;
    }
    vec3 change = change_at_once(contact, v.xyz);
    vec3 wanted = contact.velocity - without;
    vec3 left = goes_on ? vec3(0.0)
        : contact.kind == FREE ? -reaction : along_surface(contact, wanted - reaction);
    if (substep * max(length(change), length(left)) > most_unsolved) {
        note_change();
    }
    vec3 to = contact.kind == STICKS ? contact.velocity : v.xyz + change;
    // What is let go has no reaction once the next solve is done.
    reaction = contact.kind == FREE ? vec3(0.0) : reaction + (to - v.xyz);
    keep(index, contact, reaction, left);
    if (to != v.xyz) {
        v.xyz = to;
        x.xyz = begin + substep * to;
        store_vector(
            cloth_entry(CHANGE, index), to - load_vector(cloth_entry(BEGIN_VELOCITY, index)));
    }
}
#else
void decide(int at, int index, inout vec4 x, inout vec4 v) {
    vec4 was = system_data[cloth_entry(CONTACT, index)];
    vec3 begin = load_vector(cloth_entry(BEGIN_POSITION, index));
    vec3 reaction = load_vector(cloth_entry(REACTION, index));
    if (v.w == 0.0) {
        return;
    }
    contact_at(begin, v.xyz - reaction, substep);
    if (touched_count == 0) {
        return;
    }
    if (touched_count == 1) {
        given[0] = reaction;
    }
    vec3 to = v.xyz;
    for (int i = 0; i < touched_count; ++i) {
        vec3 change = max(lacking(i, begin, to, substep), 0.0) * surface[i].xyz;
        given[i] += change;
        to += change;
    }
    if (to != v.xyz) {
        v.xyz = to;
        x.xyz = begin + substep * to;
        store_vector(cloth_entry(REACTION, index), reaction + (to - v.xyz));
    }
    x.xyz = moved_out(x.xyz, substep);
    record_contacts(at, was.w > 0.0 ? int(was.w) : SLIDES);
}
#endif

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int at = state_index(row, col);
    vec4 x = load_position(at);
    vec4 v = load_velocity(at);
    decide(at, node_index(row, col), x, v);
    velocity_out[at] = v;
    position_out[at] = x;
}
