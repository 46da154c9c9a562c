// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Find the contacts of one substep or several, PAIRS_EACH pairs an invocation, at the positions that
// they begin with. A pair acts where its features own the nearest points, so that layers do not catch on inner
// edges: a point in a triangle, two points within edges, or a corner or edge that all triangles around
// it name.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/features.glsl"
#include "self_contact/nearest.glsl"
#include "self_contact/head.glsl"
#include "self_contact/pairs.glsl"
#include "self_contact/contacts.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(std430, binding = SELF_PAIRS) buffer SelfPairs { Pair pairs[]; };
layout(std430, binding = SELF_KEPT) writeonly buffer SelfKept { vec4 kept[]; };
layout(binding = SELF_KEPT) uniform samplerBuffer kept_texels;
layout(std430, binding = SELF_CONTACTS) buffer SelfContacts { SelfContact contacts_found[]; };
layout(binding = VELOCITY_OUT) uniform samplerBuffer velocity_out;

// EDGE_THICKNESS: between two edges, over that between a node and a triangle [1].
// Gap over the thickness [1] up to which a pair is looked at that moves slowly.
#define SPARE 0.002
// Gap within which a contact is found, over what it may close by while it serves [1]; chosen: from 1
// to 2 layers of a heap overlap by 16 to 17 um, with 0.5 by 27 um.
#define AHEAD 1.25
// Fraction of the relative speed of nodes that may turn towards the normal meanwhile [1]; chosen:
// from 0.1 to 1 they overlap by 16 um, with 0 by 18 um (constants.py --only AHEAD PART_OF_SPEED).
#define PART_OF_SPEED 0.1
// Least square of the sine between two edges that touch [1].
#define LEAST_SQUARE 1e-6

uniform float substep;      // [s]
uniform float thickness;    // [m] from middle to middle
uniform float friction;     // [1]
uniform float kept_share;   // of the impulses of the last substep, by its length [1]
uniform float window;       // substeps that the contacts are to serve [1]
uniform float least_speed_unit;  // [m/s] that gravity gives in a substep

vec3 place_of(int index) { return load_position(index).xyz; }

// Speed at which two features may approach while their contact serves, without contact [m/s]: that
// along the normal, part of the relative speed of their nodes, as velocities turn, and that of gravity.
float closing_speed(ivec4 nodes, vec3 weights, vec3 normal) {
    vec3 v = texelFetch(velocity_out, nodes.x).xyz;
    vec3 a = texelFetch(velocity_out, nodes.y).xyz - v;
    vec3 b = texelFetch(velocity_out, nodes.z).xyz - v;
    vec3 c = texelFetch(velocity_out, nodes.w).xyz - v;
    vec3 u = weights.y * a + weights.z * b + last_weight(weights) * c;
    return max(-dot(u, normal), 0.0) + PART_OF_SPEED * max(length(a), max(length(b), length(c)))
        + least_speed_unit;
}

// Whether the triangle beyond an edge from a to b agrees that d, from a point of the edge, is
// nearest there; c: its third corner.
bool agrees(vec3 a, vec3 b, vec3 c, vec3 d) {
    vec3 along = b - a, inwards = c - a;
    inwards -= dot(inwards, along) / max(dot(along, along), 1e-30) * along;
    return dot(inwards, d) <= 0.0;
}

