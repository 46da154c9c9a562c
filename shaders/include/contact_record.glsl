// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Contacts in the current step of dt: for each collider and node the sum of the impulses over what
// masses are over [m/s], and in w whether the node stuck or slid at its last contact.

#include "cells.glsl"

uniform float serial;        // of the substep
uniform float decision;     // number of the decision
uniform int record_stride;  // entries of a collider

int stride = READ_FIRST(record_stride);

layout(std430, binding = CONTACTS) buffer Contacts { vec4 contacts[]; };

// RECORD_TEXELS 1: a pass that adds to an entry once, and so can load it by its texel.
#if RECORD_TEXELS
layout(binding = CONTACTS) uniform samplerBuffer contact_record;
vec3 recorded(int entry) { return texelFetch(contact_record, entry).xyz; }
#else
vec3 recorded(int entry) { return contacts[entry].xyz; }
#endif

// Leave a mark that another solve is due.
void note_change() { contacts[COLLIDERS * record_stride].y = decision; }

// Leave a mark that a node touches, is let go, sticks or slides, and did not before it.
void note_turn() { contacts[COLLIDERS * record_stride].z = decision; }

// Leave a mark that a node touches a collider in this substep.
void note_contact() { contacts[COLLIDERS * record_stride].x = serial; }

// Add the impulse of a change of velocity, and leave as it is whether the node touches.
void record_impulse(int collider, int index, vec3 change) {
    contacts[collider * record_stride + index].xyz +=
        mass_share(load_position(index)) * change;
}

void record_contacts(int index, int kind) {
    FOR_TOUCHED(i) {
        if (AT(given, i) != vec3(0.0) || AT(pressed, i) > 0.0) {
            int entry = TOUCHED(i) * stride + index;
            vec3 change = mass_share(load_position(index)) * (AT(given, i) + AT(pressing, i));
            contacts[entry] = vec4(recorded(entry) + change, float(min(kind, SLIDES)));
        }
    }
}
