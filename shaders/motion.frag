// Blends a frame with the image before it: each pixel with what that image shows of the same point.
uniform sampler2D image;
uniform highp sampler2D depth;
uniform sampler2D earlier;       // the image before, filtered linearly
uniform vec2 inverse_distance;   // along the viewing axis: x + y * depth
uniform vec4 ray_of_pixel;       // view direction with z = -1: pixel * xy + zw
uniform mat3 turn;               // to the view before
uniform vec3 shift;
uniform vec4 place_of_ray;       // in the image before, from 0 to 1: x, y at z = -1, * xy + zw
uniform float share;             // of this frame

layout(location = 0) out vec4 color;

vec4 sharp(vec2 place) {
  vec2 size = vec2(textureSize(earlier, 0));
  vec2 at = place * size, middle = floor(at - 0.5) + 0.5, f = at - middle;
  vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f)), w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
  vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f)), w3 = f * f * (-0.5 + 0.5 * f);
  vec2 w12 = w1 + w2, t12 = (middle + w2 / w12) / size, t0 = (middle - 1.0) / size, t3 = (middle + 2.0) / size;
  vec4 sum = texture(earlier, vec2(t12.x, t0.y)) * w12.x * w0.y + texture(earlier, vec2(t0.x, t12.y)) * w0.x * w12.y +
    texture(earlier, t12) * w12.x * w12.y + texture(earlier, vec2(t3.x, t12.y)) * w3.x * w12.y +
    texture(earlier, vec2(t12.x, t3.y)) * w12.x * w3.y;
  float total = w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y;
  return sum / total;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(image, 0) - 1;
  color = texelFetch(image, pixel, 0);
  // Divided by the distance, so that a background at infinity only turns.
  float inverse = inverse_distance.x + inverse_distance.y * texelFetch(depth, pixel, 0).r;
  vec3 ray = vec3(gl_FragCoord.xy * ray_of_pixel.xy + ray_of_pixel.zw, -1.0);
  vec3 before = turn * ray + shift * inverse;
  vec2 place = before.xy / -before.z * place_of_ray.xy + place_of_ray.zw;
  if (before.z >= 0.0 || place != clamp(place, 0.0, 1.0)) return;
  // A colour that no neighbour has now is of something that has moved away or was hidden.
  vec4 low = color, high = color;
  for (int i = 0; i < 4; ++i) {
    ivec2 side = i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5);
    vec4 neighbour = texelFetch(image, clamp(pixel + side, ivec2(0), last), 0);
    low = min(low, neighbour);
    high = max(high, neighbour);
  }
  color = mix(clamp(sharp(place), low, high), color, share);
}
