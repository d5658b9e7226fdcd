// Colours of rising lightness for t in [0, 1]; image/heat_map.cpp has the same colours, and a test
// compares the two.
vec3 heat_ramp(float t) {
  const vec3 stops[5] = vec3[5](vec3(0.18, 0.05, 0.38), vec3(0.58, 0.10, 0.42), vec3(0.90, 0.28, 0.20),
                                vec3(0.99, 0.72, 0.22), vec3(1.0));
  float at = clamp(t, 0.0, 1.0) * 4.0;
  int below = min(int(at), 3);
  return mix(stops[below], stops[below + 1], at - float(below));
}

// A count, at least 1; as overdraw_color() in runtime/debug_views/debug_view.cpp.
vec3 count_color(float count) { return heat_ramp(log2(count) / 8.0); }

// A depth; near is bright. `scale`: ln(near) and 1 / ln(far / near) of DepthScale.
vec3 depth_color(float depth, vec2 scale) { return heat_ramp(1.0 - (log(depth) - scale.x) * scale.y); }
