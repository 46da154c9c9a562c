// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Let thin colliders act on edges and faces of the cloth, in an explicit substep that has been made,
// before it is the present state: one workgroup, at the nodes that near_nodes.comp lists. It also
// does what contact.comp does at the nodes that it changes. NOTES_CHANGES as in contact.comp.
// FINDS_IMPULSES 0: list the nodes and move them out alone, after a substep of the implicit step.
//
// Rounds find the impulses: each row of a contact takes the velocity of its nodes, and each node
// the impulses of its rows. With s_k the sum of the weights of the rows of the node k, D = sum_k
// w_k s_k / m_k is no less than what an impulse changes, whatever the other rows do.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "contact.glsl"
#include "near_blocks.glsl"
#include "low_parts.glsl"
#include "surface_rows.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

layout(std430, binding = POSITION_OUT) coherent buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) coherent buffer VelocityOut { vec4 velocity_out[]; };

#include "contact_record.glsl"
#if NOTES_CHANGES
layout(std430, binding = LIMIT_CHANGES) buffer Changes { vec4 changes[]; };
#endif

// Max. rounds of impulses in a substep [1].
#define IMPULSE_ROUNDS 30
// Max. searches for what is left within a collider, and rounds of ways out after each [1]; chosen:
// 200 random bodies are entered by 1e-7 m, and by 7e-6 m with 2 and 8 (test_thin_bodies.py --long).
#define WAY_SEARCHES 20
#define WAY_ROUNDS 12
// Change of an impulse in a round, over the largest impulse [1], at which rounds end. Two layers
// on a rod end 1.3e-5, 8.6e-6, 6.8e-6, 5.6e-6 and 5.9e-6 m from one layer at 2e-2, 1e-2, 5e-3,
// 2e-3 and 1e-4 (test_self_contact.py -k do_not_press); a rod under 64 x 64 nodes takes 4 % longer
// at 5e-3 than at 2e-2.
#define STILL 5e-3
// The same [1] above which the last round has not settled: between bodies that leave no room, say.
#define UNSETTLED 0.02

uniform float substep;     // [s]
uniform int block_count;   // in all
uniform int most_entries;

vec4 load_begin(int index) { return load_position(index); }

vec3 load_end(int index) { return position_out[index].xyz; }

#if FINDS_IMPULSES && !WAYS_OUT
#define WRITES_NEXT 1
#include "next_state.glsl"

// Rows are found before velocities are written; masses stay.
vec3 load_speed(int index) { return load_next_velocity(index).xyz; }

float inverse_mass(int index) { return load_next_velocity(index).w; }
#else
vec3 load_speed(int index) { return velocity_out[index].xyz; }

float inverse_mass(int index) { return velocity_out[index].w; }
#endif

#include "surface_find.glsl"
#if COLLIDERS > 1
#include "surface_facing.glsl"
#endif
// Whether colliders that leave the cloth too little room press on triangles.
#define HAS_PRESSURE (COLLIDERS > 1 && FINDS_IMPULSES && !WAYS_OUT)
#if HAS_PRESSURE
#include "surface_pressing.glsl"
#endif

bool are_listed(ivec3 nodes) {
    return surface_nodes[nodes.x].is_listed == 1 && surface_nodes[nodes.y].is_listed == 1
        && surface_nodes[nodes.z].is_listed == 1;
}

#if HAS_SELF
// Parts of the pass, so that layers of the cloth act between them: list rows, let them act, and give
// nodes the resulting velocity. self_contact/nodes.comp does that for nodes which layers act on.
#define LISTS 1
#define ACTS 2
#define GIVES 4

layout(binding = SELF_NODES) uniform samplerBuffer self_texels;

uniform int parts;
uniform float layer_unit;  // [m/s] of impulses of layers; 0: there are none

bool has_part(int part) { return (parts & part) != 0; }

// Whether contacts of layers were found at a node, as contacts.glsl has it.
bool has_layers(int index) {
    return layer_unit > 0.0 && floatBitsToUint(texelFetch(self_texels, 3 * index + 2).y) != 0u;
}

