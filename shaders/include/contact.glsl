// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Velocity of a node after contact and friction, docs/explanation/contact.md: no node comes nearer
// to a surface than the clearance, and friction reduces the sliding velocity by up to mu times the
// impulse along the normal. A node that sticks has exactly the velocity of the surface.

#include "collider_shapes.glsl"

// Max. contacts of a node [1]; the nearest ones count.
#define MOST_TOUCHED (COLLIDERS < 4 ? COLLIDERS : 4)
#define MOST_ROUNDS 32
#define MOST_ROUNDS_OUT 16
// Cosine between normals [1], 26 degrees: two surfaces above it count as one, and below minus it
// they face each other: 1 / (1 - 0.9^2) = 5 multiplies the rounding of a node held on two of them;
// chosen: same bits from 0.5 to 0.99 (benchmarks/constants.py --only FACING).
#define FACING 0.9

// The same of a thin body and another one that it does not overlap [1], 60 degrees: on round ones
// normals turn by more than 26 degrees within the part that they press on (test_thin_pinch.py -k
// spheres).
#define FACING_THIN 0.5

// Loop over the surfaces of a node. Mesa unrolls a loop over a whole array from a constant on, and
// llvmpipe then compiles and runs it for surfaces that no node touches. With at most one there is no
// loop.
#if COLLIDERS > 1
#define FROM(first) min(touched_count, first)
#define FOR_TOUCHED(i) for (int i = FROM(0); i < touched_count; ++i)
#else
#define FOR_TOUCHED(i) for (int i = 0; i < min(touched_count, 1); ++i)
#endif
// The collider of surface i.
#define TOUCHED(i) (COLLIDERS > 1 ? AT(touched, i) : 0)

#define FREE 0
#define STICKS 1
#define SLIDES 2
#define SLIDES_ON_TWO 3

// The thin colliders of an explicit substep, one bit each: surface_pressing.glsl finds their pressure.
#ifndef PRESS_ON_TRIANGLES
#define PRESS_ON_TRIANGLES 0u
#endif

#if !OWN_BODIES
uniform vec3 collider_velocity[COLLIDERS];    // [m/s] mean velocity of the centre in the substep
uniform vec3 collider_turn[3 * COLLIDERS];    // [1/s] rows of (R - 1) / h, R: rotation in the substep h
#endif
uniform float collider_friction[COLLIDERS];
uniform float collider_thickness[COLLIDERS];  // [m] min. length of a path through it
uniform float clearance;                      // [m] half the thickness of the cloth
uniform float compression;                    // [m/s2] acceleration by a compression to nothing
uniform float way_out_speed;                  // [m/s] speed at which a node inside is moved out
float half_cloth = READ_FIRST(clearance);
float out_speed = READ_FIRST(way_out_speed);

#if COLLIDERS <= 4
#if OWN_BODIES
vec3 body_velocity[COLLIDERS];
vec3 body_turn[3 * COLLIDERS];
#else
vec3 body_velocity[COLLIDERS] = vec3[](EACH_BODY(collider_velocity));
vec3 body_turn[3 * COLLIDERS] = vec3[](ROWS_OF_EACH_BODY(collider_turn));
#endif
float body_friction[COLLIDERS] = float[](EACH_BODY(collider_friction));
float body_thickness[COLLIDERS] = float[](EACH_BODY(collider_thickness));
#elif OWN_BODIES
vec3 body_velocity(int i) { return own_entry(i, OWN_VELOCITY).xyz; }
vec3 body_turn(int row, int i) { return own_entry(i, OWN_TURN + row).xyz; }
float body_friction(int i) { return collider_friction[i]; }
float body_thickness(int i) { return collider_thickness[i]; }
#else
#define body_velocity collider_velocity
#define body_turn collider_turn
#define body_friction collider_friction
#define body_thickness collider_thickness
#endif

#if OWN_BODIES
// Take where the bodies are of the cloth that the row of the stack belongs to, and how they move.
void take_bodies(int row) {
    take_places(row);
#if COLLIDERS <= 4
    for (int i = 0; i < COLLIDERS; ++i) {
        body_velocity[i] = own_entry(i, OWN_VELOCITY).xyz;
        for (int axis = 0; axis < 3; ++axis) {
            body_turn[3 * i + axis] = own_entry(i, OWN_TURN + axis).xyz;
        }
    }
#endif
}
#endif

