// Copyright 2026 the cloth_sim_ros authors
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

// Acceleration that is not from springs: gravity and pushes.

uniform vec3 acceleration;  // [m/s2] gravity and pushes on the whole cloth

#if HAS_REGION_PUSHES
// What pushes on regions add at a node [m/s2]; w: how many act on it.
layout(std430, binding = REGION_PUSHES) readonly buffer RegionPushes { vec4 region_pushes[]; };

vec3 applied_acceleration(int index) { return acceleration + region_pushes[index].xyz; }
#else
vec3 applied_acceleration(int index) { return acceleration; }
#endif