// Impulse of layers on a node [m/s].
vec3 by_layers(int index) {
    return layer_unit > 0.0
        ? layer_unit * vec3(floatBitsToInt(texelFetch(self_texels, 3 * index).xyz)) : vec3(0.0);
}
#define ALL_IMPULSES(index) (gathered(index) + by_layers(index))
#else
#define ALL_IMPULSES(index) gathered(index)
#endif

void synchronise() {
    memoryBarrierBuffer();
    barrier();
}

#if FINDS_IMPULSES && !WAYS_OUT
// Impulse of a row in the substep before, for one of this length [m/s]; 0 where it did not act.
vec3 kept_impulse(int place) {
    vec4 before = kept[place];
    bool is_last = kept_length > 0.0 && floatBitsToUint(before.w) + 1u == kept_time;
    return is_last ? substep / kept_length * before.xyz : vec3(0.0);
}

// Keep the impulses of the rows that act for the next substep.
void keep_impulses() {
    for (uint i = gl_LocalInvocationID.x; i < acting_rows; i += SURFACE_LOCAL) {
        uvec2 acting = surface_rows[i].acting;
        SurfaceRow found = surface_rows[acting.x].row;
        int row = int(acting.x) % SURFACE_ROWS_OF_BODY;
#if COLLIDERS > 1
        found.impulse.xyz -= row < FIRST_PRESSED
            ? surface_rows[acting.x].facing.xyz : vec3(0.0);
#endif
        kept[kept_place(int(acting.y), int(found.weights.w), row)] =
            vec4(found.impulse.xyz, uintBitsToFloat(kept_time));
    }
    if (gl_LocalInvocationID.x == 0u) {
        kept_length = substep;
    }
}
#endif

// What is read of an entry, which belongs to a node and a collider.
struct Entry {
    int index;
    int collider;
    int first_row;  // its place
};

Entry entry_at(uint i) {
    int first = int(i) * SURFACE_ROWS_OF_BODY;
    uvec2 owner = surface_rows[first].entry;
    return Entry(int(owner.x), int(owner.y), first);
}

// Let find_listed find a row.
void list_row(Entry entry, int row) {
    surface_rows[atomicAdd(listed_rows, 1u)].spare.x = uint(entry.first_row + row);
}

// List the edges of an entry that may touch: lanes find together what few of them have.
void list_edges(Entry entry) {
    surface_rows[entry.first_row].spare.y = 0u;
    EdgeEnd ends[3] = EdgeEnd[3](
        edge_end(entry.collider, entry.index), edge_end(entry.collider, entry.index + 1),
        edge_end(entry.collider, entry.index + PITCH));
    bool may[SURFACE_EDGES] = bool[SURFACE_EDGES](
        may_edge_touch(entry.collider, ends[0], ends[1]),
        may_edge_touch(entry.collider, ends[0], ends[2]),
        may_edge_touch(entry.collider, ends[1], ends[2]));
    for (int row = 0; row < SURFACE_EDGES; ++row) {
        surface_rows[entry.first_row + row].row.impulse.w = 0.0;
        if (may[row] && owns(entry.index, row)) {
            list_row(entry, row);
        }
    }
}

// The same of its faces.
void list_faces(Entry entry) {
    bool is_there = owns(entry.index, SURFACE_EDGES);
    vec3 places[4];
    float ways[4];
    for (int corner = 0; corner < 4; ++corner) {
        int index = entry.index + corner / 2 * PITCH + corner % 2;
        places[corner] = place_of(index);
        ways[corner] = is_at_end ? 0.0 : way_of(entry.collider, index);
    }
    vec3 first[3] = vec3[3](places[0], places[2], places[1]);
    vec3 second[3] = vec3[3](places[1], places[2], places[3]);
    float inner = max(ways[1], ways[2]);
    for (int row = SURFACE_EDGES; row < FIRST_PRESSED; ++row) {
        bool is_first = row < SURFACE_EDGES + SURFACE_TIPS;
        int tip = (row - SURFACE_EDGES) % SURFACE_TIPS;
        surface_rows[entry.first_row + row].row.impulse.w = 0.0;
        bool may = is_first ? may_face_touch(entry.collider, first, max(inner, ways[0]), tip)
            : may_face_touch(entry.collider, second, max(inner, ways[3]), tip);
        if (is_there && may) {
            list_row(entry, row);
        }
    }
}

