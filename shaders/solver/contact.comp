// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Decide how nodes touch colliders, docs/explanation/contact.md. A velocity is corrected at once in
// the directions that a surface blocks; friction acts in the next solve: as a force where a node
// slides, and as a steep drag where it sticks.
// STAGE BEGIN: before the first solve of a substep, by the expected velocities.
// STAGE AGAIN: after a solve, by the velocity that a node would have without its colliders.
// STAGE END: after the last one. Nodes that stick get the velocity of the surface, and contacts
// that no solve has included are resolved node by node.

#define BEGIN 0
#define AGAIN 1
#define END 2

// State of a node, stored in w of its reaction: it stuck at the end of the last substep, or was
// released in this one.
#define STUCK 1.0
#define LET_GO 16.0
// The last friction counts as near to the one needed at the last speed if their ratio is between
// this and its inverse [1]; chosen: nodes move by 3 to 6 % of their way from 0 to 1, by half the
// tolerance 3 %, and solves change by 8 % (benchmarks/constants.py --only NEARLY).
#define NEARLY 0.5

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/state_index.glsl"
#include "cells.glsl"
#include "state_in.glsl"
#include "state_out.glsl"
#if STAGE == BEGIN
#include "applied_acceleration.glsl"
#endif
// What is written was copied, and is changed at the nodes that near.comp lists.
#include "solver/near_list.glsl"
#include "low_parts.glsl"
#include "contact.glsl"
#include "contact_record.glsl"

layout(local_size_x = NEAR_LOCAL) in;

uniform float substep;        // [s]
#if STAGE == BEGIN
uniform float kick;           // [s] that what is applied acts for
uniform float guess;          // share of the last change that is expected; 0: none known
#else
uniform bool ends_turns;      // whether friction is to resist only, which throws no node
#endif
uniform float most_unsolved;  // [m] that a node may be moved by without another solve
float h = READ_FIRST(substep);
float unsolved = READ_FIRST(most_unsolved);
#if STAGE == BEGIN
float kicked = READ_FIRST(kick);
float share = READ_FIRST(guess);
#endif

// Whether a node at x may come to a collider in the substep, at this velocity.
bool is_near_body(vec3 x, vec3 v) {
    return (near_bodies(x, 0.0, h * length(v) + spare_way) & NODE_COLLIDERS) != 0u;
}

// Contact of a node; grip and impulse enter the next solve.
struct Hold {
    int kind;      // by the directions left to it; STICKS: none
    vec3 normal;
    vec3 change;   // of the velocity at once
    float grip;    // over a node's mass, what friction resists with
    vec3 line;     // of sliding, where it is known: there friction pulls and does not resist
    vec3 impulse;  // that friction and what was let go add to the next solve
};

void keep(int index, Hold hold, vec3 reaction) {
    system_data[cloth_entry(CONTACT, index)] = vec4(hold.normal, float(hold.kind));
    system_data[cloth_entry(GRIP, index)] = vec4(hold.line, hold.grip);
    store_vector(cloth_entry(REACTION, index), reaction);
    store_vector(cloth_entry(GIVEN, index), hold.impulse);
    if (hold.kind != FREE) {
        note_contact();
    }
}

// The part of v in directions in which the node can go.
vec3 along_surface(Hold hold, vec3 v) {
    vec3 along = dot(hold.normal, v) * hold.normal;
    return hold.kind == SLIDES ? v - along : hold.kind == SLIDES_ON_TWO ? along : vec3(0.0);
}

// Where the surfaces that act by the law leave a node of velocity v to go, without friction yet.
Hold hold_of(Contact contact, vec3 v) {
    Hold hold = Hold(FREE, vec3(0.0), vec3(0.0), 0.0, vec3(0.0), vec3(0.0));
    if (contact.kind == FREE) {
        return hold;
    }
    hold.kind = held_on == 1 ? SLIDES : held_on == 2 ? SLIDES_ON_TWO : STICKS;
    hold.normal = AT(surface, held_by.x).xyz;
    if (COLLIDERS > 1 && held_on == 2) {
        hold.normal = normalize(cross(hold.normal, AT(surface, held_by.y).xyz));
    }
    hold.change = contact.velocity - v;
    hold.change -= along_surface(hold, hold.change);
    return hold;
}

