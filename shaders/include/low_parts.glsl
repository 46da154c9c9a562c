// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Sums of positions and velocities. With HAS_LOW_PARTS they are compensated (Kahan): the rounding
// error of a sum is stored, and added with the next change. See docs/explanation/numerics.md.

// LOW_PARTS_TEXTURE 1: a pass that changes each of them once reads them through a texture unit, which
// software devices do several times faster.

#if HAS_LOW_PARTS
layout(std430, binding = LOW_PARTS) buffer LowParts { float low_parts[]; };
#if LOW_PARTS_TEXTURE
layout(binding = LOW_PARTS) uniform samplerBuffer low_part_texels;
#endif

// precise: a compiler that cancels terms would find that nothing was rounded off.
vec3 compensated_sum(int texel, vec3 value, vec3 change) {
    int entry = 4 * texel;
#if LOW_PARTS_TEXTURE
    vec3 low = texelFetch(low_part_texels, texel).xyz;
#else
    vec3 low = vec3(low_parts[entry], low_parts[entry + 1], low_parts[entry + 2]);
#endif
    precise vec3 part = change + low;
    precise vec3 sum = value + part;
    precise vec3 added = sum - value;
    precise vec3 left = part - added;
    low_parts[entry] = left.x;
    low_parts[entry + 1] = left.y;
    low_parts[entry + 2] = left.z;
    return sum;
}

// The position [m] or velocity [m/s] of the stored node ``index`` after a change.
vec3 changed_position(int index, vec3 position, vec3 change) {
    return compensated_sum(2 * index, position, change);
}

vec3 changed_velocity(int index, vec3 velocity, vec3 change) {
    return compensated_sum(2 * index + 1, velocity, change);
}
#else
vec3 changed_position(int index, vec3 position, vec3 change) { return position + change; }

vec3 changed_velocity(int index, vec3 velocity, vec3 change) { return velocity + change; }
#endif