struct Contact {
    vec3 velocity;
    vec3 normal;  // of the surface that the node slides on, or direction of the line of two surfaces
    int kind;
};

// Contacts of the last node passed to find_surfaces: the colliders that it touches, and the change
// of velocity by each.
int touched_count;
int touched[MOST_TOUCHED];
vec4 surface[MOST_TOUCHED];  // normal; w: distance less the clearance [m]
vec3 given[MOST_TOUCHED];
vec3 carried[MOST_TOUCHED];   // velocity of the surface at the node [m/s]
float pressed[MOST_TOUCHED];  // change of velocity by the pressure of a compressed cloth [m/s]
vec3 pressing[MOST_TOUCHED];  // the same with its direction
int held_on;                  // number of non-parallel surfaces that act on it
#if COLLIDERS > 1
ivec2 held_by;                // the first two of them
#else
const ivec2 held_by = ivec2(0);
#endif
float spare_way = 0.0;        // [m] extra reach beyond the displacement of the node

// Rounding of positions [m]; a surface within it is in contact.
float rounding(vec3 x, int collider) {
    vec3 most = max(abs(x), abs(OF(body_centre, collider)));
    return 4e-7 * max(max(most.x, most.y), most.z) + 1e-9;
}

vec4 gap_at(int collider, vec3 x) {
    return distance_to_collider(collider, x - OF(body_centre, collider))
        - vec4(0.0, 0.0, 0.0, half_cloth);
}

// Mean velocity over the substep of the material point of the collider that is at x at the beginning.
// It includes the full rotation, so that nothing creeps on a rotating collider.
vec3 surface_velocity(int collider, vec3 x) {
    vec3 arm = x - OF(body_centre, collider);
    return OF(body_velocity, collider) + vec3(
        dot(ROW_OF(body_turn, 0, collider), arm), dot(ROW_OF(body_turn, 1, collider), arm),
        dot(ROW_OF(body_turn, 2, collider), arm));
}

// As gap_at, at the end of a substep of h seconds.
vec4 gap_at_end(int collider, vec3 x, float h) {
    vec3 row_x = ROW_OF(body_turn, 0, collider);
    vec3 row_y = ROW_OF(body_turn, 1, collider);
    vec3 row_z = ROW_OF(body_turn, 2, collider);
    vec3 arm = x - OF(body_centre, collider) - h * OF(body_velocity, collider);
    arm += h * (arm.x * row_x + arm.y * row_y + arm.z * row_z);
    vec4 near = distance_to_collider(collider, arm);
    near.xyz += h * vec3(dot(row_x, near.xyz), dot(row_y, near.xyz), dot(row_z, near.xyz));
    return near - vec4(0.0, 0.0, 0.0, half_cloth);
}

// The bodies that a node at x may reach in the time h at the velocity towards. llvmpipe computes for
// each node what any node of its vector needs, so most bodies are ruled out first.
uint bodies_towards(vec3 x, vec3 towards, float h) {
    return NODE_COLLIDERS
        & (COLLIDERS > 1 ? near_bodies(x, 0.0, h * length(towards) + spare_way) : 1u);
}