// Whether the point q, which is nearest to an edge of a triangle, touches that edge; d: from it.
bool touches_edge(int index, int face, int place, vec3 d) {
    int owner = face >> 1;
    // The edge, the two triangles beside it with their third corners, the one that speaks first.
    int edge = (face & 1) == 0
        ? (place == ON_AB ? 4 * owner + DOWN : place == ON_BC ? 4 * owner + ACROSS
            : 4 * owner + RIGHT)
        : (place == ON_AB ? 4 * owner + ACROSS : place == ON_BC ? 4 * (owner + PITCH) + RIGHT
            : 4 * (owner + 1) + DOWN);
    int base = edge >> 2, kind = edge & 3;
    int first_cell = base;
    int second_cell = kind == RIGHT ? base - PITCH : kind == DOWN ? base - 1 : base;
    int first_corner = kind == RIGHT ? base + PITCH : kind == DOWN ? base + 1 : base;
    int second_corner = kind == RIGHT ? base - PITCH + 1 : kind == DOWN ? base - 1 + PITCH
        : base + PITCH + 1;
    bool has_first = has_cell(first_cell), has_second = has_cell(second_cell);
    bool is_first = first_cell == owner && (face & 1) == 0;
    if (!is_first && has_first) {
        return false;
    }
    if (has_first && first_corner == index || has_second && second_corner == index) {
        return false;
    }
    ivec2 ends = edge_nodes(edge);
    vec3 a = place_of(ends.x), b = place_of(ends.y);
    return (!has_first || agrees(a, b, place_of(first_corner), d))
        && (!has_second || agrees(a, b, place_of(second_corner), d));
}

// The same for the corner at the node `corner`.
bool touches_corner(int index, int face, int corner, vec3 d) {
    // The triangles around it, each with its two other corners, in the order in which they speak.
    int faces[6] = int[6](
        2 * corner, 2 * (corner - 1) + 1, 2 * (corner - PITCH), 2 * (corner - 1),
        2 * (corner - PITCH) + 1, 2 * (corner - PITCH - 1) + 1);
    vec3 b = place_of(corner);
    bool is_first = true;
    for (int i = 0; i < 6; ++i) {
        if (!has_cell(faces[i] >> 1)) {
            continue;
        }
        if (is_first && faces[i] != face) {
            return false;
        }
        is_first = false;
        ivec3 nodes = face_nodes(faces[i]);
        for (int k = 0; k < 3; ++k) {
            if (nodes[k] == index || dot(d, place_of(nodes[k]) - b) > 0.0) {
                return false;
            }
        }
    }
    return true;
}

void add_contact(uint pair, ivec4 nodes, vec3 weights, vec3 d, float distance, float least) {
    vec3 normal = d / max(distance, 1e-30);
    float gap = gap_of(distance - least, place_of(nodes.x));
    // What it had in the last substep, along the normal of this one.
    vec3 before = kept_share * texelFetch(kept_texels, int(pair)).xyz;
    float pressed = clamp(dot(before, normal), 0.0, most_impulse());
    vec3 along = before - dot(before, normal) * normal;
    float l = length(along);
    along *= l > friction * pressed ? friction * pressed / max(l, 1e-30) : 1.0;
    vec3 impulse = pressed * normal + along;
    uint at = atomicAdd(contact_count, 1u);
    atomicAdd(contact_groups[0], at % (SELF_LOCAL * CONTACTS_EACH) == 0u ? 1u : 0u);
    // A contact that may act later counts once it does: rounds are slower by what they allow for.
#if IS_IMPLICIT
    // Solves end while contacts still come and go by their tolerance, and layers would tremble.
    bool acts = true;
#else
    bool acts = pressed > 0.0 || gap <= 0.0;
#endif
    contacts_found[at] = SelfContact(
        nodes, vec4(normal, gap), vec4(impulse, uintBitsToFloat(pair)),
        weights, acts ? least : -least);
    for (int i = 0; i < 4; ++i) {
        atomicAdd(self_nodes[nodes[i]].contacts, 1u);
    }
    if (!acts) {
        kept[pair] = vec4(0.0);
    }
}

// The nearest points of a pair.
struct Nearest {
    vec3 d;          // from the second feature to the first [m]
    float distance;  // [m]
    vec3 weights;    // of the first three nodes
    int place;       // in the triangle, as nearest.glsl has it
    bool is_within;  // both edges
};

