// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// One level of the tree of boxes: those of what each node owns, or of four boxes of the level below.
// The lattice is the tree: no sort, and always the same order.

#define POSITIONS_ALONE 1
#include "lattice.glsl"
#include "state_in.glsl"
#include "self_contact/features.glsl"
#include "self_contact/boxes.glsl"
#include "self_contact/cell_ways.glsl"

layout(local_size_x = SELF_LOCAL) in;

layout(std430, binding = SELF_BOXES) writeonly buffer SelfBoxes { Box boxes[]; };
layout(std430, binding = SELF_BUILT) writeonly buffer SelfBuilt { vec4 built[]; };

uniform int level;

Box box_of_node(int row, int col) {
    int index = node_index(row, col);
    Box box = empty_box();
    vec4 x = load_position(index);
    built[index] = x;
    cell_ways[index].x = 0.0;
    uint own = owned(index);
    if ((own & OWNS_NODE) == 0u) {
        return box;
    }
    add_point(box, x.xyz);
    if ((own & (OWNS_RIGHT | OWNS_CELL)) != 0u) {
        add_point(box, load_position(index + 1).xyz);
    }
    if ((own & (OWNS_DOWN | OWNS_CELL)) != 0u) {
        add_point(box, load_position(index + PITCH).xyz);
    }
    if ((own & OWNS_CELL) != 0u) {
        add_point(box, load_position(index + PITCH + 1).xyz);
    }
    return box;
}

void main() {
    ivec4 size = levels[level];
    int place = int(gl_GlobalInvocationID.x);
    if (place >= size.x * size.y) {
        return;
    }
    int row = place / size.y, col = place % size.y;
    if (level == 0) {
        boxes[place] = box_of_node(row, col);
        return;
    }
    ivec4 below = levels[level - 1];
    Box box = empty_box();
    for (int i = 0; i < 4; ++i) {
        ivec2 at = 2 * ivec2(row, col) + ivec2(i >> 1, i & 1);
        if (at.x < below.x && at.y < below.y) {
            Box part = load_box(below.z + at.x * below.y + at.y);
            box.least = min(box.least, part.least);
            box.most = max(box.most, part.most);
        }
    }
    boxes[size.z + place] = box;
}