#if HAS_PRESSURE
// The same of the pressure on its triangles.
void list_pressed(Entry entry) {
    uint triangles = owns(entry.index, SURFACE_EDGES) ? 3u : 0u;
    // Not unrolled, as Mesa does with a loop over both.
    for (; triangles != 0u; triangles &= triangles - 1u) {
        int row = FIRST_PRESSED + findLSB(triangles);
        if (may_be_pressed(
                entry.collider, triangle_at(entry.index + surface_offsets(row)))) {
            list_row(entry, row);
        }
    }
}
#endif

// Add a row that acts to the lists.
void list_acting(Entry entry, int row, SurfaceRow found) {
    int slot = entry.first_row + row;
    ivec3 nodes = entry.index + surface_offsets(row);
    surface_rows[slot].row = found;
    atomicOr(surface_rows[entry.first_row].spare.y, 1u << uint(row));
    surface_rows[atomicAdd(acting_rows, 1u)].acting = uvec2(slot, entry.index);
    for (int i = 0; i < surface_row_count(row); ++i) {
        surface_nodes[nodes[i]].is_held = 1;
    }
}

// A row of which a node is not listed does not act.
SurfaceRow with_listed_nodes(Entry entry, int row, SurfaceRow found) {
    if (found.impulse.w != 0.0 && !are_listed(entry.index + surface_offsets(row))) {
        atomicAdd(surface_missed, 1u);
        return no_row();
    }
    return found;
}

// Add the row of an edge or a face, if it acts.
void add_row(Entry entry, int row, SurfaceRow found) {
    found = with_listed_nodes(entry, row, found);
    if (found.impulse.w != 0.0) {
#if COLLIDERS > 1
        ivec3 nodes = entry.index + surface_offsets(row);
        vec3 x = vec3(0.0);
        for (int i = 0; i < surface_row_count(row); ++i) {
            x += found.weights[i] * place_of(nodes[i]);
        }
        find_facing(found, entry.collider, x);
        surface_rows[entry.first_row + row].facing = vec4(0.0);
#endif
#if FINDS_IMPULSES && !WAYS_OUT
        found.impulse.xyz = kept_impulse(kept_place(entry.index, entry.collider, row));
#if COLLIDERS > 1
        // Two that face each other could keep pressing on each other with any force.
        found.impulse.xyz *= facing_of(found) >= 0 ? 0.0 : 1.0;
#endif
#endif
        list_acting(entry, row, found);
    }
}

#if HAS_PRESSURE
// Add the row of the pressure on a triangle, if there is any.
void add_pressed(Entry entry, int row) {
    float press;
    SurfaceRow found = pressed_row(
        entry.collider, triangle_at(entry.index + surface_offsets(row)), press);
    found = with_listed_nodes(entry, row, found);
    if (found.impulse.w != 0.0) {
        // Friction of the substep before, by both coefficients; rounds from none leave creep.
        found.impulse.xyz = kept_impulse(kept_place(entry.index, entry.collider, row));
        float own = collider_friction[entry.collider];
        float other = collider_friction[facing_of(found)];
        surface_rows[entry.first_row + row].facing = vec4(
            other / max(own + other, 1e-30) * found.impulse.xyz, press);
        list_acting(entry, row, found);
    }
}
#endif

#define OF_EDGES 0
#define OF_FACES 1
#define OF_PRESSURE 2

