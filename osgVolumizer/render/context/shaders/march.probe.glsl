// A march through a small texture: what volumes' shaders spend their time with, as often as asked.

uniform sampler3D texels;
uniform int steps;

vec4 probe()
{
    vec3 place = vec3(windowPlace() / float(SIDE), 0.0);
    vec3 color = vec3(0.0);
    float through = 1.0;
    for (int i = 0; i < steps && through > 1e-4; ++i) {
        place.z = (float(i) + 0.5) / float(steps);
        float value = texture(texels, place).r;
        float behind = through * exp2(-0.001 * value);
        color += (through - behind) * vec3(value, 1.0 - value, 0.5);
        through = behind;
    }
    return vec4(color, 1.0 - through);
}

#ifdef COMPUTE
layout(rgba32f, binding = TARGET_UNIT) uniform image2D target;
void main()
{
    ivec2 pixel = ivec2(windowPlace());
    vec4 c = probe();
    imageStore(target, pixel, c + (1.0 - c.a) * imageLoad(target, pixel));
}
#else
out vec4 fragColor;
void main() { fragColor = probe(); }
#endif
