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

// Acceleration that is not from springs: gravity, pushes and air.

uniform vec3 acceleration;         // [m/s2] gravity and pushes on the whole cloth
uniform bool has_region_pushes;    // something acts on nodes each by itself

// What acts on nodes each by itself [m/s2]: pushes on regions, and air; w: how many pushes act.
// Bound only while something does.
#if LOADS_TEXTURE
layout(binding = REGION_PUSHES) uniform samplerBuffer region_pushes;
vec4 load_region_pushes(int index) { return texelFetch(region_pushes, index); }
#else
layout(std430, binding = REGION_PUSHES) readonly buffer RegionPushes { vec4 region_pushes[]; };
vec4 load_region_pushes(int index) { return region_pushes[index]; }
#endif

vec3 applied_acceleration(int index) {
    vec3 applied = acceleration;
    if (has_region_pushes) {
        applied += load_region_pushes(index).xyz;
    }
    return applied;
}

bool is_pushed_in_region(int index) {
    return has_region_pushes && load_region_pushes(index).w > 0.0;
}
