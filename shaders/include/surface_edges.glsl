// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Where an edge of the cloth is nearest to a collider.

// Halvings and cuts of the bracket [1]: 12 find the place to 3e-7 of the edge.
#define EDGE_STEPS 14

struct NearEdge {
    float place;     // along the edge, from 0 to 1
    float distance;  // [m], signed
    vec3 slope;      // of the distance across the edge; its length is 1 where the surface is smooth
};

// a, b: ends of the edge from the centre of the collider [m]; first, last: gradients and distances
// there. The signed distance is convex along a line, and its gradients at both ends of a bracket
// bound it from below: cuts of the two tangents alternate with halves.
NearEdge nearest_on_edge(int collider, vec3 a, vec3 b, vec4 first, vec4 last) {
    vec3 along = b - a;
    float slope_first = dot(first.xyz, along);
    float slope_last = dot(last.xyz, along);
    bool is_first = !(slope_first < 0.0);
    bool is_last = !is_first && !(slope_last > 0.0);
    float begin = 0.0, end = 1.0;
    // Software runs the body of a branch for edges that do not take it, but no loop that ends at
    // once.
    int steps = is_first || is_last ? 0 : EDGE_STEPS;
    for (int i = 0; i < steps; ++i) {
        float middle = 0.5 * (begin + end);
        float cut = begin + (last.w - first.w - slope_last * (end - begin))
            / (slope_first - slope_last);
        float place = i % 2 == 0 && cut > begin && cut < end ? cut : middle;
        vec4 found = distance_to_collider(collider, a + place * along);
        float slope = dot(found.xyz, along);
        if (slope < 0.0) {
            begin = place;
            first = found;
            slope_first = slope;
        } else {
            end = place;
            last = found;
            slope_last = slope;
        }
    }
    if (is_first) {
        return NearEdge(0.0, first.w, first.xyz);
    }
    if (is_last) {
        return NearEdge(1.0, last.w, last.xyz);
    }
    // At a rim the gradients of both sides differ: the one across the edge lies between them.
    float share = slope_last / max(slope_last - slope_first, 1e-30);
    return NearEdge(
        share * begin + (1.0 - share) * end, min(first.w, last.w),
        share * first.xyz + (1.0 - share) * last.xyz);
}
