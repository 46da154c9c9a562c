// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// What contacts with thin colliders add to a pass over the cloth: their part of the matrix times a
// vector, at the nodes that they act on. One workgroup.

// Kinds of a field that it is added to.
#define TO_RESIDUAL 0    // of an initial solution, and its first smoothing
#define TO_SMOOTHED 1
#define TO_DEFECT 2
#define TO_PRODUCT 3     // and its part in the scalar product of both

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/free_directions.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/surface_contacts.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

layout(std430, binding = SOLVER_SUMS) writeonly buffer PartialSums { vec4 partial_sums[]; };

uniform int field;       // of the vector
uniform int into_field;
uniform int into;        // the kind of that field
uniform bool goes_up;    // of a smoothing: which of the two steps it is
uniform int sum_at;      // of the scalar product

vec3 load(int index) { return load_vector(cloth_entry(field, index)); }

vec3 resisted(int index) {
    vec3 sum = vec3(0.0);
    SurfaceHold node = surface_holds[index];
    for (int i = node.first; i < node.first + node.count; ++i) {
        int place = contact_of_node(i);
        SurfaceContact contact = surface_contacts[place];
        ivec3 nodes = nodes_of(place);
        vec3 u = contact.weights.x * load(nodes.x) + contact.weights.y * load(nodes.y);
        if (contact.weights.z > 0.0) {
            u += contact.weights.z * load(nodes.z);
        }
        sum += weight_of_node(i, contact) * resistance(contact, u);
    }
    return sum;
}

void change(int entry, vec3 by) { store_vector(entry, load_vector(entry) + by); }

shared float sums[SURFACE_LOCAL];

void main() {
    uint lane = gl_LocalInvocationID.x;
    float product = 0.0;
    for (uint i = lane; i < held_nodes; i += SURFACE_LOCAL) {
        int index = int(surface_lists[uint(HELD_AT) + i]);
        if (!(load_system(cloth_entry(NODE, index)).w > 0.0)) {
            continue;
        }
        vec3 found = in_free_directions(index, resisted(index));
        if (into == TO_SMOOTHED) {
            change(cloth_entry(into_field, index),
                (goes_up ? -first_step : -second_step) * times(load_cloth_inverse(index), found));
        } else if (into == TO_RESIDUAL) {
            vec3 residual = load_vector(cloth_entry(RESIDUAL, index)) - found;
            store_vector(cloth_entry(RESIDUAL, index), residual);
            store_vector(cloth_entry(SMOOTHED_INTO, index),
                first_step * times(load_cloth_inverse(index), residual));
        } else if (into == TO_DEFECT) {
            change(cloth_entry(into_field, index), -found);
        } else {
            change(cloth_entry(into_field, index), found);
        }
        product += dot(found, load(index));
    }
    sums[lane] = product;
    barrier();
    if (lane == 0u && into == TO_PRODUCT) {
        float sum = 0.0;
        for (int i = 0; i < SURFACE_LOCAL; ++i) {
            sum += sums[i];
        }
        partial_sums[sum_at] = vec4(0.0, sum, 0.0, 0.0);
    }
}
