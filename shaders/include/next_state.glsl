// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The state that is written, as passes before this one have left it. LOADS_TEXTURE as in
// state_in.glsl. WRITES_NEXT 1: the includer has declared position_out and velocity_out.

#if LOADS_TEXTURE
layout(binding = POSITION_OUT) uniform samplerBuffer next_positions;
layout(binding = VELOCITY_OUT) uniform samplerBuffer next_velocities;

vec4 load_next_position(int index) { return texelFetch(next_positions, index); }

vec4 load_next_velocity(int index) { return texelFetch(next_velocities, index); }
#else
#if !WRITES_NEXT
layout(std430, binding = POSITION_OUT) readonly buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) readonly buffer VelocityOut { vec4 velocity_out[]; };
#endif

vec4 load_next_position(int index) { return position_out[index]; }

vec4 load_next_velocity(int index) { return velocity_out[index]; }
#endif
