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

// How much an edge weighs in the matrix, over the node mass.

uniform float edge_weights[3];    // structural, shear, bend
uniform float pinned_weights[3];  // of an edge to a pinned node, over one between two free ones

#define STRUCTURAL 0
#define SHEAR 1
#define BEND 2

// What a node is stands in w: 0 for a ghost, 1 for a free node, -1 for a pinned one.
bool is_free(vec4 node) { return node.w > 0.0; }

// 1 between two free nodes, 0 where none can move.
float edge_share(vec4 from, vec4 to, int family) {
    return max(from.w, 0.0) * max(to.w, 0.0)
        + pinned_weights[family] * max(-from.w * to.w, 0.0);
}

float edge_weight(vec4 from, vec4 to, int family) {
    return edge_weights[family] * edge_share(from, to, family);
}

// The weight over the square of the length of d = x_i - x_j.
float weight_over_square(vec4 from, vec4 to, vec3 d, int family) {
    return edge_weight(from, to, family) / max(dot(d, d), 1e-20);
}
