// Each pixel from the same pixel of another image: the least that a pass over all pixels can do.
uniform highp sampler2D image;

layout(location = 0) out vec4 color;

void main() { color = texelFetch(image, ivec2(gl_FragCoord.xy), 0); }
