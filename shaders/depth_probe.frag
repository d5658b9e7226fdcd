// The stored depths from `pixel` on as bits. OpenGL ES can read back only colours.
uniform highp sampler2D depth;
uniform ivec2 pixel;

layout(location = 0) out highp uvec4 bits;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) + pixel;
  bits = uvec4(floatBitsToUint(texelFetch(depth, at, 0).r), 0u, 0u, 0u);
}
