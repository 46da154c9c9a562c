// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The state that is written, as passes before this one have left it. LOADS_TEXTURE as in
// state_in.glsl: a load of a storage block takes software some twenty cycles a lane. Includer:
// position_out and velocity_out where it is 0.

#if LOADS_TEXTURE
layout(binding = POSITION_OUT) uniform samplerBuffer next_position;
layout(binding = VELOCITY_OUT) uniform samplerBuffer next_velocity;

vec4 load_next_position(int index) { return texelFetch(next_position, index); }

vec4 load_next_velocity(int index) { return texelFetch(next_velocity, index); }
#else
vec4 load_next_position(int index) { return position_out[index]; }

vec4 load_next_velocity(int index) { return velocity_out[index]; }
#endif