// Find the rows that are listed, which are of one kind.
void find_listed(int kind) {
    synchronise();
    uint edges = kind == OF_EDGES ? listed_rows : 0u;
    for (uint i = gl_LocalInvocationID.x; i < edges; i += SURFACE_LOCAL) {
        uint slot = surface_rows[i].spare.x;
        Entry entry = entry_at(slot / uint(SURFACE_ROWS_OF_BODY));
        int row = int(slot) - entry.first_row;
        ivec3 nodes = entry.index + surface_offsets(row);
        add_row(entry, row, edge_row(entry.collider, nodes.x, nodes.y));
    }
    uint faces = kind == OF_FACES ? listed_rows : 0u;
    for (uint i = gl_LocalInvocationID.x; i < faces; i += SURFACE_LOCAL) {
        uint slot = surface_rows[i].spare.x;
        Entry entry = entry_at(slot / uint(SURFACE_ROWS_OF_BODY));
        int row = int(slot) - entry.first_row;
        ivec3 nodes = entry.index + surface_offsets(row);
        add_row(entry, row, face_row(
            entry.collider, nodes, (row - SURFACE_EDGES) % SURFACE_TIPS));
    }
#if HAS_PRESSURE
    uint pressed = kind == OF_PRESSURE ? listed_rows : 0u;
    for (uint i = gl_LocalInvocationID.x; i < pressed; i += SURFACE_LOCAL) {
        uint slot = surface_rows[i].spare.x;
        Entry entry = entry_at(slot / uint(SURFACE_ROWS_OF_BODY));
        add_pressed(entry, int(slot) - entry.first_row);
    }
#endif
    synchronise();
    if (gl_LocalInvocationID.x == 0u) {
        listed_rows = 0u;
    }
    synchronise();
}

// List the rows of a node with its weight in each, in an order that is always the same, and add up
// the weights.
void list_rows_of(int index) {
    uint first = 0u;
    float shares = 0.0;
    int count = 0;
    // Once to count them, and once to write them.
    for (int pass = 0; pass < 2; ++pass) {
        first = pass == 1 ? atomicAdd(listed_rows, uint(count)) : 0u;
        count = 0;
        ivec4 owners = index - ivec4(0, 1, PITCH, PITCH + 1);
        for (int i = 0; i < 4; ++i) {
            SurfaceNode owner = surface_nodes[owners[i]];
            int bodies = owner.is_listed == 1 ? bitCount(owner.bodies) : 0;
            for (int body = 0; body < bodies; ++body) {
                int begin = (owner.first + body) * SURFACE_ROWS_OF_BODY;
                for (uint rows = surface_rows[begin].spare.y; rows != 0u; rows &= rows - 1u) {
                    int row = findLSB(rows);
                    ivec3 nodes = owners[i] + surface_offsets(row);
                    // No node twice.
                    bvec3 is_node = equal(nodes, ivec3(index));
                    if (!any(is_node) || surface_row_count(row) == 2 && !any(is_node.xy)) {
                        continue;
                    }
                    if (pass == 1) {
                        vec4 weights = surface_rows[begin + row].row.weights;
                        float weight = dot(weights.xyz, vec3(is_node));
                        uint at = first + uint(count);
                        surface_rows[at / 3u].of_node[at % 3u] =
                            uvec2(begin + row, floatBitsToUint(weight));
                        shares += weight;
                    }
                    ++count;
                }
            }
        }
    }
    surface_nodes[index].first_row = int(first);
    surface_nodes[index].row_count = count;
    surface_nodes[index].shares = shares;
}

// Sum of the impulses of the rows of a node [m/s].
vec3 gathered(int index) {
    vec3 sum = vec3(0.0);
    int first = surface_nodes[index].first_row;
    int end = first + surface_nodes[index].row_count;
    for (int i = first; i < end; ++i) {
        uvec2 row = surface_rows[i / 3].of_node[i % 3];
        sum += uintBitsToFloat(row.y) * surface_rows[row.x].row.impulse.xyz;
    }
    return sum;
}

// Bits of the largest impulse of a round, and of the largest change of one.
shared uint largest;
shared uint largest_change;
// Bits of the largest pressure of a row in the round: other impulses may be rounding beside it.
shared uint largest_pressed;

void note_round(vec3 impulse, vec3 before) {
    atomicMax(largest, floatBitsToUint(length(impulse)));
    atomicMax(largest_change, floatBitsToUint(length(impulse - before)));
}

