// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What pinned nodes are driven with, substep by substep: the impulse on what holds each, over the
// mass that masses are over (cells.glsl). fold_held.comp adds the entries up.
// The buffer begins with the slot of each stored node, one more than where a pinned node has its
// entry among those of a substep.

#ifndef HELD_BINDING
#define HELD_BINDING HELD
#endif

layout(std430, binding = HELD_BINDING) buffer Held { vec4 held[]; };

uniform int held_at;  // where the entries of the substep begin; -1: nowhere, in shaders that ask

int held_entry(int index) { return held_at + int(held[index >> 2][index & 3]) - 1; }

bool is_held_by_pin(vec4 position, vec4 velocity) {
    return position.w > 0.0 && velocity.w == 0.0;
}
