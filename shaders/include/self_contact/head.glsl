// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Figures of the contact of the cloth with itself in a substep, and the workgroups of its passes.
// Least and largest numbers are of bits that keep the order of floats, so that atomics are exact.

layout(std430, binding = SELF_HEAD) buffer SelfHead {
    // These stay for as long as contacts serve.
    uint contact_groups[3];  // workgroups of passes over contacts [1]
    uint contact_count;
    uint node_groups[3];     // workgroups of passes over the nodes with contacts [1]
    uint self_node_count;
    uint acting_groups[3];   // workgroups of passes over the contacts that act [1]
    uint acting_count;
    uint entry_count;        // texels of the entries of all nodes
    uint least_distance;    // [m] of a pair that was looked at, or of a contact
    // These begin anew in each substep.
    uint least_moved[3];    // [m] since the lists were made, in this substep as well
    uint most_moved[3];
    uint least_speed[3];    // [m/s] of the substep without contact
    uint most_speed[3];
    uint vertex_pairs;      // of a node and a triangle
    uint edge_pairs;        // of two edges
    uint cut_nodes;
    uint largest_cut;       // [m]
    uint longest_way;       // [m] of a node in the substep, beside what is common to all
    uint largest_impulse;   // [m/s]
    uint largest_change;    // [m/s] of one in the last round
    uint undivided;         // pairs that no plane divides
    uint unfinished;        // nodes whose pairs were not all looked for
    uint largest;           // [m] coordinate
    uint crossing_edges;    // that pierce triangles
    uint first_crossing;    // least node of such an edge
    uint cut_pins;          // among the nodes whose way was cut
    uint largest_drive;     // [m/s] that a solve of the implicit step is to include
};

uint in_order(float value) {
    uint bits = floatBitsToUint(value);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
