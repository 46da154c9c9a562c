// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Clear the contacts and their impulses on nodes, one node an invocation.

#include "lattice.glsl"
#include "self_contact/head.glsl"
#include "self_contact/contacts.glsl"

layout(local_size_x = SELF_LOCAL) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= self_node_count) {
        return;
    }
    uint index = self_nodes[i].listed;
    self_nodes[index].impulse = int[3](0, 0, 0);
    self_nodes[index].shares = self_nodes[index].contacts = self_nodes[index].entries = 0u;
}
