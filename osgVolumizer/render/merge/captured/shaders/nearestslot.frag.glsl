// The depth of a pixel's nearest captured fragment.

uniform sampler2DArray sortedSlots;

void main()
{
    float depth = texelFetch(sortedSlots, ivec3(ivec2(gl_FragCoord.xy), 0), 0).r;
    if (depth > 1.0) discard;
    gl_FragDepth = depth;
}
