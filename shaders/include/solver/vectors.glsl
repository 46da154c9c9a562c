// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Access to the vectors of all levels.

layout(std430, binding = SOLVER_VECTORS) buffer Vectors { vec4 vectors[]; };

#if LOADS_TEXTURE
layout(binding = SOLVER_VECTORS) uniform samplerBuffer vectors_in;

vec3 load_vector(int entry) { return texelFetch(vectors_in, entry).xyz; }
#else
vec3 load_vector(int entry) { return vectors[entry].xyz; }
#endif

void store_vector(int entry, vec3 value) { vectors[entry].xyz = value; }

#if HAS_CONTACT
// A fourth vector of a node whose contacts are counted, in what three fields have no use for: how
// much momentum over the node mass solves have left to later ones, less what earlier ones had left
// to them.
void store_left_over(int index, vec3 value) {
    vectors[cloth_entry(BEGIN_POSITION, index)].w = value.x;
    vectors[cloth_entry(BEGIN_VELOCITY, index)].w = value.y;
    vectors[cloth_entry(GIVEN, index)].w = value.z;
}

vec3 load_left_over(int index) {
    return vec3(
        vectors[cloth_entry(BEGIN_POSITION, index)].w,
        vectors[cloth_entry(BEGIN_VELOCITY, index)].w, vectors[cloth_entry(GIVEN, index)].w);
}
#endif
