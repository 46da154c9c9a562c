// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Which node a vertex is: of a strip of triangles between two rows, or of six corners a cell.

#ifdef HAS_GAPS
// Row and column of the node.
ivec2 lattice_corner() {
    // In the order of a strip, rows and columns from the upper left corner of the cell.
    const ivec2 corners[6] =
        ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
    return ivec2(gl_InstanceID, gl_VertexID / 6) + corners[gl_VertexID % 6];
}

bool is_corner_missing() { return is_gap(gl_InstanceID, gl_VertexID / 6); }
#else
ivec2 lattice_corner() { return ivec2(gl_InstanceID + (gl_VertexID & 1), gl_VertexID >> 1); }

bool is_corner_missing() { return false; }
#endif