#if !WAYS_OUT
vec3 across(vec3 v, vec3 normal) { return v - dot(v, normal) * normal; }

// What friction of a collider can be of a pull, where it is pressed on so [m/s].
vec3 within_friction(vec3 pull, int collider, float pressed) {
    float most = collider_friction[collider] * pressed;
    float size = length(pull);
    return size > most ? most / max(size, 1e-30) * pull : pull;
}

// Lets a row act on the velocities that its nodes have now.
void act(int owner, int row, int slot) {
    SurfaceRow found = surface_rows[slot].row;
    if (found.impulse.w == 0.0) {
        return;
    }
    int collider = int(found.weights.w);
    ivec3 nodes = owner + surface_offsets(row);
    vec3 u = vec3(0.0), x = vec3(0.0);
    float share = 0.0;
    for (int i = 0; i < surface_row_count(row); ++i) {
        float weight = found.weights[i];
        u += weight * velocity_out[nodes[i]].xyz;
        x += weight * load_position(nodes[i]).xyz;
        share += weight * surface_nodes[nodes[i]].shares * inverse_mass(nodes[i]);
    }
    if (share <= 0.0) {
        return;
    }
    vec3 normal = found.normal.xyz;
#if COLLIDERS > 1
    vec3 carried = carried_by(found, x);
    vec4 facing = surface_rows[slot].facing;
#else
    vec3 carried = surface_velocity(collider, x);
    const vec4 facing = vec4(0.0);
#endif
    float pressed = dot(found.impulse.xyz, normal);
    float along_normal = dot(u - carried, normal);
    float now = max(
        pressed - (along_normal + max(found.normal.w, 0.0) / substep) / share, 0.0);
    vec3 before = found.impulse.xyz - pressed * normal - facing.xyz;
    vec3 friction = within_friction(
        before - across(u - carried, normal) / share, collider, now + facing.w);
    vec3 impulse = now * normal + friction;
#if COLLIDERS > 1
    atomicMax(largest_pressed, floatBitsToUint(facing.w));
    for (uint asks = facing_of(found) >= 0 ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        int other = facing_of(found);
        vec3 slid = u - surface_velocity(other, x) + share * (friction - before);
        facing.xyz = within_friction(facing.xyz - across(slid, normal) / share, other, facing.w);
        surface_rows[slot].facing.xyz = facing.xyz;
        impulse += facing.xyz;
    }
#endif
    note_round(impulse, found.impulse.xyz);
    surface_rows[slot].row.impulse.xyz = impulse;
}

#else
// Lets a row move its nodes out of a collider; ways instead of velocities.
void act(int owner, int row, int slot) {
    SurfaceRow found = surface_rows[slot].row;
    if (found.impulse.w == 0.0) {
        return;
    }
    ivec3 nodes = owner + surface_offsets(row);
    float moved = 0.0, share = 0.0;
    for (int i = 0; i < surface_row_count(row); ++i) {
        moved += found.weights[i] * dot(surface_nodes[nodes[i]].free, found.normal.xyz);
        share += found.weights[i] * surface_nodes[nodes[i]].shares * inverse_mass(nodes[i]);
    }
    if (share <= 0.0) {
        return;
    }
    float pressed = dot(found.impulse.xyz, found.normal.xyz);
    vec3 impulse = max(pressed - (moved + found.normal.w) / share, 0.0) * found.normal.xyz;
    note_round(impulse, found.impulse.xyz);
    surface_rows[slot].row.impulse.xyz = impulse;
}

#endif

#define EACH_ROW(i) uint i = gl_LocalInvocationID.x; i < acting_rows; i += SURFACE_LOCAL
#define EACH_HELD(i) uint i = gl_LocalInvocationID.x; i < held_nodes; i += SURFACE_LOCAL
#define EACH_NEAR(i) uint i = gl_LocalInvocationID.x; i < near_node_count; i += SURFACE_LOCAL


int node_at(uint place) { return int(near[uint(block_count) + place].index); }

