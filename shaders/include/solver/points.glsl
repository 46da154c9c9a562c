// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The entries of the cloth where each stands alone: an invocation has POINTS of them.

#define FOR_POINTS \
    for (int index = int(gl_GlobalInvocationID.x) * POINTS, last = min(index + POINTS, STORED); \
            index < last; ++index)
