// Each pixel from the same pixel of another picture: the least that a pass over all pixels can do.
uniform highp sampler2D picture;

layout(location = 0) out vec4 color;

void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }
