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

#version 430 core
// A ball with a light rim.

uniform float radius;
uniform float opacity;
uniform vec3 ball_color;
in vec2 place;
out vec4 color;

void main() {
    float away = length(place);
    float cover = clamp((1.0 - away) * radius + 0.5, 0.0, 1.0);
    if (cover == 0.0) {
        discard;
    }
    float rim = clamp((away - 1.0) * radius + min(RIM, 0.3 * radius) + 0.5, 0.0, 1.0);
    vec3 normal = vec3(place, sqrt(max(1.0 - away * away, 0.0)));
    float level = 0.7 + 0.45 * max(dot(normal, vec3(-0.45, 0.55, 0.70)), 0.0);
    color = vec4(mix(min(ball_color * level, 1.0), vec3(1.0), rim), opacity * cover);
}
