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

// Access to the vectors of all levels.

layout(std430, binding = SOLVER_VECTORS) buffer Vectors { vec4 vectors[]; };

#if LOADS_TEXTURE
layout(binding = SOLVER_VECTORS) uniform samplerBuffer vectors_in;

vec3 load_vector(int entry) { return texelFetch(vectors_in, entry).xyz; }
#else
vec3 load_vector(int entry) { return vectors[entry].xyz; }
#endif

void store_vector(int entry, vec3 value) { vectors[entry].xyz = value; }
