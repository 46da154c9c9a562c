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

// The tension of each edge [N], four edges a cell; above 0 it pulls its ends together.

#include "edges.glsl"

#if LOADS_TEXTURE
layout(binding = TENSION) uniform samplerBuffer tension_in;
vec4 load_tensions(int index) { return texelFetch(tension_in, index); }
#else
layout(std430, binding = TENSION) readonly buffer TensionIn { vec4 tension_in[]; };
vec4 load_tensions(int index) { return tension_in[index]; }
#endif

// Of the edge from the node at index to the one (drow, dcol) away, as springs are named.
float load_tension(int index, int drow, int dcol) {
    if (drow == 0) {
        return load_tensions(index)[EDGE_ROW];
    }
    if (dcol == 0) {
        return load_tensions(index)[EDGE_COLUMN];
    }
    return dcol > 0
        ? load_tensions(index)[EDGE_DIAGONAL] : load_tensions(index - 1)[EDGE_CROSSING];
}
