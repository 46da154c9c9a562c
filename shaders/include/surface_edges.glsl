// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The point of an edge of the cloth that is nearest to a collider.

// Max. bisections and tangent cuts of the bracket [1]: 12 locate the point to 3e-7 of the edge.
#define EDGE_STEPS 14
// Slope over the difference of the slopes at both ends [1] at which the search ends; as exact as all
// steps.
#define EDGE_LEVEL 3e-7

struct NearEdge {
    float place;     // along the edge, from 0 to 1
    float distance;  // [m], signed
    vec3 slope;      // of the distance across the edge; its length is 1 where the surface is smooth
};

// Spheres and capsules: all points within a radius of a core.
bool has_round_core(int collider) { return int(collider_shape[collider]) <= SHAPE_CAPSULE; }

// Slope of the distance along an edge; for a round core that of half the squared distance to the core,
// which is linear except at the ends of a capsule.
float slope_along(int collider, vec4 near, vec3 along) {
    float slope = dot(near.xyz, along);
    return has_round_core(collider) ? (near.w + collider_size[collider].x) * slope : slope;
}

// a, b: ends of the edge from the centre of the collider [m]; first, last: gradients and distances
// there. The signed distance is convex along a line, and its gradients at both ends of a bracket
// bound it from below: the intersection of both tangents alternates with bisection.
NearEdge nearest_on_edge(int collider, vec3 a, vec3 b, vec4 first, vec4 last) {
    vec3 along = b - a;
    float slope_first = slope_along(collider, first, along);
    float slope_last = slope_along(collider, last, along);
    bool is_first = !(slope_first < 0.0);
    bool is_last = !is_first && !(slope_last > 0.0);
    bool is_round = has_round_core(collider);
    float level = EDGE_LEVEL * (slope_last - slope_first);
    float begin = 0.0, end = 1.0;
    // llvmpipe runs the body of a branch for all edges, but skips a loop without rounds.
    int steps = is_first || is_last ? 0 : EDGE_STEPS;
    for (int i = 0; i < steps; ++i) {
        float middle = 0.5 * (begin + end);
        float cut = begin + (is_round ? -slope_first * (end - begin)
            : last.w - first.w - slope_last * (end - begin)) / (slope_first - slope_last);
        bool is_cut = is_round ? i % 3 < 2 : i % 2 == 0;
        float place = is_cut && cut > begin && cut < end ? cut : middle;
        vec4 found = distance_to_collider(collider, a + place * along);
        float slope = slope_along(collider, found, along);
        if (slope < 0.0) {
            begin = place;
            first = found;
            slope_first = slope;
        } else {
            end = place;
            last = found;
            slope_last = slope;
        }
        steps = abs(slope) <= level ? 0 : steps;
    }
    if (is_first) {
        return NearEdge(0.0, first.w, first.xyz);
    }
    if (is_last) {
        return NearEdge(1.0, last.w, last.xyz);
    }
    // At a rim the gradients of both sides differ; the gradient across the edge lies between them.
    float share = slope_last / max(slope_last - slope_first, 1e-30);
    return NearEdge(
        share * begin + (1.0 - share) * end, min(first.w, last.w),
        share * first.xyz + (1.0 - share) * last.xyz);
}
