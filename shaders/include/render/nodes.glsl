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

// The nodes of the cloth, two texels each: position [m] and strain, normal and flags.

layout(binding = 0) uniform samplerBuffer nodes;
uniform int cols;

int node_index(int row, int col) {
    return row * cols + col;
}

vec4 position_and_strain(int node) {
    return texelFetch(nodes, 2 * node);
}

vec4 normal_and_flags(int node) {
    return texelFetch(nodes, 2 * node + 1);
}
