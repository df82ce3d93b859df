// osg::Fog, by depth: as OpenGL has it without programs.

#ifdef FOG
uniform vec3 fogColor;
uniform bool fogIsLinear;
uniform vec3 fogRates; // of depth to the powers 0, 1, 2: linear, the colour's share; else its -log2
uniform float fogDepth; // where t is counted from

vec3 fogged(vec3 color, float t)
{
    float depth = fogDepth + t;
    float share = dot(fogRates, vec3(1.0, depth, depth * depth));
    return mix(fogColor, color, clamp(fogIsLinear ? share : exp2(-share), 0.0, 1.0));
}
#else
#define fogged(color, t) color
#endif
