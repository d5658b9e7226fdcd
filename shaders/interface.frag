// The window's panels: an image (the letters of a font, a photograph) times a colour.
uniform highp sampler2D image;

in vec2 at;
in vec4 shade;

layout(location = 0) out vec4 color;

void main() { color = shade * texture(image, at); }