Nearest nearest_of(ivec4 nodes) {
    vec3 x = place_of(nodes.x);
    vec3 a = place_of(nodes.y) - x, b = place_of(nodes.z) - x, c = place_of(nodes.w) - x;
    Nearest found;
    found.place = INSIDE;
#if OF_EDGES
    vec3 near = nearest_on_segments(vec3(0.0), a, b, c - b);
    found.d = near.x * a - b - near.y * (c - b);
    found.weights = vec3(1.0 - near.x, near.x, near.y - 1.0);
    found.is_within = near.x > 0.0 && near.x < 1.0 && near.y > 0.0 && near.y < 1.0
        && near.z > LEAST_SQUARE;
#else
    vec3 at = nearest_in_triangle(a, b, c, found.place);
    found.d = -(at.x * a + at.y * b + at.z * c);
    found.weights = vec3(1.0, -at.xy);
    found.is_within = true;
#endif
    found.distance = length(found.d);
    return found;
}

// Whether a pair comes to the thickness while contacts serve.
bool may_touch(Nearest found, ivec4 nodes, float least) {
    float speed = closing_speed(
        nodes, found.weights, found.d / max(found.distance, 1e-30));
    return found.is_within
        && found.distance <= least + max(SPARE * thickness, AHEAD * window * substep * speed);
}

// Whether all triangles around the nearest point agree that it is nearest.
bool is_owned(Nearest found, ivec4 nodes, uint face) {
#if !OF_EDGES
    if (found.place <= AT_C) {
        return touches_corner(nodes.x, int(face), nodes[1 + found.place], found.d);
    }
    if (found.place != INSIDE) {
        return touches_edge(nodes.x, int(face), found.place, found.d);
    }
#endif
    return true;
}

#define EACH_BIT(BITS) uint rest = BITS; rest != 0u; rest &= rest - 1u

// Software does for all of its lanes what one of them has to do, so each invocation sorts out its pairs
// by a cheap test before the next one.
void main() {
    float least = OF_EDGES == 1 ? EDGE_THICKNESS * thickness : thickness;
    uint looked = 0u, touching = 0u, ended = 0u;
    for (int k = 0; k < PAIRS_EACH; ++k) {
        bool is_there = has_pair(k);
        Pair pair = load_pair(is_there ? pair_place(k) : 0u);
        // Pairs that may touch while contacts serve, by how far their cells moved in the last substep.
        vec2 ways = ways_of(pair);
        float reach = least + max(
            SPARE * thickness, 1.2 * AHEAD * window * (ways.y + substep * least_speed_unit));
        looked |= is_there && pair.distance - ways.x <= reach ? 1u << k : 0u;
    }
    float nearest = 1e30;
    for (EACH_BIT(looked)) {
        int k = findLSB(rest);
        uint i = pair_place(k);
        Pair pair = load_pair(i);
        ivec4 nodes = pair_nodes(pair.own, pair.other);
        Nearest found = nearest_of(nodes);
        pairs[i].distance = found.distance + ways_of(pair).x;
        nearest = found.distance < nearest ? found.distance : nearest;
        bool touches = may_touch(found, nodes, least);
        touching |= touches ? 1u << k : 0u;
        bool has_kept = texelFetch(kept_texels, int(i)).xyz != vec3(0.0);
        ended |= has_kept && !touches ? 1u << k : 0u;
    }
    if (looked != 0u) {
        atomicMin(least_distance, floatBitsToUint(nearest));
    }
    for (EACH_BIT(touching)) {
        int k = findLSB(rest);
        uint i = pair_place(k);
        Pair pair = load_pair(i);
        ivec4 nodes = pair_nodes(pair.own, pair.other);
        Nearest found = nearest_of(nodes);
        if (is_owned(found, nodes, pair.other)) {
            add_contact(i, nodes, found.weights, found.d, found.distance, least);
        } else {
            ended |= 1u << k;
        }
    }
    for (EACH_BIT(ended)) {
        kept[pair_place(findLSB(rest))] = vec4(0.0);
    }
}
