// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The levels of the solver in two buffers. Level 0 is the cloth; each further one has half the
// nodes along each side, rounded up. A level is stored like the cloth, with two ghosts around,
// one field after the other. All fields of a ghost are zero for good.

#include "lattice.glsl"

#define MOST_LEVELS 16

uniform ivec4 level_shape[MOST_LEVELS];  // rows, cols, entries in a stored row, entries in all
uniform ivec2 level_begin[MOST_LEVELS];  // where its vectors begin, where its system begins
uniform int level;

// Vectors, one an entry. A field serves two purposes where one is over before the other begins.
#define RESIDUAL 0
#define SMOOTHED 1        // after the first step of smoothing
#define SMOOTHED_TWICE 2  // after the second
#define DEFECT 1          // what that left of RESIDUAL
#define CORRECTED 1       // with the correction of the level below, and smoothed again
#define PRECONDITIONED 2  // smoothed a last time: the preconditioner applied to RESIDUAL
#define PRODUCT 1         // level 0: the matrix times PRECONDITIONED
#define DIRECTION 3       // level 0 only, as those that follow
#define IMAGE 4           // the matrix times DIRECTION
#define SOLUTION 5
#define CHANGE 6          // of the velocity in the whole step
#define START 7           // initial solution of a solve that continues another
#define LEFT 8            // of RESIDUAL, by the pass before
#define BEGIN_POSITION 9  // with contact, as those that follow: where the substep began
#define BEGIN_VELOCITY 10 // and with which velocity
#define REACTION 11       // change of velocity that colliders have made in the substep
#define GIVEN 12          // impulse of colliders that the next solve has to add, over the node mass
#define RIGHT 13          // the right side, also where a node can't follow it

// The system.
#define INVERSE 0  // two fields: inverse of the node's diagonal block, zero where it can't move
#define NODE 2     // level 0: position [m], and 1 where free, -1 where pinned
#define ALONG 3    // level 0: of the edges that begin here, along a row, along a column, diagonal,
                   // crossing: what they resist along, less that across, over the square length
#define ACROSS 4   // level 0: what they resist across
#define TENSION 5  // level 0: their tensions as found last [m/s2]
#define BEGUN 6    // level 0: as a solve begins with them
#define BEND_WEIGHT 7   // level 0, with bend edges: along, along, across, across
#define BEND_TENSION 8  // level 0, with bend edges: found, found, begun, begun
#define BENT_LINES (7 + 2 * HAS_BEND)  // level 0, with damped bending, two fields: of the lines of
                   // three nodes around a node along a row and along a column, the direction of
                   // their bend, times the root of what damping weighs, and their skew
#define CONTACT (7 + 2 * HAS_BEND + 2 * HAS_BENDING_DAMPING)  // level 0, with contact: normal of the
                   // surface that a node touches, and in which directions that leaves it free
#define GRIP (CONTACT + 1)  // the direction that a node slides in, where friction does not resist, if
                   // any, and what it resists across that, over the node mass
#define GROUND 2   // coarse levels, two fields: mass, and what ties the node to pinned ones
#define EDGES 4    // coarse levels, six fields: the tensors of the edges that begin here

int level_index(int which, int row, int col) {
    return (row + HALO) * level_shape[which].z + col + HALO;
}

int vector_entry(int which, int field, int index) {
    return level_begin[which].x + field * level_shape[which].w + index;
}

int system_entry(int which, int field, int index) {
    return level_begin[which].y + field * level_shape[which].w + index;
}

// On the cloth, which comes first in both buffers.
int cloth_entry(int field, int index) { return field * STORED + index; }

bool inside(int which, int row, int col) {
    return row < level_shape[which].x && col < level_shape[which].y;
}