// Let each row act once; return whether they have come to rest.
bool rows_act() {
    if (gl_LocalInvocationID.x == 0u) {
        largest = 0u;
        largest_change = 0u;
        largest_pressed = 0u;
    }
    synchronise();
    for (EACH_ROW(i)) {
        uvec2 acting = surface_rows[i].acting;
        act(int(acting.y), int(acting.x) % SURFACE_ROWS_OF_BODY, int(acting.x));
    }
    synchronise();
    bool is_done = uintBitsToFloat(largest_change) <= STILL * uintBitsToFloat(largest);
    synchronise();
    return is_done;
}

uint held_place(uint i) { return uint(surface_nodes[i].held.x); }

int held_node(uint i) { return surface_nodes[i].held.y; }

// Find the rows, and list them with the nodes that they act on.
void find_all_rows() {
    if (gl_LocalInvocationID.x == 0u) {
        acting_rows = 0u;
        held_nodes = 0u;
        listed_rows = 0u;
    }
    synchronise();
    uint entries = min(surface_entries, uint(most_entries));
    for (uint i = gl_LocalInvocationID.x; i < entries; i += SURFACE_LOCAL) {
        list_edges(entry_at(i));
    }
    find_listed(OF_EDGES);
    for (uint i = gl_LocalInvocationID.x; i < entries; i += SURFACE_LOCAL) {
        list_faces(entry_at(i));
    }
    find_listed(OF_FACES);
#if HAS_PRESSURE
    for (uint i = gl_LocalInvocationID.x; i < entries; i += SURFACE_LOCAL) {
        list_pressed(entry_at(i));
    }
    find_listed(OF_PRESSURE);
#endif
    for (EACH_NEAR(i)) {
        int index = node_at(i);
        if (surface_nodes[index].is_held == 1) {
            surface_nodes[atomicAdd(held_nodes, 1u)].held = ivec2(i, index);
            list_rows_of(index);
        }
    }
    synchronise();
}

// The impulse of a row by one collider, and of that what is along its normal [m/s].
vec4 given_by(uint slot, int collider) {
    SurfaceRow found = surface_rows[slot].row;
    vec3 normal = found.normal.xyz;
    bool is_own = int(found.weights.w) == collider;
#if COLLIDERS > 1
    vec4 facing = surface_rows[slot].facing;
    if (facing_of(found) == collider) {
        return vec4(facing.xyz - facing.w * normal, -facing.w);
    }
    vec3 impulse = found.impulse.xyz - facing.xyz + facing.w * normal;
#else
    vec3 impulse = found.impulse.xyz;
#endif
    return is_own ? vec4(impulse, dot(impulse, normal)) : vec4(0.0);
}

// Impulses of the rows of a node on one collider [m/s], and FREE, STICKS or SLIDES.
vec4 gathered_of(int index, int collider) {
    vec4 sum = vec4(0.0);
    int first = surface_nodes[index].first_row;
    int end = first + surface_nodes[index].row_count;
    for (int i = first; i < end; ++i) {
        uvec2 row = surface_rows[i / 3].of_node[i % 3];
        vec4 given = given_by(row.x, collider);
        if (given.xyz == vec3(0.0)) {
            continue;
        }
        float friction = length(given.xyz - given.w * surface_rows[row.x].row.normal.xyz);
        bool slides = friction >= 0.99999 * collider_friction[collider] * abs(given.w);
        sum = vec4(sum.xyz + uintBitsToFloat(row.y) * given.xyz,
            max(sum.w, float(slides ? SLIDES : STICKS)));
    }
    return sum;
}

#if WAYS_OUT || !FINDS_IMPULSES
// Part of a collider in the room that it and another one lack at x [m].
float lacking_room(int collider, vec4 near, vec3 x) {
    float lacking = 0.0;
    for (int other = 0; other < COLLIDERS; ++other) {
        vec4 facing = gap_at_end(other, x, substep);
        float room = near.w + facing.w;
        if (other != collider && are_facing(collider, other, near.xyz, facing.xyz, room)) {
            lacking = max(lacking, -0.5 * room);
        }
    }
    return lacking;
}

