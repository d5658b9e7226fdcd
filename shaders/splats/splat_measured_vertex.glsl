// What measured splats need besides what drawn ones do (splat_blended.glsl).
#if MEASURES
uniform mat3 world_from_layer;  // rotation or reflection

flat out int place;    // in the order of blending
flat out vec3 normal;  // in world axes, of unit length, towards the eye

// The normal of a surface through a point at `from_eye`, both in layer coordinates.
void measure_vertex(vec3 surface_normal, vec3 from_eye) {
  place = gl_VertexID / 3;
  float size = length(surface_normal);
  normal = size > 0.0 ? world_from_layer * (surface_normal / size) : vec3(0.0);
  if (dot(surface_normal, from_eye) > 0.0) normal = -normal;
}
#endif
