// Colours the pixels whose features features.frag has stored; the depth test rejects the others.
#include "network.glsl"
#include "view_direction.glsl"

uniform sampler2D stored_features0;
uniform sampler2D stored_features1;

layout(location = 0) out vec4 color;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  color = vec4(color_mlp(texelFetch(stored_features0, pixel, 0), texelFetch(stored_features1, pixel, 0),
                         direction_to_eye(gl_FragCoord.xy)),
               1.0);
}