// Gap of a collider at x as the substep ends, with its part of the room that another one lacks [m].
vec4 gap_with_room(int collider, vec3 x) {
    vec4 near = gap_at_end(collider, x, substep);
    return near + vec4(0.0, 0.0, 0.0, lacking_room(collider, near, x));
}

#if WAYS_OUT
// Where a node at x is when it goes to a place, but no deeper into colliders than it is: moved_out
// lets it leave a deep place slowly.
vec3 no_deeper(uint bodies, vec3 x, vec3 to) {
    for (; bodies != 0u; bodies &= bodies - 1u) {
        int collider = first_of(bodies);
        vec4 near = gap_with_room(collider, to);
        float least = -rounding(to, collider);
        // llvmpipe runs a branch for all nodes, but skips a loop without rounds.
        for (uint asks = near.w < least ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
            least = min(gap_with_room(collider, x).w, least);
            to += max(least - near.w, 0.0) * near.xyz;
        }
    }
    return to;
}
#else
// Where a node at x is when the colliders have moved it out, as the substep ends.
vec3 out_of(uint bodies, vec3 x) {
    for (; bodies != 0u; bodies &= bodies - 1u) {
        int collider = first_of(bodies);
        vec4 near = gap_with_room(collider, x);
        x += max(-near.w - rounding(x, collider), 0.0) * near.xyz;
    }
    return x;
}
#endif
#endif

#if WAYS_OUT
void main() {
    is_at_end = true;
    bool has_entries = surface_entries > 0u;
    for (int search = 0; has_entries && search < WAY_SEARCHES; ++search) {
        for (EACH_NEAR(i)) {
            int index = node_at(i);
            surface_nodes[index].free = vec3(0.0);
            surface_nodes[index].is_held = 0;
        }
        synchronise();
        find_all_rows();
        bool is_done = acting_rows == 0u;
        has_entries = !is_done;
        for (int round = 0; !is_done && round < WAY_ROUNDS; ++round) {
            is_done = rows_act();
            for (EACH_HELD(i)) {
                int index = held_node(i);
                vec3 x = position_out[index].xyz;
                vec3 to = x + inverse_mass(index) * gathered(index);
                uint bodies = near[uint(block_count) + held_place(i)].bodies;
                surface_nodes[index].free = inverse_mass(index) > 0.0
                    ? no_deeper(bodies, x, to) - x : vec3(0.0);
            }
            synchronise();
        }
        for (EACH_HELD(i)) {
            int index = held_node(i);
            // As in moved_out: to leave a deep place at once would stretch edges.
            vec3 way = surface_nodes[index].free;
            float part = substep * out_speed / max(length(way), 1e-30);
            position_out[index].xyz += min(part, 1.0) * way;
        }
        synchronise();
    }
    for (EACH_NEAR(i)) {
        surface_nodes[node_at(i)].is_listed = 0;
    }
}
#else
#if HAS_SELF
#define NO_IMPULSES , vec4(0.0)
#else
#define NO_IMPULSES
#endif

void list_entries() {
    if (gl_LocalInvocationID.x == 0u) {
        surface_entries = 0u;
        ++kept_time;
    }
    for (EACH_NEAR(i)) {
        int index = node_at(i);
        surface_nodes[index] = SurfaceNode(
            velocity_out[index].xyz, 1, 0, 0, 0, 0.0, 0, 0, ivec2(0) NO_IMPULSES);
    }
    synchronise();
    for (EACH_NEAR(i)) {
        int index = node_at(i);
        uint bodies = colliders_near_cell(index, near[uint(block_count) + i].bodies);
        uint count = uint(bitCount(bodies));
        uint first = count > 0u ? atomicAdd(surface_entries, count) : 0u;
        bool is_room = first + count <= uint(most_entries);
        if (!is_room) {
            atomicAdd(surface_lost, 1u);
        }
        surface_nodes[index].first = int(first);
        surface_nodes[index].bodies = is_room ? int(bodies) : 0;
        for (uint rest = is_room ? bodies : 0u; rest != 0u; rest &= rest - 1u) {
            surface_rows[first++ * uint(SURFACE_ROWS_OF_BODY)].entry =
                uvec2(index, findLSB(rest));
        }
    }
    synchronise();
}