// Store the surfaces of bodies that a node at x can reach in the time h at the velocity towards, and
// that act on the velocity v.
void find_surfaces(uint bodies, vec3 x, vec3 towards, vec3 v, float h) {
    touched_count = 0;
    for (; bodies != 0u; bodies &= bodies - 1u) {
        int collider = first_of(bodies);
        vec4 near = gap_at(collider, x);
        vec3 velocity = surface_velocity(collider, x);
        float way = h * length(towards - velocity) + spare_way;
        if (!(near.w < way + rounding(x, collider))) {
            continue;
        }
        int place = COLLIDERS > 1 ? touched_count : 0;
        if (COLLIDERS > MOST_TOUCHED && touched_count == MOST_TOUCHED) {
            place = 0;
            for (int i = 1; i < MOST_TOUCHED; ++i) {
                place = AT(surface, i).w > AT(surface, place).w ? i : place;
            }
            if (near.w >= AT(surface, place).w) {
                continue;
            }
        } else {
            ++touched_count;
        }
        PUT(touched, place, collider);
        PUT(surface, place, near);
        PUT(given, place, vec3(0.0));
        PUT(carried, place, velocity);
        PUT(pressed, place, 0.0);
        PUT(pressing, place, vec3(0.0));
    }
    // The tangent plane of a curved surface extends beyond it. A node that passes by is not held by it;
    // one that could pass through a thin collider is.
    if (touched_count == 1) {
        int collider = TOUCHED(0);
        // Only the normal component of v counts: edges may pull a sticking node along the surface
        // with any force, and without friction it would seem to pass by.
        vec3 n = surface[0].xyz;
        vec3 passing = towards + dot(n, v - towards) * n;
        vec3 w = passing - carried[0];
        bool is_short = 2.0 * h * length(w) < OF(body_thickness, collider);
        bool may_pass = surface[0].w > rounding(x, collider) && is_short;
        // A loop, as few nodes pass by.
        for (uint asks = may_pass ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
            touched_count = gap_at_end(collider, x + h * passing, h).w >= 0.0 ? 0 : 1;
        }
    }
}

// Whether surface_pressing.glsl finds the pressure of two bodies.
bool is_thin_pair(int one, int other) {
    return (PRESS_ON_TRIANGLES & (1u << uint(one) | 1u << uint(other))) != 0u;
}

// Whether surfaces with these normals face each other; room: sum of their gaps [m]. Bodies that
// overlap beside a node leave it no place between them: it goes out along both.
bool are_facing(int one, int other, vec3 normal, vec3 facing, float room) {
    bool may_turn = is_thin_pair(one, other) && room + 2.0 * half_cloth >= 0.0;
    return dot(normal, facing) <= (may_turn ? -FACING_THIN : -FACING);
}

#if COLLIDERS > 1
// A surface without friction presses along its normal. The friction of the other surface takes the
// component that drives the node out; two equal surfaces take half of it each.
vec3 pressing_direction(int i, int j) {
    float other = OF(body_friction, TOUCHED(i));
    float own = OF(body_friction, TOUCHED(j));
    vec2 share = own + other > 0.0 ? vec2(own, other) : vec2(1.0);
    return normalize(share.x * AT(surface, i).xyz - share.y * AT(surface, j).xyz);
}

// Two surfaces that face each other compress the cloth where their distance is less than its
// thickness: the node stays between them, and both press on it. They share the missing distance and
// the difference of their velocities along the normal.
void find_compression(float h) {
    for (int i = FROM(1); i < touched_count; ++i) {
        for (int j = FROM(0); j < i; ++j) {
            vec3 n = normalize(AT(surface, i).xyz - AT(surface, j).xyz);
            vec3 towards = pressing_direction(i, j);
            float closing = dot(n, AT(carried, i) - AT(carried, j));
            float room = AT(surface, i).w + AT(surface, j).w;
            float room_at_end = room - h * closing;
            if (!are_facing(
                    TOUCHED(i), TOUCHED(j), AT(surface, i).xyz, AT(surface, j).xyz, room)
                    || min(room, room_at_end) >= 0.0) {
                continue;
            }
            float half_room = 0.5 * min(room, 0.0);
            PUT(surface, i, vec4(n, AT(surface, i).w - half_room));
            PUT(surface, j, vec4(-n, AT(surface, j).w - half_room));
            vec3 half_closing = 0.5 * closing * n;
            PUT(carried, i, AT(carried, i) - half_closing);
            PUT(carried, j, AT(carried, j) + half_closing);
            float share = clamp(-room_at_end / max(2.0 * half_cloth, 1e-30), 0.0, 1.0);
            share = is_thin_pair(TOUCHED(i), TOUCHED(j)) ? 0.0 : share;
            float press = h * compression * share;
            PUT(pressed, i, AT(pressed, i) + press);
            PUT(pressed, j, AT(pressed, j) + press);
            PUT(pressing, i, AT(pressing, i) + press * towards);
            PUT(pressing, j, AT(pressing, j) - press * towards);
        }
    }
}
#endif

// Speed along the normal that v lacks for a node at x to end on the surface i [m/s].
float lacking(int i, vec3 x, vec3 v, float h) {
    float least = -max(AT(surface, i).w - rounding(x, TOUCHED(i)), 0.0) / h;
    return least - dot(AT(surface, i).xyz, v - AT(carried, i));
}

