// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The nodes that may touch a collider in a substep, in no order, and the workgroups for them.

#define NEAR_LOCAL 32u

layout(std430, binding = NEAR_NODES) buffer NearNodes {
    uint near_groups_x;
    uint near_groups_y;
    uint near_groups_z;
    uint near_count;
    uint near_nodes[];
};
