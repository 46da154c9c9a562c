// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The surface of a body in its own frame, two texels a point: position [m] and normal.

layout(binding = 0) uniform samplerBuffer surface;
uniform int cols;           // points of a row
uniform vec3 body_axes[3];  // in the world
uniform vec3 body_place;    // of its origin, from the eye [m]
uniform float stretch;      // of the surface: 1 for a body, half a side for a plane [m]

vec3 turned(vec3 v) {
    return v.x * body_axes[0] + v.y * body_axes[1] + v.z * body_axes[2];
}

int surface_point() {
    return (gl_InstanceID + (gl_VertexID & 1)) * cols + (gl_VertexID >> 1);
}

// Where the vertex is, from the eye [m].
vec3 surface_place() {
    return body_place + turned(stretch * texelFetch(surface, 2 * surface_point()).xyz);
}

vec3 surface_normal() {
    return turned(texelFetch(surface, 2 * surface_point() + 1).xyz);
}
