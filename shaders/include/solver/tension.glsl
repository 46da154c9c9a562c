// Copyright 2026 the cloth_sim_ros authors
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

// The tension of each edge over the node mass [m/s2], above 0 where it pulls; stored at the node
// it begins at, six edges a node. Twice: what the right side of a solve begins it with, and what
// was found with the solution, since neighbours still read the one while the other is written.
// A third time [m], for what its rest length is off by.
// HAS_LAG: a fourth time, for what damping makes of the extension before the step.
// TENSION_ACCESS: readonly, writeonly or nothing.

#define TENSION_FOUND 0
#define TENSION_BEGUN 1
#define TENSION_OFFSET 2
#define TENSION_LAG 3
#define TENSIONS_OF_A_NODE 8

uniform ivec2 solver_lattice;  // of the solver's cloth: entries in a stored row, entries in all

layout(std430, binding = SOLVER_TENSION) TENSION_ACCESS buffer Tension { float tension[]; };

// Of the edge from the node at index to the one (drow, dcol) away.
int tension_entry(int which, int index, int drow, int dcol) {
    int edge = drow == 0 ? (dcol == 1 ? 0 : 4)
        : drow == 2 ? 5
        : dcol == 0 ? 1 : dcol == 1 ? 2 : 3;
    return TENSIONS_OF_A_NODE * (which * solver_lattice.y + index) + edge;
}

// Where the solver stores the node (row, col), for passes on the lattice of the state.
int solver_index(int row, int col) {
    return (row + HALO) * solver_lattice.x + col + HALO;
}
