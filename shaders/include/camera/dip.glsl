// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Cloth that is inside of a body by no more than the dip is seen in front of it.

uniform float dip;  // how deep faces of the cloth may be inside of the body [m]

// The place of the ray, which is `inside` of a body, from where on the body hides the cloth.
float hiding_from(vec3 from, vec3 way, vec2 inside) {
    vec2 core = WITHIN(from, way, dip);
    // A ray that misses all of the core is nowhere deeper.
    return core.x < core.y ? core.x : inside.y;
}
