// Copies each pixel of another image: the minimum work of a pass over all pixels.
uniform highp sampler2D image;

layout(location = 0) out vec4 color;

void main() { color = texelFetch(image, ivec2(gl_FragCoord.xy), 0); }
