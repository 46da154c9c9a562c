// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Look at the state: one point record a node, and sums of energies for each invocation, which
// looks at STRIP nodes of a column. Summing across invocations is left to the reader: it would
// need barriers, which cost llvmpipe more than all the rest.
// RECORDS_WANTED: 0 leaves the records out.

#include "lattice.glsl"
#include "state_in.glsl"
#include "solver/edge_law.glsl"
#include "applied_acceleration.glsl"
#include "bounded.glsl"
#if HAS_RIGIDITY
#include "bending.glsl"

uniform float bending[2];  // [N/m] along a row, along a column
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform int first_row;         // of the slab of rows this dispatch looks at
uniform int slab_rows;
uniform int pushed_everywhere; // 1 while a push on the whole cloth acts
uniform int has_limit_marks;   // 1 while there are edges at their limit
uniform int acts_between_pins; // 1 where an edge between two pins stores energy
uniform vec3 gravity;          // [m/s2]

// The body of sensor_msgs/PointCloud2: x y z vx vy vz normal_x normal_y normal_z strain flags.
#define RECORD_WORDS 11
#define FLAG_PINNED 1u
#define FLAG_AT_LIMIT 2u
#define FLAG_PUSHED 4u
#define FLAG_GAP 32u
#if RECORDS_WANTED
layout(std430, binding = AT_LIMIT) readonly buffer AtLimit { uint at_limit[]; };
layout(std430, binding = RECORDS) writeonly buffer Records { uint records[]; };
#endif

// An invocation's kinetic, elastic and gravitational energy over the node mass, largest strain, and
// how many of its nodes are out of bounds. The kinetic energy is that of the free nodes.
#define SUMS 5
layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { float partial_sums[]; };

struct Edges {
    float energy;  // [J] half of each edge's, the other half is the other end's; and of bending
    float strain;  // largest |l / L0 - 1| of structural and shear edges
};

void look_at_edge(
        inout Edges edges, vec4 from, bool needs_free_end, int row, int col, int drow, int dcol,
        bool starts, int edge, int family, int rest) {
    int other = node_index(row + drow, col + dcol);
    vec4 to = load_position(other);
    float share = starts ? edge_share(from, to, edge) : edge_share(to, from, edge);
    float l = length(to.xyz - from.xyz);
    float counts = needs_free_end && load_velocity(other).w == 0.0 ? 0.0 : share;
    edges.energy += counts * 0.5 * stored_energy(l, family, rest);
    if (family != BEND) {
        float strain = abs(l / rest_length[rest] - 1.0);
        edges.strain = max(edges.strain, share > 0.0 ? strain : 0.0);
    }
}

#if HAS_RIGIDITY
// Energy of the line of three nodes around this one, over c / 2.
float bent_square(vec4 here, int row, int col, int drow, int dcol) {
    vec4 behind = load_position(node_index(row - drow, col - dcol));
    vec4 ahead = load_position(node_index(row + drow, col + dcol));
    vec3 bent = second_difference(1.0, behind.xyz, here.xyz, ahead.xyz);
    return line_share(behind, here, ahead, drow) * dot(bent, bent);
}
#endif

#define LOOK_BOTH_WAYS(EDGES, EDGE, DROW, DCOL, FAMILY, REST) \
    look_at_edge(EDGES, from, needs_free_end, row, col, DROW, DCOL, true, EDGE, FAMILY, REST); \
    look_at_edge( \
        EDGES, from, needs_free_end, row, col, -(DROW), -(DCOL), false, EDGE, FAMILY, REST);

Edges look_at_edges(vec4 from, bool needs_free_end, int row, int col) {
    Edges edges = Edges(0.0, 0.0);
    EACH_EDGE(LOOK_BOTH_WAYS, edges)
#if HAS_RIGIDITY
    edges.energy += 0.5 * (bending[0] * bent_square(from, row, col, 0, 1)
        + bending[1] * bent_square(from, row, col, 1, 0));
#endif
    return edges;
}

// Central difference along one direction; one-sided at a border, zero where there is no neighbour.
vec3 tangent(vec4 here, int row, int col, int drow, int dcol) {
    vec4 ahead = load_position(node_index(row + drow, col + dcol));
    vec4 behind = load_position(node_index(row - drow, col - dcol));
    return mix(here.xyz, ahead.xyz, min(ahead.w, 1.0))
        - mix(here.xyz, behind.xyz, min(behind.w, 1.0));
}

