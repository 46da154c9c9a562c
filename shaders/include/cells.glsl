// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What nodes, edges and lines of bending stand for. HAS_CELLS 0: nodes of equal mass, and whole
// lines, as in the paper; w of a position is 1, or 0 for a ghost. HAS_CELLS 1: what the cells around
// them give (sim/model/cells.py); w of a position has these parts as bits, 0 for a ghost. Masses
// are over that of a cell.

#ifndef HAS_CELLS
#error HAS_CELLS is not defined
#endif
#if HAS_CELLS
#define LINES_AT 12
#define QUARTERS_AT 16

float part_of(vec4 node, int first, int most) {
    return float((int(abs(node.w)) >> first) & most);
}

float mass_share(vec4 node) { return 0.25 * part_of(node, QUARTERS_AT, 7); }

// Share of a whole line that the edge has which starts at the node from; 0 for no edge.
float edge_share(vec4 from, vec4 to, int edge) { return 0.5 * part_of(from, 2 * edge, 3); }

// Share of a whole line that three nodes along a row (0) or a column (1) have; 0 for none.
float line_share(vec4 behind, vec4 here, vec4 ahead, int direction) {
    return 0.5 * part_of(here, LINES_AT + 2 * direction, 3);
}
#else
float mass_share(vec4 node) { return 1.0; }

float edge_share(vec4 from, vec4 to, int edge) { return from.w * to.w; }

float line_share(vec4 behind, vec4 here, vec4 ahead, int direction) {
    return abs(behind.w * here.w * ahead.w);
}
#endif
