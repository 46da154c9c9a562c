// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// How far structural and shear springs may stretch or shorten.

#include "read_first.glsl"

uniform float limit;  // largest abs(l / L0 - 1)
float strain_limit = READ_FIRST(limit);

bool is_beyond_limit(float now, float rest) { return abs(now - rest) > limit * rest; }
