// The depth that surfaces of one rank have to equal, or that of the opaque scene.

uniform sampler2D sortedFar, sortedNear, opaqueDepth;
uniform int rank; // -1: the opaque scene

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth;
    if (rank < 0) {
        depth = texelFetch(opaqueDepth, pixel, 0).r;
    } else {
        vec4 four = rank < 4 ? texelFetch(sortedFar, pixel, 0) : texelFetch(sortedNear, pixel, 0);
        depth = four[rank & 3];
    }
    gl_FragDepth = max(depth, 0.0);
}