// The velocity w relative to the surface i after contact and friction.
vec3 held_on_surface(int i, vec3 w, float closest, float h, out int kind) {
    vec4 near = AT(surface, i);
    float friction = OF(body_friction, TOUCHED(i));
    float least = -max(near.w - closest, 0.0) / h;
    float along_normal = dot(near.xyz, w);
    float impulse = max(least - along_normal, 0.0) + AT(pressed, i);
    vec3 along = w - along_normal * near.xyz;
    float speed = length(along);
    bool sticks = friction > 0.0 && speed <= friction * impulse;
    kind = impulse > 0.0 ? sticks ? STICKS : SLIDES : FREE;
    if (kind == FREE) {
        return w;
    }
    return max(along_normal, least) * near.xyz
        + (sticks ? vec3(0.0) : (1.0 - friction * impulse / max(speed, 1e-30)) * along);
}

bool are_parallel(int i, int j) {
    return abs(dot(AT(surface, i).xyz, AT(surface, j).xyz)) > FACING;
}

// Parallel surfaces, facing each other or the same way, take one direction.
void note_held(int i, bool is_held) {
#if COLLIDERS > 1
    if (is_held && (held_on < 1 || !are_parallel(i, held_by.x))
            && (held_on < 2 || !are_parallel(i, held_by.y))) {
        held_by = held_on == 0 ? ivec2(i) : held_on == 1 ? ivec2(held_by.x, i) : held_by;
        ++held_on;
    }
#else
    held_on = is_held ? 1 : 0;
#endif
}

// A node in contact with three surfaces has no free direction: it sticks for the substep.
int kind_held(bool sticks) {
    return sticks || held_on > 2 ? STICKS : held_on == 2 ? SLIDES_ON_TWO
        : held_on == 1 ? SLIDES : FREE;
}

// Let each surface in turn act on the velocity of a node at x; return how far that changed it.
float act_in_turn(vec3 x, float h, inout Contact found) {
    bool sticks = false;
    held_on = 0;
    vec3 before = found.velocity;
    FOR_TOUCHED(i) {
        int kind;
        vec3 without = found.velocity - AT(given, i);
        vec3 with = AT(carried, i) + held_on_surface(
            i, without - AT(carried, i), rounding(x, TOUCHED(i)), h, kind);
        vec3 change = kind == FREE ? vec3(0.0) : with - without;
        PUT(given, i, change);
        found.velocity = kind == FREE ? without : with;
        sticks = sticks || kind == STICKS;
        note_held(i, kind != FREE);
    }
    found.kind = kind_held(sticks);
    found.normal = AT(surface, held_on > 0 ? held_by.x : 0).xyz;
    return length(found.velocity - before);
}

// Missing velocity of a node at x along the normals of two surfaces that hold it, for velocity v.
vec2 lacking_on_two(vec3 x, vec3 v, float h) {
    float c = dot(AT(surface, held_by.x).xyz, AT(surface, held_by.y).xyz);
    vec2 lacks = vec2(lacking(held_by.x, x, v, h), lacking(held_by.y, x, v, h));
    return (lacks - c * lacks.yx) / (1.0 - c * c);
}

// A node that slides on two surfaces is free along their line only. At a sharp angle between them
// the iteration converges slowly, so the velocity across the line is corrected directly.
void slide_on_two(vec3 x, float h, inout Contact found) {
    vec3 n = AT(surface, held_by.x).xyz;
    vec3 m = AT(surface, held_by.y).xyz;
    vec2 lacks = lacking_on_two(x, found.velocity, h);
    PUT(given, held_by.x, AT(given, held_by.x) + lacks.x * n);
    PUT(given, held_by.y, AT(given, held_by.y) + lacks.y * m);
    found.velocity += lacks.x * n + lacks.y * m;
    found.normal = normalize(cross(n, m));
}

// Whether the velocity found enters a surface by more than the tolerance of the iteration.
bool is_any_lacking(vec3 x, vec3 v, vec3 found, float h) {
    float most = -1.0;
    FOR_TOUCHED(i) {
        most = max(most, lacking(i, x, found, h) - 1e-4 * length(v - AT(carried, i)));
    }
    return most > 0.0;
}

