// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The sum of the impulses of the contacts that act on a node. Each node adds up its own: that takes
// less time on software than to let each contact add to four nodes.

#include "read_first.glsl"

layout(binding = SELF_ENTRIES) uniform samplerBuffer entry_texels;
layout(binding = SELF_ACTING) uniform samplerBuffer acting_texels;

// A power of two, so that the product is the quotient.
float units = 1.0 / READ_FIRST(impulse_unit);

ivec3 of_entry(float number, float weight) {
    vec3 impulse = texelFetch(acting_texels, floatBitsToInt(number)).xyz;
    return ivec3(round(weight * impulse * units));
}

// Sum of a number of entries from a texel on [impulse_unit].
ivec3 sum_of_entries(uint first, uint count) {
    ivec3 sum = ivec3(0);
    for (uint i = 0u; i < count; i += 2u) {
        vec4 two = texelFetch(entry_texels, int(first + i / 2u));
        sum += of_entry(two.x, two.y);
        bool has_second = i + 1u < count;
        sum += of_entry(has_second ? two.z : two.x, has_second ? two.w : 0.0);
    }
    return sum;
}
