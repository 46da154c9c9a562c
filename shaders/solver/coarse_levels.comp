// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The V-cycle from a level on to the coarsest and back, in one workgroup: to a GPU, a pass over so
// few nodes is nothing beside its dispatch. An invocation has the same nodes in all stages; what
// others need of it stands in shared memory, the rest in the vectors of the levels.

#define LEVEL_VARIES
#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/edge_tensors.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/restriction.glsl"

layout(local_size_x = TOGETHER_LOCAL) in;

#define COARSEST_GROUP TOGETHER_LOCAL
#include "solver/coarsest_level.glsl"

uniform int first_level;
uniform int coarsest;

// Values of the nodes of these levels, level by level.
shared vec3 of_nodes[MOST_TOGETHER];

// Where the nodes of the present level, and of that above, begin there.
int begin = 0;
int begin_above = 0;

#define FOR_NODES \
    for (int i = int(gl_LocalInvocationIndex), cols = level_shape[level].y, \
            nodes = level_shape[level].x * cols; i < nodes; i += TOGETHER_LOCAL)
// Row and column of node i of the current level, and the place of a field of it.
#define AT ivec2(i / cols, i % cols)
#define ENTRY(FIELD) vector_entry(level, FIELD, level_index(level, i / cols, i % cols))

// What an invocation has stored itself.
vec3 own(int entry) { return vectors[entry].xyz; }

// Values of other nodes of the level: at its edge, beyond which edges weigh nothing, the node's own.
vec3 shared_value(ivec2 at) {
    ivec2 last = level_shape[level].xy - 1;
    ivec2 within = clamp(at, ivec2(0), last);
    return of_nodes[begin + within.x * level_shape[level].y + within.y];
}

// The matrix of the level times the shared values, in the order of level_product.glsl.
vec3 product(ivec2 at) {
    int index = level_index(level, at.x, at.y);
    vec3 here = shared_value(at);
    vec3 sum = times(load_symmetric(level, GROUND, index), here);
    for (int i = 0; i < DIRECTIONS; ++i) {
        ivec2 from = at - TOWARDS[i];
        sum -= times(
            load_edge(level, level_index(level, from.x, from.y), i), shared_value(from) - here);
        sum += times(load_edge(level, index, i), here - shared_value(at + TOWARDS[i]));
    }
    return sum;
}

// Share the values of a field.
void share(int field) {
    barrier();
    FOR_NODES {
        of_nodes[begin + i] = own(ENTRY(field));
    }
    barrier();
}

void smooth_values(int into, float step_size) {
    FOR_NODES {
        vec3 left = own(ENTRY(RESIDUAL)) - product(AT);
        vec3 smoothed = of_nodes[begin + i]
            + step_size * times_inverse(level, level_index(level, i / cols, i % cols), left);
        store_vector(ENTRY(into), smoothed);
    }
}

// Defect of a node of the level above after smoothing; 0 outside that level.
vec3 finer_defect(ivec2 at) {
    ivec2 shape = level_shape[level - 1].xy;
    if (level == first_level) {
        at = min(at, shape);
        return load_vector(vector_entry(level - 1, DEFECT, level_index(level - 1, at.x, at.y)));
    }
    bool is_there = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, shape));
    return is_there ? of_nodes[begin_above + at.x * shape.y + at.y] : vec3(0.0);
}

vec3 restricted(ivec2 at) {
    vec4 across = shares(at.y, level_shape[level].y);
    vec4 down = shares(at.x, level_shape[level].x);
    vec3 lines[4];
    for (int row = 0; row < 4; ++row) {
        ivec2 first = 2 * at - 1 + ivec2(row, 0);
        lines[row] = across[0] * finer_defect(first) + across[1] * finer_defect(first + ivec2(0, 1))
            + across[2] * finer_defect(first + ivec2(0, 2))
            + across[3] * finer_defect(first + ivec2(0, 3));
    }
    return down[0] * lines[0] + down[1] * lines[1] + down[2] * lines[2] + down[3] * lines[3];
}

// What the level below adds, as in correction.glsl; its values begin at begin_below.
vec3 correction_of(ivec2 at, int begin_below) {
    ivec2 shape = level_shape[level + 1].xy;
    ivec2 near = at / 2;
    ivec2 far = clamp(near + 2 * (at % 2) - 1, ivec2(0), shape - 1);
    near = min(near, shape - 1);
    vec3 of_near = 0.75 * of_nodes[begin_below + near.x * shape.y + near.y]
        + 0.25 * of_nodes[begin_below + near.x * shape.y + far.y];
    vec3 of_far = 0.75 * of_nodes[begin_below + far.x * shape.y + near.y]
        + 0.25 * of_nodes[begin_below + far.x * shape.y + far.y];
    return 0.75 * of_near + 0.25 * of_far;
}

int node_count() { return level_shape[level].x * level_shape[level].y; }

void go_down() {
    for (level = first_level; level < coarsest; ++level) {
        FOR_NODES {
            vec3 residual = restricted(AT);
            store_vector(ENTRY(RESIDUAL), residual);
            of_nodes[begin + i] = first_step
                * times_inverse(level, level_index(level, i / cols, i % cols), residual);
        }
        barrier();
        smooth_values(SMOOTHED_TWICE, second_step);
        share(SMOOTHED_TWICE);
        FOR_NODES {
            store_vector(ENTRY(DEFECT), own(ENTRY(RESIDUAL)) - product(AT));
        }
        share(DEFECT);
        begin_above = begin;
        begin += node_count();
    }
}

void solve_coarsest() {
    level = coarsest;
    int i = int(gl_LocalInvocationIndex);
    int cols = level_shape[level].y;
    bool is_node = i < node_count();
    ivec2 at = is_node ? AT : ivec2(0);
    vec3 value = nearly_solve(at, is_node, is_node ? restricted(at) : vec3(0.0));
    if (is_node) {
        store_vector(ENTRY(PRECONDITIONED), value);
        of_nodes[begin + i] = value;
    }
    barrier();
}

void go_up() {
    for (level = coarsest - 1; level >= first_level; --level) {
        int begin_below = begin;
        begin -= node_count();
        FOR_NODES {
            of_nodes[begin + i] = own(ENTRY(SMOOTHED_TWICE)) + correction_of(AT, begin_below);
        }
        barrier();
        smooth_values(CORRECTED, second_step);
        share(CORRECTED);
        smooth_values(PRECONDITIONED, first_step);
        if (level > first_level) {
            share(PRECONDITIONED);
        }
    }
}

void main() {
    go_down();
    solve_coarsest();
    go_up();
}
