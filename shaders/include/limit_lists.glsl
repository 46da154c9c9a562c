// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The edges that are solved for in an explicit substep. limit/look.comp marks the blocks of nodes
// with edges that may come near a limit in some substeps, limit/list.comp lists those that come
// near it in the next one. A code says which edge of a node it is, 0 to 3, and which limit: +
// SHORTEST for that of compression. A mask has a bit for each code of the edges that start at a
// node.

#define SHORTEST 4
#define CODES 8

// First the workgroups of limit/list.comp, the number of marked blocks, and how many edges have
// come to those listed before in the substep; whether each block is marked, how many listed edges
// start there, and the masks of the stored nodes; the marked blocks, in no order; then, by
// limit/solve.comp, the listed edges, as CODES * node + code, and the nodes at them.
layout(std430, binding = LIMIT_LISTS) buffer LimitLists {
    uint list_groups_x;
    uint list_groups_y;
    uint list_groups_z;
    uint marked_count;
    uint newly_listed;
    uint unused[3];
    uint lists[];
};

uniform int block_count;
int blocks = READ_FIRST(block_count);
float rests[3] = float[](
    rest_length[REST_ROW], rest_length[REST_COLUMN], rest_length[REST_DIAGONAL]);

#define COUNTS_AT blocks
#define MASKS_AT (2 * blocks)
#define MARKED_AT (MASKS_AT + STORED)
#define EDGES_AT (MARKED_AT + blocks)
#define NODES_AT (EDGES_AT + 4 * STORED)
#define WORK_AT STORED
#define BLOCKS_ACROSS ((COLS + BLOCK - 1) / BLOCK)
#define MASK(INDEX) lists[MASKS_AT + INDEX]

int end_offset(int code) {
    int edge = code & 3;
    return edge == EDGE_ROW ? 1
        : PITCH + (edge == EDGE_COLUMN ? 0 : edge == EDGE_DIAGONAL ? 1 : -1);
}

float rest_of(int code) {
    int edge = code & 3;
    return edge == EDGE_ROW ? rests[0] : edge == EDGE_COLUMN ? rests[1] : rests[2];
}

// Square of a length [m2] that differs by a strain from that at rest.
float square_at(int rest, float strain) {
    float l = max(1.0 + strain, 0.0)
        * (rest == REST_ROW ? rests[0] : rest == REST_COLUMN ? rests[1] : rests[2]);
    return l * l;
}

// Where an edge starts that ends at a node.
#define START(INDEX, EDGE) (INDEX - end_offset(EDGE))

bool is_listed(int index, int edge) { return (MASK(index) & 17u << edge) != 0u; }

// How many listed edges a node has.
float listed_at(int index) {
    uint ends = 0u;
    for (int edge = 0; edge < 4; ++edge) {
        ends += is_listed(START(index, edge), edge) ? 1u : 0u;
    }
    return float(bitCount(MASK(index))) + float(ends);
}
