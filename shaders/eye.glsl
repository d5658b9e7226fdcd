// Their sum is the eye, relative to the soup's origin; position - eye_high is exact when close.
uniform vec3 eye_high, eye_low;
