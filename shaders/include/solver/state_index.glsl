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

// The state as the solver sees it. Its rows are stored STATE_PITCH apart.

uniform float pinned_weight;  // what an edge to a pinned node weighs, over one between free ones

// A tile may reach past what the state stores; there is nothing.
bool is_stored(int row, int col) {
    return row < ROWS + HALO && col < COLS + HALO;
}

int state_index(int row, int col) {
    return (row + HALO) * STATE_PITCH + col + HALO;
}

vec4 state_node(int row, int col) {
    if (!is_stored(row, col)) {
        return vec4(0.0);
    }
    int index = state_index(row, col);
    vec4 position = load_position(index);
    float weight = load_velocity(index).w > 0.0 ? 1.0 : -pinned_weight;
    return vec4(position.xyz, position.w * weight);
}
