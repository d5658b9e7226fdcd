// The stored depth of one pixel, bit by bit: the common way to read depth where only colours can be
// read.
uniform highp sampler2D depth;
uniform ivec2 pixel;

layout(location = 0) out highp uvec4 bits;

void main() { bits = uvec4(floatBitsToUint(texelFetch(depth, pixel, 0).r)); }