#if FINDS_IMPULSES
// The velocities of held nodes by the impulses that there are.
void move_held_nodes() {
    for (EACH_HELD(i)) {
        int index = held_node(i);
#if HAS_SELF
        surface_nodes[index].by_rows.xyz = gathered(index);
#endif
        if (inverse_mass(index) > 0.0) {
            vec3 x = load_position(index).xyz;
            vec3 v = surface_nodes[index].free + inverse_mass(index) * ALL_IMPULSES(index);
            velocity_out[index].xyz = contact_with(
                near[uint(block_count) + held_place(i)].bodies, x, v, v, substep).velocity;
        }
    }
    synchronise();
}

void let_rows_act() {
    bool is_done = surface_entries == 0u || acting_rows == 0u;
    for (int round = 0; !is_done && round <= IMPULSE_ROUNDS; ++round) {
        // Nodes move by the impulses that were kept, before rows see them.
        if (round > 0) {
            is_done = rows_act();
        }
        move_held_nodes();
    }
    bool is_far = uintBitsToFloat(largest_change)
        > UNSETTLED * uintBitsToFloat(max(largest, largest_pressed));
    if (!is_done && is_far && acting_rows > 0u && gl_LocalInvocationID.x == 0u) {
        ++surface_unsettled;
    }
}

// Write the state to come of held nodes, and what was done to colliders.
void give() {
    keep_impulses();
    for (uint i = gl_LocalInvocationID.x; i < held_nodes; i += SURFACE_LOCAL) {
        int index = held_node(i);
        vec3 x = load_position(index).xyz;
#if HAS_SELF
        bool is_given = inverse_mass(index) > 0.0 && !has_layers(index);
#else
        bool is_given = inverse_mass(index) > 0.0;
#endif
        if (is_given) {
            vec3 v = surface_nodes[index].free + inverse_mass(index) * ALL_IMPULSES(index);
            Contact contact = contact_with(
                near[uint(block_count) + held_place(i)].bodies, x, v, v, substep);
#if HAS_LOW_PARTS
            vec3 to = changed_position(
                index, position_out[index].xyz,
                substep * (contact.velocity - surface_nodes[index].free));
#else
            vec3 to = x + substep * contact.velocity;
#endif
#if NOTES_CHANGES
            changes[index].xyz += contact.velocity - surface_nodes[index].free;
#endif
            velocity_out[index].xyz = contact.velocity;
            position_out[index].xyz = touched_count > 0 ? moved_out(to, substep) : to;
            if (touched_count > 0) {
                record_contacts(index, contact.kind);
            }
        }
        for (int collider = 0; collider < COLLIDERS; ++collider) {
            vec4 by_rows = gathered_of(index, collider);
            if (by_rows.w > 0.0) {
                int entry = collider * record_stride + index;
                contacts[entry] = vec4(
                    contacts[entry].xyz + by_rows.xyz, max(contacts[entry].w, by_rows.w));
            }
        }
    }
}
#endif

void main() {
    is_at_end = false;
#if !FINDS_IMPULSES
    list_entries();
    for (EACH_NEAR(i)) {
        int index = node_at(i);
        vec3 x = position_out[index].xyz;
        vec3 way = out_of(near[uint(block_count) + i].bodies & SURFACE_COLLIDERS, x) - x;
        float most = substep * way_out_speed / max(length(way), 1e-30);
        position_out[index].xyz = inverse_mass(index) > 0.0 ? x + min(most, 1.0) * way : x;
    }
#else
#if HAS_SELF
    if (has_part(LISTS)) {
        list_entries();
        find_all_rows();
    }
    if (has_part(ACTS)) {
        let_rows_act();
    }
    if (has_part(GIVES)) {
        give();
    }
#else
    list_entries();
    bool has_entries = surface_entries > 0u;
    if (has_entries) {
        find_all_rows();
        let_rows_act();
        give();
    }
#endif
#endif
}
#endif