// The most that friction changes the velocity by in the substep.
float most_friction() {
    float most = 0.0;
    FOR_TOUCHED(i) {
        float normal_impulse = max(dot(AT(given, i), AT(surface, i).xyz), 0.0) + AT(pressed, i);
        most += OF(body_friction, TOUCHED(i)) * normal_impulse;
    }
    return most;
}

// How fast a node of velocity v slides.
vec3 sliding(Hold hold, vec3 v) { return along_surface(hold, v - AT(carried, held_by.x)); }

// Up to this speed [m/s] a node does not slide: positions are rounded by as much.
float slowest(vec3 x) { return rounding(x, TOUCHED(0)) / h; }

// Whether what slides goes farther than a node may without another solve.
bool is_fast(float speed) { return h * speed > unsolved; }

// Let friction act in the solve as a drag of coefficient most / speed; done: its impulse so far.
void hold_fast(inout Hold hold, float most, float speed, vec3 slid, vec3 done) {
    hold.grip = most / speed;
    hold.impulse = -hold.grip * slid - done;
}

#if STAGE == BEGIN
// Whether a node of velocity v that slid goes on to. The friction of the last substep resists it
// then, which throws nothing, and is near to that of this one.
bool slides_on(inout Hold hold, int index, vec3 v) {
    vec3 slid = hold.kind > STICKS ? sliding(hold, v) : vec3(0.0);
    float speed = length(slid);
    if (!is_fast(speed)) {
        return false;
    }
    vec3 reaction = load_vector(cloth_entry(REACTION, index));
    FOR_TOUCHED(i) {
        PUT(given, i, share * reaction);
    }
    hold_fast(hold, most_friction(), speed, slid, vec3(0.0));
    return true;
}

// The velocity that takes a node to surfaces.
vec3 towards(int at, int index, vec3 v) {
    vec3 last = load_vector(cloth_entry(CHANGE, index));
    return v + share * last + kicked * applied_acceleration(at);
}

void decide(int at, int index, inout vec4 x, inout vec4 v) {
    vec3 last = load_vector(cloth_entry(CHANGE, index));
    vec3 expected = share > 0.0
        ? share * (last - load_vector(cloth_entry(REACTION, index)))
        : kicked * applied_acceleration(at);
    vec3 without = v.xyz + expected;
    bool touched_before = share > 0.0 && load_system(cloth_entry(CONTACT, index)).w > 0.0;
    bool stuck = load_entry(cloth_entry(REACTION, index)).w == STUCK;
    vectors[cloth_entry(REACTION, index)].w = 0.0;
    Contact contact = contact_at(x.xyz, towards(at, index, v.xyz), without, h);
    Hold hold = hold_of(contact, v.xyz);
    if (touched_before && !stuck && slides_on(hold, index, v.xyz + hold.change)) {
        v.xyz += hold.change;
        keep(index, hold, hold.change);
        store_vector(cloth_entry(CHANGE, index), along_surface(hold, last));
        return;
    }
    if (contact.kind == STICKS) {
        hold.change -= sliding(hold, v.xyz + hold.change);
        hold.kind = STICKS;
    }
    v.xyz += hold.change;
    if (hold.kind == SLIDES || hold.kind == SLIDES_ON_TWO) {
        // The impulse of the last substep may be none of this one: where edges that are let go
        // have made it large, friction by it would throw the node that it is to stop.
        vec3 friction = along_surface(hold, contact.velocity - without);
        float most = length(sliding(hold, v.xyz)) + kicked * length(applied_acceleration(at));
        hold.impulse = friction * min(most / max(length(friction), 1e-30), 1.0);
    }
    keep(index, hold, hold.change);
    // Initial solution: zero along directions the node can't move in; without a previous change,
    // the contact law applied to the node alone.
    vec3 start = share > 0.0 ? last
        : hold.kind == FREE ? vec3(0.0) : contact.velocity - v.xyz;
    store_vector(
        cloth_entry(CHANGE, index), hold.kind == FREE ? start : along_surface(hold, start));
}
#elif STAGE == AGAIN
// Decide whether friction makes a node stick or slide, by its velocity v after a solve.
void apply_friction(inout Hold hold, Contact contact, vec3 v, vec3 x, vec3 reaction, int was,
                    float was_grip) {
    vec3 slid = sliding(hold, v);
    vec3 done = along_surface(hold, reaction);
    float most = most_friction();
    float speed = length(slid);
    float used = -dot(done, slid) / max(most * speed, 1e-30);
    // A step of Newton's method that ends the substep could drive a node.
    bool is_near = !ends_turns && is_fast(speed) && used > NEARLY && used * NEARLY < 1.0;
    bool slides = contact.kind != STICKS;
    if (was == STICKS && !slides) {
        hold.change -= slid;
        hold.kind = STICKS;
        return;
    }
    // What has begun to slide is not tied again in this substep: the law judges a node by its own
    // mass, and hard edges would pull at one that is tied with any force.
    if (was_grip > 0.0 || !slides || ends_turns || is_near) {
        hold_fast(hold, most, max(speed, slowest(x)), slid, done);
        hold.line = is_near ? slid / speed : vec3(0.0);
        return;
    }
    hold.impulse = along_surface(hold, contact.velocity - (v - hold.change - reaction)) - done;
}

