// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// How far the corners of the cell of each node have gone: all in all since lists were made, at most of
// the four in each substep, and in the last substep [m]. Two features come nearer by no more than
// what both of their cells have gone. Substeps that were made again count twice.

layout(std430, binding = SELF_WAYS) buffer SelfWays { vec4 cell_ways[]; };
