layout(location = 0) in vec3 position;
layout(location = 1) in vec2 slabIn;
flat out vec2 slab;
uniform mat4 frameToClip;

void main()
{
    slab = slabIn;
#if defined(SLOTS) || defined(FUSED)
    gl_Position = vec4(position, 1.0); // in device coordinates
#else
    gl_Position = frameToClip * vec4(position, 1.0);
#endif
}
