// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// A contact that was found, and those that act.

layout(binding = SELF_CONTACTS) uniform samplerBuffer contact_texels;
layout(binding = SELF_ACTING) uniform samplerBuffer acting_texels;

// Software reads four texels much faster than sixteen numbers.
SelfContact load_contact(int place) {
    vec4 last = texelFetch(contact_texels, 4 * place + 3);
    return SelfContact(
        floatBitsToInt(texelFetch(contact_texels, 4 * place)),
        texelFetch(contact_texels, 4 * place + 1), texelFetch(contact_texels, 4 * place + 2),
        last.xyz, last.w);
}

// A contact that acts: impulse [m/s of a node amid the cloth], and place as bits.
vec4 load_acting(uint number) { return texelFetch(acting_texels, int(number)); }
