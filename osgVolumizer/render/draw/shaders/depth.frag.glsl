// What surfaces left in the target's depth, for the framebuffer.

uniform sampler2D targetDepth, opaqueDepth;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(targetDepth, pixel, 0).r;
    if (depth == texelFetch(opaqueDepth, pixel, 0).r) discard;
    gl_FragDepth = depth;
}
