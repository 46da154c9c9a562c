// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Access to the vectors of all levels.

layout(std430, binding = SOLVER_VECTORS) buffer Vectors { vec4 vectors[]; };

#if LOADS_TEXTURE
layout(binding = SOLVER_VECTORS) uniform samplerBuffer vectors_in;

vec4 load_entry(int entry) { return texelFetch(vectors_in, entry); }
#else
vec4 load_entry(int entry) { return vectors[entry]; }
#endif

vec3 load_vector(int entry) { return load_entry(entry).xyz; }

void store_vector(int entry, vec3 value) { vectors[entry].xyz = value; }
