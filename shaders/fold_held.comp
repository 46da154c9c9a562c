// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Add up what pinned nodes were driven with in some substeps, and keep the strongest. One
// invocation a holder: a pinned node, or a grasp, which holds several in successive slots.

layout(local_size_x = FOLD_LOCAL) in;

// From first_entry on, slot by slot in each substep; w: how long it acted [s].
layout(std430, binding = HELD) readonly buffer Held { vec4 held[]; };

struct Holder {
    vec4 step_change;   // [m/s] in the last step of dt; w: the first slot
    vec4 step_peak;     // [m/s2] strongest substep in it; w: the slot after the last
    vec4 frame_change;  // the same since the host has taken them
    vec4 frame_peak;
};

// Holders, and behind them what holders do to each slot by themselves: as the step begins and as
// it ends [m/s].
layout(std430, binding = HELD_SUMS) buffer Sums { Holder holder[]; };
layout(std430, binding = HELD_OWN) readonly buffer Own { vec4 own[]; };

// One array, which is set in one call:
// holders, slots, first entry, how many substeps there are entries of;
// the substep in which the last step of dt begins, whether it begins among these; before which one
// pins change their velocity, after which one, or -1;
// whether to continue the frame, where the sums are read and where they are written.
uniform ivec4 how[3];

void main() {
    int at = int(gl_GlobalInvocationID.x);
    if (at >= how[0].x) {
        return;
    }
    int slots = how[0].y;
    bool begins = how[1].y != 0;
    bool goes_on = how[2].x != 0;
    Holder sums = holder[how[2].y + at];
    int first = int(sums.step_change.w);
    int end = int(sums.step_peak.w);
    vec3 step_change = begins ? vec3(0.0) : sums.step_change.xyz;
    vec3 step_peak = begins ? vec3(0.0) : sums.step_peak.xyz;
    vec3 frame_change = goes_on ? sums.frame_change.xyz : vec3(0.0);
    vec3 frame_peak = goes_on ? sums.frame_peak.xyz : vec3(0.0);
    for (int entry = 0; entry < how[0].w; ++entry) {
        vec3 change = vec3(0.0);
        float kick = 0.0;
        for (int slot = first; slot < end; ++slot) {
            vec4 driven = held[how[0].z + entry * slots + slot];
            change += driven.xyz;
            kick = driven.w;
            change -= entry == how[1].z ? own[slot].xyz : vec3(0.0);
            change -= entry == how[1].w ? own[slots + slot].xyz : vec3(0.0);
        }
        vec3 rate = kick > 0.0 ? change / kick : vec3(0.0);
        frame_change += change;
        frame_peak = dot(rate, rate) > dot(frame_peak, frame_peak) ? rate : frame_peak;
        if (entry >= how[1].x) {
            step_change += change;
            step_peak = dot(rate, rate) > dot(step_peak, step_peak) ? rate : step_peak;
        }
    }
    holder[how[2].z + at] = Holder(
        vec4(step_change, first), vec4(step_peak, end), vec4(frame_change, 0.0),
        vec4(frame_peak, 0.0));
}
