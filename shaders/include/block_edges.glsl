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

// Every edge of one direction with an end in the block: EDGE is evaluated with row and col of its
// first end in the tile. TILE is the block with REACH nodes on each side.

#define FOR_BLOCK_EDGES(DROW, DCOL, EDGE) \
    for (int row = 0; row < TILE; ++row) { \
        for (int col = 0; col < TILE; ++col) { \
            bool starts = row >= REACH && row < REACH + BLOCK \
                && col >= REACH && col < REACH + BLOCK; \
            bool ends = row + DROW >= REACH && row + DROW < REACH + BLOCK \
                && col + DCOL >= REACH && col + DCOL < REACH + BLOCK; \
            if (starts || ends) { \
                EDGE; \
            } \
        } \
    }

#define FOR_TILE \
    for (int row = 0; row < TILE; ++row) \
        for (int col = 0; col < TILE; ++col)

#define FOR_BLOCK \
    for (int row = REACH; row < REACH + BLOCK; ++row) \
        for (int col = REACH; col < REACH + BLOCK; ++col)
