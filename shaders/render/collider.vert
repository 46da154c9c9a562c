// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A surface of one colour: one strip of triangles between two rows of points.

#include "render/view.glsl"
#include "render/nodes.glsl"

uniform float behind;  // where it is as near as cloth, cloth is seen [m]
out vec3 normal;
#ifdef DAYLIGHT
out vec3 point;
#endif

void main() {
    int node = node_index(gl_InstanceID + (gl_VertexID & 1), gl_VertexID >> 1);
    normal = normal_and_flags(node).xyz;
    vec3 there = position_and_strain(node).xyz;
#ifdef DAYLIGHT
    point = there;
#endif
    gl_Position = seen_in_front(there, -behind);
}