// Return whether a node touches or may come to.
bool may_touch(int at, int index, vec4 x, vec4 v) {
    spare_way = unsolved;
    vec3 begin = load_vector(cloth_entry(BEGIN_POSITION, index));
    bool touches = load_system(cloth_entry(CONTACT, index)).w > 0.0;
    bool is_near = v.w > 0.0 && (touches || is_near_body(begin, v.xyz));
    if (!is_near) {
        store_vector(cloth_entry(GIVEN, index), vec3(0.0));
    }
    return is_near;
}

void decide(int at, int index, inout vec4 x, inout vec4 v) {
    int was = int(load_system(cloth_entry(CONTACT, index)).w);
    float was_grip = load_system(cloth_entry(GRIP, index)).w;
    vec3 begin = load_vector(cloth_entry(BEGIN_POSITION, index));
    vec3 reaction = load_vector(cloth_entry(REACTION, index));
    bool was_let_go = load_entry(cloth_entry(REACTION, index)).w == LET_GO;
    Contact contact = contact_at(begin, v.xyz, v.xyz - reaction, h);
    if (was == FREE && contact.kind == FREE) {
        store_vector(cloth_entry(GIVEN, index), vec3(0.0));
        return;
    }
    Hold hold = hold_of(contact, v.xyz);
    if (contact.kind == FREE && was_let_go) {
        // A node that was released once stays in contact, so that the turns end.
        hold.kind = was;
        hold.normal = load_system(cloth_entry(CONTACT, index)).xyz;
        hold.grip = was_grip;
    } else if (contact.kind == FREE) {
        hold.impulse = -reaction;
        vectors[cloth_entry(REACTION, index)].w = LET_GO;
    } else if (hold.kind != STICKS) {
        apply_friction(
            hold, contact, v.xyz + hold.change, begin, reaction, was, was_grip);
    }
    // What a node that stays in its state lacks moves it as if its neighbours stayed.
    vec3 moved = hold.kind == was ? times(load_cloth_inverse(index), hold.impulse) : hold.impulse;
    if (h * max(length(hold.change), length(moved)) > unsolved) {
        note_change();
    }
    if (hold.kind != was) {
        note_turn();
    }
    // A released node has no reaction after the next solve.
    keep(index, hold, hold.kind == FREE ? vec3(0.0) : reaction + hold.change);
    if (hold.change != vec3(0.0)) {
        v.xyz += hold.change;
#if HAS_LOW_PARTS
        x.xyz = changed_position(at, x.xyz, h * hold.change);
#else
        x.xyz = begin + h * v.xyz;
#endif
        store_vector(
            cloth_entry(CHANGE, index), v.xyz - load_vector(cloth_entry(BEGIN_VELOCITY, index)));
    }
}
#else
// End the substep of a node that touches nothing; return whether it may.
bool may_touch(int at, int index, vec4 x, vec4 v) {
    spare_way = unsolved;
    vectors[cloth_entry(REACTION, index)].w = 0.0;
    return v.w > 0.0
        && is_near_body(load_vector(cloth_entry(BEGIN_POSITION, index)), v.xyz);
}

