flat in vec3 edges[3];
flat in float inradius, sigma;
flat in vec4 color;

layout(location = 0) out vec4 blended;  // premultiplied

void main() {
  vec3 pixel = vec3(gl_FragCoord.xy, 1.0);
  float distance_from_edges =
      min(dot(edges[0], pixel), min(dot(edges[1], pixel), dot(edges[2], pixel)));
  // pow() of values below 0 is undefined.
  float alpha = color.a * pow(max(distance_from_edges / inradius, 0.0), sigma);
  if (alpha < 1.0 / 255.0) discard;
  blended = vec4(alpha * color.rgb, alpha);
}
