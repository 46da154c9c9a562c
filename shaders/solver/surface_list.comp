// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the contacts with thin colliders, the nodes that they act on, and the contacts of each node,
// in an order that is always the same: one workgroup, each invocation of which has some nodes.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/surface_contacts.glsl"

layout(local_size_x = SURFACE_LOCAL) in;

// Contacts, nodes, and contacts of nodes of each invocation.
shared uvec3 counts[SURFACE_LOCAL];

// Count the contacts of a node; or list them from first on.
uint contacts_of(int index, bool lists, uint first) {
    uint count = 0u;
    ivec4 owners = index - ivec4(0, 1, PITCH, PITCH + 1);
    for (int i = 0; i < 4; ++i) {
        for (int body = 0; body < THIN_COLLIDERS; ++body) {
            uint bits = surface_lists[body * STORED + owners[i]];
            for (; bits != 0u; bits &= bits - 1u) {
                int row = findLSB(bits);
                int place = contact_place(body, row, owners[i]);
                ivec3 nodes = owners[i] + contact_offsets(row);
                for (int n = 0; n < nodes_in(row); ++n) {
                    if (nodes[n] != index) {
                        continue;
                    }
                    if (lists) {
                        surface_lists[uint(OF_NODE_AT) + first + count] =
                            4u * uint(place) + uint(n);
                    }
                    ++count;
                }
            }
        }
    }
    return count;
}

// Go through the nodes of an invocation; return how many of each kind there are with those before.
uvec3 go_through(int begin, int end, bool lists, uvec3 found) {
    for (int index = begin; index < end; ++index) {
        for (int body = 0; body < THIN_COLLIDERS; ++body) {
            uint bits = surface_lists[body * STORED + index];
            for (; bits != 0u; bits &= bits - 1u) {
                if (lists) {
                    surface_lists[uint(CONTACTS_AT) + found.x] =
                        uint(contact_place(body, findLSB(bits), index));
                }
                ++found.x;
            }
        }
        uint count = contacts_of(index, lists, found.z);
        if (lists) {
            if (count > 0u) {
                surface_lists[uint(HELD_AT) + found.y] = uint(index);
            } else if (surface_holds[index].count > 0) {
                system_data[cloth_entry(SURFACE_GROUND, index)] = vec4(0.0);
                system_data[cloth_entry(SURFACE_GROUND + 1, index)] = vec4(0.0);
            }
            surface_holds[index].first = int(found.z);
            surface_holds[index].count = int(count);
        }
        found += uvec3(0u, count > 0u ? 1u : 0u, count);
    }
    return found;
}

void main() {
    int lane = int(gl_LocalInvocationID.x);
    // Nodes have ghosts before them.
    int first = HALO * PITCH;
    int share = (STORED - first + SURFACE_LOCAL - 1) / SURFACE_LOCAL;
    int begin = first + lane * share;
    int end = min(begin + share, STORED);
    counts[lane] = go_through(begin, end, false, uvec3(0u));
    barrier();
    uvec3 before = uvec3(0u);
    for (int i = 0; i < lane; ++i) {
        before += counts[i];
    }
    uvec3 found = go_through(begin, end, true, before);
    if (lane == SURFACE_LOCAL - 1) {
        listed_contacts = found.x;
        held_nodes = found.y;
        changed_owners = 0u;
    }
}
