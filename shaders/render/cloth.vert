// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The surface: one strip of triangles between two rows of nodes, two vertices a column. HAS_GAPS:
// two triangles, six vertices, a cell; those of cells that there are not are points nowhere.

#include "render/view.glsl"
#include "render/nodes.glsl"

#ifdef SHADOW
uniform float floor_z;
uniform int rows;
uniform int stride;  // between the nodes that are drawn: an outline needs fewer than the surface
#else
out vec3 normal;
out float strain;
out vec2 place;  // column and row
#ifdef DAYLIGHT
out vec3 point;
#endif
#endif

void main() {
#ifdef HAS_GAPS
    // Rows and columns from the upper left corner of the cell, in the order of a strip.
    const ivec2 corners[6] =
        ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
    ivec2 corner = corners[gl_VertexID % 6];
    int row = gl_InstanceID;
    int col = gl_VertexID / 6;
#ifdef SHADOW
    bool is_missing = is_gap(row * stride, col * stride);
#else
    bool is_missing = is_gap(row, col);
#endif
    row += corner.x;
    col += corner.y;
#else
    int row = gl_InstanceID + (gl_VertexID & 1);
    int col = gl_VertexID >> 1;
#endif
#ifdef SHADOW
    row = min(row * stride, rows - 1);
    col = min(col * stride, cols - 1);
#endif
    int node = node_index(row, col);
    vec4 found = position_and_strain(node);
#ifdef SHADOW
    // Shadow of a lamp straight above.
    gl_Position = seen(vec3(found.xy, floor_z));
#else
    normal = normal_and_flags(node).xyz;
    strain = found.w;
    place = vec2(col, row);
#ifdef DAYLIGHT
    point = found.xyz;
#endif
    gl_Position = seen(found.xyz);
#endif
#ifdef HAS_GAPS
    if (is_missing) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
#endif
}
