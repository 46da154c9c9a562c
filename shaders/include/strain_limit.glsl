// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// How far structural and shear springs may stretch or shorten.

#define NO_LIMIT 0
#define RIGID_LIMIT 1

uniform float limit;  // largest abs(l / L0 - 1)

bool is_beyond_limit(float now, float rest) { return abs(now - rest) > limit * rest; }

// Length by which a spring is too long (above 0) or too short (below 0) [m]; 0 within the limit.
