// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The tree of boxes on the lattice: each level has half as many rows and columns as the one below.

#define MOST_LEVELS 16

struct Box {
    vec4 least;
    vec4 most;
};

// Software reads two texels much faster than eight numbers.
layout(binding = SELF_BOXES) uniform samplerBuffer box_texels;

Box load_box(int place) {
    return Box(texelFetch(box_texels, 2 * place), texelFetch(box_texels, 2 * place + 1));
}

uniform ivec4 levels[MOST_LEVELS];  // rows, columns, place of the first box; the lowest level first
uniform int level_count;

Box empty_box() { return Box(vec4(1e30), vec4(-1e30)); }

void add_point(inout Box box, vec3 x) {
    box.least.xyz = min(box.least.xyz, x);
    box.most.xyz = max(box.most.xyz, x);
}

bool overlap(Box one, Box other) {
    return all(lessThanEqual(one.least.xyz, other.most.xyz))
        && all(lessThanEqual(other.least.xyz, one.most.xyz));
}

// A walk through the tree: down where boxes overlap, else on to the next of four, and up behind the
// last.
struct Walk {
    int level;  // level_count at the end
    ivec2 at;   // row and column of the box
};

bool is_box_near(Walk walk, Box own) {
    ivec4 size = levels[walk.level];
    return walk.at.x < size.x && walk.at.y < size.y
        && overlap(own, load_box(size.z + walk.at.x * size.y + walk.at.y));
}

void walk_on(inout Walk walk, bool is_near) {
    if (is_near && walk.level > 0) {
        --walk.level;
        walk.at *= 2;
    } else {
        int ups = findLSB(~(walk.at.x & walk.at.y));
        walk.level += ups;
        walk.at >>= ups;
        walk.at += (walk.at.y & 1) == 0 ? ivec2(0, 1) : ivec2(1, -1);
        walk.level = walk.level >= level_count - 1 ? level_count : walk.level;
    }
}
