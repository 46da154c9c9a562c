// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Component of a vec4 that belongs to an edge: of a short one, and of one that spans two.
// Masked, since NVIDIA's compiler refuses a constant index that is out of bounds, even in a branch
// that is never taken.

#define SHORT_SLOT(edge) ((edge) & 3)
#define LONG_SLOT(edge) ((edge) - EDGE_TWO_ROW & 1)
