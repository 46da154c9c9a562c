// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Impulses of the edges at their limits over the mass of a node [m/s], those of a node one after
// another. They act on the node at which an edge starts, and against the one at which it ends.

layout(std430, binding = LIMIT_IMPULSES) buffer Impulses { float impulses[]; };

vec3 impulse(int index, int edge) {
    int at = 12 * index + 3 * edge;
    return vec3(impulses[at], impulses[at + 1], impulses[at + 2]);
}

void set_impulse(int index, int edge, vec3 value) {
    int at = 12 * index + 3 * edge;
    impulses[at] = value.x;
    impulses[at + 1] = value.y;
    impulses[at + 2] = value.z;
}

// Sum of those on a node.
vec3 impulse_on(int index) {
    return impulse(index, 0) - impulse(START(index, 0), 0)
        + impulse(index, 1) - impulse(START(index, 1), 1)
        + impulse(index, 2) - impulse(START(index, 2), 2)
        + impulse(index, 3) - impulse(START(index, 3), 3);
}
