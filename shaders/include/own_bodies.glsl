// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Where the bodies of each cloth of a stack are in a substep, and how they move: a table with
// OWN_ENTRIES vectors for each body of each cloth (sim/contact/stacked_contacts.py).

// Places of the vectors of a body; those of the axes and of the turn are three each.
#define OWN_CENTRE 0    // [m] as the substep begins; w: near_limit of collider_bounds.glsl
#define OWN_VELOCITY 1  // [m/s]; w: near_share
#define OWN_AXES 2      // w of the three: near_core
#define OWN_TURN 5      // [1/s]
#define OWN_ENTRIES 8

uniform ivec2 stack;    // rows of a cloth, and from one cloth to the next
int cloth_period = READ_FIRST(stack).y;

#if LOADS_TEXTURE
layout(binding = OWN_BODIES_TABLE) uniform samplerBuffer own_bodies;
vec4 own_vector(int place) { return texelFetch(own_bodies, place); }
#else
layout(std430, binding = OWN_BODIES_TABLE) readonly buffer OwnBodies { vec4 own_bodies[]; };
vec4 own_vector(int place) { return own_bodies[place]; }
#endif

int own_first;  // place of the first body of the cloth

void take_cloth(int row) { own_first = row / cloth_period * (COLLIDERS * OWN_ENTRIES); }

vec4 own_entry(int body, int place) { return own_vector(own_first + OWN_ENTRIES * body + place); }

vec3 own_core(int body) {
    return vec3(own_entry(body, OWN_AXES).w, own_entry(body, OWN_AXES + 1).w,
        own_entry(body, OWN_AXES + 2).w);
}
