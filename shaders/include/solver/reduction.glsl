// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// One workgroup adds up the partial sums, finds the step along the next direction (conjugate
// gradients after Chronopoulos and Gear, doi:10.1016/0377-0427(89)90045-9), and decides whether
// there is another iteration: without one, all passes that follow are dispatched with no
// workgroups. Includer: LOAD_SUMS.

#define SCALARS_ACCESS
#include "solver/scalars.glsl"

layout(std430, binding = SOLVER_DISPATCHES) writeonly buffer Dispatches { uint dispatches[]; };

uniform int sum_count;
uniform float tolerance_square;
uniform bool sets_scale;     // in a first solve
uniform float least_scale;   // of it
uniform bool may_stay;       // where the solve begins may be the solution
uniform float early_square;  // of the measure at the start, what may be left

// Min. ratio of the measure by one step [1]. It is a square; steps after the first reduce its root
// by a factor of 0.3 to 0.6.
#define LEAST_KEPT 0.25

uniform int groups_count;
uniform ivec2 groups_of_each[MOST_GROUPS_COUNTS];  // workgroups of the passes that are switched

shared vec3 sums[REDUCE_LOCAL];

bool is_number(float value) { return (floatBitsToUint(value) & 0x7f800000u) != 0x7f800000u; }

void decide(float now, float curvature, float size) {
    bool first = iterations == 0.0;
    float start = first ? now : measure_start;
    keep = first ? 0.0 : now / measure;
    // Along the direction, from that along the preconditioned residual.
    float bent = first ? curvature : curvature - keep * now / step_length;
    bool sound = now > 0.0 && bent > 0.0;
    step_length = sound ? now / bent : 0.0;
    // NaN in the system is passed on to the nodes, so that it is detected.
    if (!is_number(now) || !is_number(bent)) {
        step_length = uintBitsToFloat(0x7fc00000u);
        sound = false;
    }
    measure = now;
    measure_start = start;
    iterations += first && !sound ? 0.0 : 1.0;
    // Estimate of the measure after this step: reduced by the same factor as by the last step, at
    // most by LEAST_KEPT. The first step reduces it 10 to 30 times as much, which does not predict
    // the next. An unsound measure makes no step and is kept: a NaN, or a negative one, which is
    // not a small residual but an indefinite preconditioner.
    measure_after = first || !sound ? abs(now) : now * clamp(keep, LEAST_KEPT, 1.0);
    if (sets_scale) {
        scale = max(size, least_scale);
    }
    float allowed = tolerance_square * scale;
    if (may_stay && first && now <= allowed) {
        step_length = 0.0;
    }
    allowed = max(allowed, early_square * start);
    uint another = sound && measure_after > allowed ? 1u : 0u;
    is_going = float(another);
    for (int i = 0; i < groups_count; ++i) {
        dispatches[3 * i] = another * uint(groups_of_each[i].x);
        dispatches[3 * i + 1] = uint(groups_of_each[i].y);
        dispatches[3 * i + 2] = 1u;
    }
}

// By the first REDUCE_LOCAL invocations of a workgroup; all of it pass the barrier.
void reduce(int at) {
    vec3 sum = vec3(0.0);
    for (int i = at; i < sum_count; i += REDUCE_LOCAL) {
        sum += LOAD_SUMS(i);
    }
    if (at < REDUCE_LOCAL) {
        sums[at] = sum;
    }
    barrier();
    if (at == 0) {
        vec3 total = vec3(0.0);
        for (int i = 0; i < REDUCE_LOCAL; ++i) {
            total += sums[i];
        }
        decide(total.x, total.y, total.z);
    }
}
