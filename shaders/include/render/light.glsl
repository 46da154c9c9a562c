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

// Light on a surface. Both sides are lit alike; the back is a little darker.

uniform vec3 light;     // unit vector to the lamp
uniform vec3 halfway;   // unit vector between it and the camera

vec3 lit(vec3 color, vec3 normal, bool is_front) {
    vec3 outward = is_front ? normal : -normal;
    // Light that reaches around: what faces away from the lamp keeps its shape.
    float diffuse = pow(0.5 + 0.5 * dot(outward, light), WRAP_POWER);
    float gloss = GLOSS * pow(max(dot(outward, halfway), 0.0), GLOSS_POWER);
    float level = (AMBIENT + (1.0 - AMBIENT) * diffuse) * (is_front ? 1.0 : BACK);
    return min(color * level + gloss, 1.0);
}
