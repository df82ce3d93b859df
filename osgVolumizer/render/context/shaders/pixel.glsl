// The middle of the pixel, in window coordinates.
#ifdef COMPUTE
layout(local_size_x = 8, local_size_y = 8) in;
uniform vec4 area; // window pixels: x, y, width, height
vec2 windowPlace() { return area.xy + vec2(gl_GlobalInvocationID.xy) + 0.5; }
#define LEAVE return
#else
vec2 windowPlace() { return gl_FragCoord.xy; }
#define LEAVE discard
#endif
