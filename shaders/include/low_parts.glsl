// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Sums of positions and velocities. With HAS_LOW_PARTS they are compensated (Kahan): the rounding
// error of a sum is stored, and added with the next change. See docs/explanation/numerics.md.
// CHANGES_LOW_PARTS_ONCE: a pass that changes each of them once may read them through a texture unit,
// like the state, which software devices do several times faster.

#ifdef CHANGES_LOW_PARTS_ONCE
#define LOW_PARTS_TEXTURE LOADS_TEXTURE
#else
#define LOW_PARTS_TEXTURE 0
#endif

#if HAS_LOW_PARTS
// Six numbers per node: three low parts of its position [m], then three of its velocity [m/s].
layout(std430, binding = LOW_PARTS) buffer LowParts { float low_parts[]; };

#if LOW_PARTS_TEXTURE
layout(binding = LOW_PARTS) uniform samplerBuffer low_part_texels;

// The six of a node are in two texels, from the first or the third number on.
vec3 low_position(int index) {
    vec4 first = texelFetch(low_part_texels, 3 * index / 2);
    vec4 second = texelFetch(low_part_texels, 3 * index / 2 + 1);
    return (index & 1) == 0 ? first.xyz : vec3(first.zw, second.x);
}

vec3 low_velocity(int index) {
    vec4 first = texelFetch(low_part_texels, 3 * index / 2);
    vec4 second = texelFetch(low_part_texels, 3 * index / 2 + 1);
    return (index & 1) == 0 ? vec3(first.w, second.xy) : second.yzw;
}
#else
vec3 low_at(int entry) {
    return vec3(low_parts[entry], low_parts[entry + 1], low_parts[entry + 2]);
}

vec3 low_position(int index) { return low_at(6 * index); }

vec3 low_velocity(int index) { return low_at(6 * index + 3); }
#endif

// precise: a compiler that cancels terms would find that nothing was rounded off.
vec3 compensated_sum(int entry, vec3 low, vec3 value, vec3 change) {
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
    return compensated_sum(6 * index, low_position(index), position, change);
}

vec3 changed_velocity(int index, vec3 velocity, vec3 change) {
    return compensated_sum(6 * index + 3, low_velocity(index), velocity, change);
}
#else
vec3 changed_position(int index, vec3 position, vec3 change) { return position + change; }

vec3 changed_velocity(int index, vec3 velocity, vec3 change) { return velocity + change; }
#endif
