// Window depths of a pixel's captured fragments, far to near; -1 where there are no more. Those behind the opaque
// scene are left out, and of equal ones all but one, since they are drawn together.

layout(location = 0) out vec4 sortedFar;
layout(location = 1) out vec4 sortedNear;

uniform sampler2D depths0, depths1, depths2, depths3, depths4, depths5, depths6, depths7;
uniform sampler2D opaqueDepth;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float d[8] = float[8](texelFetch(depths0, pixel, 0).r, texelFetch(depths1, pixel, 0).r,
                          texelFetch(depths2, pixel, 0).r, texelFetch(depths3, pixel, 0).r,
                          texelFetch(depths4, pixel, 0).r, texelFetch(depths5, pixel, 0).r,
                          texelFetch(depths6, pixel, 0).r, texelFetch(depths7, pixel, 0).r);
    float end = texelFetch(opaqueDepth, pixel, 0).r;
    for (int i = 0; i < 8; ++i) {
        bool drop = d[i] >= end;
        for (int k = 0; k < i; ++k) drop = drop || d[k] == d[i];
        if (drop) d[i] = -1.0;
    }
    // Odd-even transposition: short, and the same for every pixel.
    for (int pass = 0; pass < 8; ++pass) {
        for (int i = pass & 1; i < 7; i += 2) {
            float low = min(d[i], d[i + 1]);
            d[i] = max(d[i], d[i + 1]);
            d[i + 1] = low;
        }
    }
    sortedFar = vec4(d[0], d[1], d[2], d[3]);
    sortedNear = vec4(d[4], d[5], d[6], d[7]);
}
