// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Where a point is seen. Points are relative to the middle of the view [m].

uniform mat4 view_matrix;
uniform vec3 towards_camera;  // unit length
uniform vec2 half_size;       // of the picture [pixel]

vec4 seen(vec3 point) {
    return view_matrix * vec4(point, 1.0);
}

// As seen, but in front of all that is nearer than this by less than `lead` [m].
vec4 seen_in_front(vec3 point, float lead) {
    vec4 there = seen(point);
    vec4 nearer = seen(point + lead * towards_camera);
    return vec4(there.xy, nearer.z / nearer.w * there.w, there.w);
}