void decide(int at, int index, inout vec4 x, inout vec4 v) {
    vec4 was = load_system(cloth_entry(CONTACT, index));
    float was_grip = load_system(cloth_entry(GRIP, index)).w;
    vec3 begin = load_vector(cloth_entry(BEGIN_POSITION, index));
    vec3 reaction = load_vector(cloth_entry(REACTION, index));
    // A node that was let go last, with no solve after it, still has what it had been given.
    vec3 kept = was.w == float(FREE) ? -load_vector(cloth_entry(GIVEN, index)) : vec3(0.0);
    touched[0] = -1;
    contact_at(begin, v.xyz, v.xyz - reaction, h);
    if (touched[0] >= 0 && kept != vec3(0.0)) {
        record_impulse(TOUCHED(0), at, kept);
    }
    if (touched_count == 0 && reaction != vec3(0.0)) {
        // A node that passes by without its reaction may penetrate with it.
        find_surfaces(
            bodies_towards(begin, v.xyz, h), begin, v.xyz, v.xyz, h);
    }
    if (touched_count == 0) {
        return;
    }
    if (touched_count == 1) {
        given[0] = reaction;
    }
    vec3 before = v.xyz;
    vec3 to = before;
    bool sticks = int(was.w) == STICKS;
    if (was.w > float(STICKS)) {
        Hold hold = Hold(int(was.w), was.xyz, vec3(0.0), 0.0, vec3(0.0), vec3(0.0));
        vec3 slid = sliding(hold, to);
        sticks = was_grip > 0.0 && length(slid) <= 2.0 * slowest(begin);
        to -= sticks ? slid : vec3(0.0);
    }
    FOR_TOUCHED(i) {
        vec3 change = max(lacking(i, begin, to, h), 0.0) * AT(surface, i).xyz;
        PUT(given, i, AT(given, i) + change);
        to += change;
    }
    if (to != before) {
        store_vector(cloth_entry(REACTION, index), reaction + (to - before));
#if HAS_LOW_PARTS
        x.xyz = changed_position(at, x.xyz, h * (to - before));
#else
        x.xyz = begin + h * to;
#endif
        v.xyz = to;
    }
    if (touched_count == 1) {
        // With friction at rest. Of several surfaces the law shares it out.
        given[0] = reaction + (to - before);
    }
    x.xyz = moved_out(x.xyz, h);
    vectors[cloth_entry(REACTION, index)].w = sticks ? STUCK : 0.0;
    record_contacts(at, sticks ? STICKS : SLIDES);
}
#endif

void main() {
    if (gl_GlobalInvocationID.x >= near_count) {
        return;
    }
    ivec2 listed = near_node(gl_GlobalInvocationID.x);
    int at = state_index(listed.y, listed.x);
    vec4 x = load_position(at);
    vec4 v = load_velocity(at);
    int index = node_index(listed.y, listed.x);
#if STAGE == BEGIN
    decide(at, index, x, v);
#else
    // Software runs the body of a branch for nodes that do not take it, but no loop that ends at
    // once, if its compiler does not tell it from a branch.
    for (uint asks = may_touch(at, index, x, v) ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        decide(at, index, x, v);
    }
#endif
    velocity_out[at] = v;
    position_out[at] = x;
}
