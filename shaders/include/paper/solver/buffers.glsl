// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The buffers of the paper's solver, its Tab. 3. CONSTRAINTS: edges between nodes of which one at
// least is free. Every row of J has six values, so that the row pointers IA and JB need not be
// stored, and the columns of J^T are the rows of J: A and JA are B and IB as well.
// COO keeps ROW_SLOTS entries for a row.

#define VALUES 6  // of a row of J

layout(std430, binding = PAPER_EDGES) readonly buffer Edges { vec4 edges[]; };  // ends, length
layout(std430, binding = PAPER_NODES) readonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = PAPER_VALUES) buffer Values { float a[]; };
layout(std430, binding = PAPER_COLUMNS) buffer Columns { int ja[]; };
layout(std430, binding = PAPER_MATRIX) buffer Matrix { vec4 coo[]; };  // row, column, value
layout(std430, binding = PAPER_COUNTS) buffer Counts { uint row_count[]; };
layout(std430, binding = PAPER_VECTORS) buffer Vectors { float vectors[]; };
layout(std430, binding = PAPER_SCALARS) buffer Scalars { float scalars[]; };

// Nodes: positions and inverse masses, then the velocities after the step without constraints.
float inverse_mass(int node) { return nodes[node].w; }

// Vectors, one value a constraint each.
#define LAMBDA 0
#define RESIDUAL 1
#define DIRECTION 2
#define IMAGE 3
#define ENTRY(FIELD, i) vectors[(FIELD) * CONSTRAINTS + (i)]

// Scalars; the sums of the workgroups follow.
#define SQUARE 0        // of the residual
#define SQUARE_START 1
#define STEP_LENGTH 2
#define KEEP 3
#define GROUP_SUMS 4
