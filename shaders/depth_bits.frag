// The stored depths as bits. OpenGL ES can read back only colours.
uniform highp sampler2D depth;

layout(location = 0) out highp uvec4 bits;

void main() {
  bits = uvec4(floatBitsToUint(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r), 0u, 0u, 0u);
}
