// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Light on a surface. Both sides are lit alike; the back is a little darker.

uniform vec3 light;     // unit vector to the lamp
uniform vec3 halfway;   // unit vector between it and the camera

vec3 lit(vec3 color, vec3 normal, bool is_front) {
    vec3 outward = is_front ? normal : -normal;
    // Light that reaches around: what faces away from the lamp keeps its shape.
    float diffuse = pow(0.5 + 0.5 * dot(outward, light), WRAP_POWER);
    float gloss = GLOSS * pow(max(dot(outward, halfway), 0.0), GLOSS_POWER);
    float level = (AMBIENT + (1.0 - AMBIENT) * diffuse) * (is_front ? 1.0 : BACK);
    return min(color * level + gloss, 1.0);
}