// Free of its length, so that products of it neither leave float32 nor vanish.
vec3 direction_of(vec3 d) {
    float size = max(max(abs(d.x), abs(d.y)), abs(d.z));
    return size > 0.0 ? d / size : d;
}

// The upper side of a flat cloth; up for a chain, which has no sides.
vec3 surface_normal(vec4 here, int row, int col) {
    vec3 normal = cross(
        direction_of(tangent(here, row, col, 1, 0)), direction_of(tangent(here, row, col, 0, 1)));
    float square = dot(normal, normal);
    return square > 1e-12 ? normal * inversesqrt(square) : vec3(0.0, 0.0, 1.0);
}

#if RECORDS_WANTED
void write_vector(int word, vec3 v) {
    records[word] = floatBitsToUint(v.x);
    records[word + 1] = floatBitsToUint(v.y);
    records[word + 2] = floatBitsToUint(v.z);
}

// A node is at the limit when one of its 8 edges is.
bool is_at_limit(int index) {
    const uint from_left = 1u << EDGE_ROW | 1u << EDGE_CROSSING;
    const uint from_above = 1u << EDGE_COLUMN | 1u << EDGE_CROSSING;
    const uint own = 1u << EDGE_ROW | 1u << EDGE_COLUMN | 1u << EDGE_DIAGONAL;
    return ((at_limit[index] & own) | (at_limit[index - 1] & from_left)
        | (at_limit[index - PITCH] & from_above)
        | (at_limit[index - PITCH - 1] & 1u << EDGE_DIAGONAL)) != 0u;
}

void write_record(int row, int col, vec4 x, vec4 v, float strain) {
    int word = ((row - first_row) * COLS + col) * RECORD_WORDS;
#if HAS_CELLS
    if (x.w == 0.0) {
        // No node here: all values are NaN.
        for (int i = 0; i < RECORD_WORDS - 1; ++i) {
            records[word + i] = 0x7fc00000u;
        }
        records[word + RECORD_WORDS - 1] = FLAG_GAP;
        return;
    }
#endif
    uint flags = v.w == 0.0 ? FLAG_PINNED : 0u;
    bool pushed = pushed_everywhere == 1 || is_pushed_in_region(node_index(row, col));
    if (pushed && v.w != 0.0) {
        flags |= FLAG_PUSHED;
    }
#if HAS_CELLS
    // The edge across the cell is the diagonal that starts here.
    if (row < ROWS - 1 && col < COLS - 1 && edge_share(x, x, EDGE_DIAGONAL) == 0.0) {
        flags |= FLAG_GAP;
    }
#endif
    if (has_limit_marks == 1 && is_at_limit(node_index(row, col))) {
        flags |= FLAG_AT_LIMIT;
    }
    write_vector(word, x.xyz);
    write_vector(word + 3, v.xyz);
    write_vector(word + 6, surface_normal(x, row, col));
    records[word + 9] = floatBitsToUint(strain);
    records[word + 10] = flags;
}
#endif

void main() {
    int strip = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    int past = min((strip + 1) * STRIP, slab_rows) + first_row;
    if (strip * STRIP >= slab_rows || col >= COLS) {
        return;
    }
    float kinetic = 0.0;
    float elastic = 0.0;
    float gravitational = 0.0;
    float strain = 0.0;
    float out_of_bounds = 0.0;
    for (int row = first_row + strip * STRIP; row < past; ++row) {
        int index = node_index(row, col);
        vec4 x = load_position(index);
        vec4 v = load_velocity(index);
        Edges edges = look_at_edges(x, v.w == 0.0 && acts_between_pins == 0, row, col);
        float mass = mass_share(x);
        kinetic += v.w > 0.0 ? 0.5 * mass * dot(v.xyz, v.xyz) : 0.0;
        elastic += edges.energy;
        gravitational -= mass * dot(gravity, x.xyz);
        strain = max(strain, edges.strain);
        out_of_bounds += is_bounded(x.xyz) && is_bounded(v.xyz) ? 0.0 : 1.0;
#if RECORDS_WANTED
        write_record(row, col, x, v, edges.strain);
#endif
    }
    int first = (strip * COLS + col) * SUMS;
    partial_sums[first] = kinetic;
    partial_sums[first + 1] = elastic;
    partial_sums[first + 2] = gravitational;
    partial_sums[first + 3] = strain;
    partial_sums[first + 4] = out_of_bounds;
}
