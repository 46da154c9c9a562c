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

// The lattice with its halo: two ghost nodes on each side, so that no neighbour needs a branch.
// Its size is a uniform, so that a program serves every size.

#define HALO 2

uniform ivec4 lattice;  // rows and columns of nodes, entries in a stored row, entries in all

#define ROWS lattice.x
#define COLS lattice.y
#define PITCH lattice.z
#define STORED lattice.w

int node_index(int row, int col) {
    return (row + HALO) * PITCH + col + HALO;
}