// In a closing wedge, friction can hold a node against any force that drives it out. Then no velocity
// obeys Coulomb's law on all surfaces, and the iteration does not end. Bodies are rigid, so friction
// is left out, and only the normals act.
void slip_out(vec3 x, vec3 v, float h, inout Contact found) {
    bool is_jammed = is_any_lacking(x, v, found.velocity, h);
    found.velocity = is_jammed ? v : found.velocity;
    for (int round = 0; is_jammed && round < MOST_ROUNDS; ++round) {
        held_on = 0;
        FOR_TOUCHED(i) {
            vec3 normal = AT(surface, i).xyz;
            float before = round > 0 ? dot(AT(given, i), normal) : 0.0;
            float impulse = max(before + lacking(i, x, found.velocity, h), 0.0);
            PUT(given, i, impulse * normal);
            found.velocity += (impulse - before) * normal;
            note_held(i, impulse > 0.0);
        }
    }
    if (is_jammed) {
        found.kind = kind_held(false);
        found.normal = AT(surface, held_on > 0 ? held_by.x : 0).xyz;
    }
}

// The velocity of a node at x in the next h seconds, v without these bodies. Contact is decided by
// the displacement h * towards: the part of v that a surface balances moves the node nowhere.
Contact contact_with(uint bodies, vec3 x, vec3 towards, vec3 v, float h) {
    find_surfaces(bodies, x, towards, v, h);
    Contact found = Contact(v, vec3(0.0), FREE);
    if (touched_count == 0) {
        return found;
    }
#if COLLIDERS > 1
    // llvmpipe runs the body of a branch for all nodes, but skips a loop without rounds.
    uint several = touched_count > 1 ? 1u : 0u;
    for (uint asks = several; asks != 0u; asks &= asks - 1u) {
        find_compression(h);
    }
#endif
    // Each surface changes the result of the others, so iterate.
    int rounds = COLLIDERS > 1 && touched_count > 1 ? MOST_ROUNDS : 1;
    float change = 1e30;
    for (int round = 0; round < rounds && change > 1e-6 * length(v); ++round) {
        change = act_in_turn(x, h, found);
    }
#if COLLIDERS > 1
    for (uint asks = several; asks != 0u; asks &= asks - 1u) {
        slip_out(x, v, h, found);
        if (found.kind == SLIDES_ON_TWO) {
            slide_on_two(x, h, found);
        }
    }
#endif
    return found;
}

// As contact_with, with all bodies.
Contact contact_at(vec3 x, vec3 towards, vec3 v, float h) {
    return contact_with(bodies_towards(x, towards, h), x, towards, v, h);
}

// Share of the surface i in the missing gap of a node at x [m]; near: its gap at the end.
float room_lacking(int i, vec4 near, vec3 x, float h) {
    float lacking = 0.0;
#if COLLIDERS > 1
    int others = touched_count > 1 ? touched_count : 0;
    for (int j = FROM(0); j < others; ++j) {
        vec4 other = gap_at_end(TOUCHED(j), x, h);
        float room = near.w + other.w;
        if (j != i && are_facing(TOUCHED(i), TOUCHED(j), near.xyz, other.xyz, room)) {
            lacking = max(lacking, -0.5 * room);
        }
    }
#endif
    return lacking;
}

// Position to which a node at x after h seconds is moved, if x is inside a body. Leaving one body may
// mean entering another, so they take turns, within one shared displacement.
vec3 moved_out(vec3 x, float h) {
    float way = h * out_speed;
    int rounds = COLLIDERS > 1 && touched_count > 1 ? MOST_ROUNDS_OUT : 1;
    for (int round = 0; round < rounds; ++round) {
        float moved = 0.0;
        FOR_TOUCHED(i) {
            int collider = TOUCHED(i);
            vec4 near = gap_at_end(collider, x, h);
            near.w += room_lacking(i, near, x, h);
            float out_of = near.w < -rounding(x, collider) ? min(-near.w, way) : 0.0;
            x += out_of * near.xyz;
            moved += out_of;
        }
        way -= moved;
        if (moved == 0.0) {
            break;
        }
    }
    return x;
}
