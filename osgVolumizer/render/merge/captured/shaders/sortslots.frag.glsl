// A pixel's captured fragments, near to far: depths four a target, 2 where there are no more; then the numbers
// of their slots, sixteen a target and four a component. Those behind the opaque scene are left out.

uniform sampler2DArray slotDepths;
uniform sampler2D opaqueDepth;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float end = texelFetch(opaqueDepth, pixel, 0).r;
    float d[SLOTS], id[SLOTS];
    for (int i = 0; i < SLOTS; ++i) {
        d[i] = texelFetch(slotDepths, ivec3(pixel, i), 0).r;
        if (d[i] >= end) d[i] = 2.0;
        id[i] = float(i);
    }
    sortAndStore(d, id);
}
