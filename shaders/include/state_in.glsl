// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The state that is read. position.w is 0 for a ghost, and as in cells.glsl for a node; velocity.w
// is the inverse mass of a free node, 1 for one of equal mass or amid a cloth of cells, and 0 for a
// pinned one or a ghost. A pinned node has the velocity of its pin.
// LOADS_TEXTURE: read through texture units, which software devices do several times faster than
// storage blocks.

#include "cells.glsl"

#if LOADS_TEXTURE
layout(binding = POSITION_IN) uniform samplerBuffer position_in;
#ifndef POSITIONS_ALONE
layout(binding = VELOCITY_IN) uniform samplerBuffer velocity_in;
#endif

vec4 load_position(int index) { return texelFetch(position_in, index); }
#ifndef POSITIONS_ALONE
vec4 load_velocity(int index) { return texelFetch(velocity_in, index); }
#endif
#else
layout(std430, binding = POSITION_IN) readonly buffer PositionIn { vec4 position_in[]; };
#ifndef POSITIONS_ALONE
layout(std430, binding = VELOCITY_IN) readonly buffer VelocityIn { vec4 velocity_in[]; };
#endif

vec4 load_position(int index) { return position_in[index]; }
#ifndef POSITIONS_ALONE
vec4 load_velocity(int index) { return velocity_in[index]; }
#endif
#endif
