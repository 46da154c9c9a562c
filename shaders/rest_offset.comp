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

#version 430 core
// When hard edges become stiffer, or softer again, those that are stretched keep their tension:
// what would change it goes to an offset of their rest length; docs/numerics_implicit.md, Substeps.

#include "lattice.glsl"
#include "state_in.glsl"

#define TENSION_ACCESS
#include "solver/tension.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float rest_length[5];        // [m] along a row, along a column, diagonal, two along each
uniform float offset_share;          // of the offsets, left by now
uniform float softer[3];             // stiffness before over that now: structural, shear, bend
uniform float softer_at_pins[3];     // the same of edges to a pinned node

void offset(vec4 here, bool is_free, int row, int col, int drow, int dcol, int family, int rest) {
    int other = node_index(row + drow, col + dcol);
    vec4 there = load_position(other);
    bool at_pin = !is_free || load_velocity(other).w <= 0.0;
    float ratio = at_pin ? softer_at_pins[family] : softer[family];
    int entry = tension_entry(TENSION_OFFSET, solver_index(row, col), drow, dcol);
    float before = offset_share * tension[entry];
    float extension = length(there.xyz - here.xyz) - rest_length[rest];
    // An edge that has come back by itself, past what it was off by, needs it no more.
    before = before > 0.0 ? clamp(extension, 0.0, before) : clamp(extension, before, 0.0);
    float now = extension - ratio * (extension - before);
    if (ratio > 1.0) {
        // Edges that become softer give back what they had, and no more.
        now = clamp(now, min(before, 0.0), max(before, 0.0));
    }
    tension[entry] = there.w > 0.0 ? now : 0.0;
}

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec4 here = load_position(index);
    bool is_free = load_velocity(index).w > 0.0;
#if HAS_STRUCTURAL
    offset(here, is_free, row, col, 0, 1, 0, 0);
    offset(here, is_free, row, col, 1, 0, 0, 1);
#endif
#if HAS_SHEAR
    offset(here, is_free, row, col, 1, 1, 1, 2);
    offset(here, is_free, row, col, 1, -1, 1, 2);
#endif
#if HAS_BEND
    offset(here, is_free, row, col, 0, 2, 2, 3);
    offset(here, is_free, row, col, 2, 0, 2, 4);
#endif
}
