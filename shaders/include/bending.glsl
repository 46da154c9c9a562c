// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Bending by the linear law of docs/explanation/numerics.md: three nodes in a line, along a row or
// a column, store c / 2 D^2 with their second difference D, and a node at place i of its line
// feels -c (D[i-1] - 2 D[i] + D[i+1]). A line that leaves the cloth stores nothing.

// Second difference of a quantity at three nodes in a line, times the share of a whole line that
// it has: 0 if one of the nodes is a ghost.
vec3 second_difference(float share, vec3 behind, vec3 here, vec3 ahead) {
    return share * ((behind - here) + (ahead - here));
}

// Both neighbours first: a mirrored cloth rounds alike.
vec3 unbent(vec3 behind, vec3 here, vec3 ahead) { return (behind + ahead) - 2.0 * here; }
