// The stored depth of one pixel as bits. OpenGL ES can read back only colours.
uniform highp sampler2D depth;
uniform ivec2 pixel;

layout(location = 0) out highp uvec4 bits;

void main() { bits = uvec4(floatBitsToUint(texelFetch(depth, pixel, 0).r)); }
