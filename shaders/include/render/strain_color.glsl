// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The colour of a strain: PALETTE_SIZE even steps from 0 to full_strain.

layout(binding = 1) uniform samplerBuffer palette;
uniform float full_strain;
uniform vec3 plain_color;  // where the strain is not known, which is said by one below 0

vec3 strain_color(float strain) {
    int place = int(float(PALETTE_SIZE) * strain / full_strain);
    vec3 color = texelFetch(palette, clamp(place, 0, PALETTE_SIZE - 1)).rgb;
    return strain < 0.0 ? plain_color : color;
}
