// One segment: the part of the pixel's ray in the volume's region and the slab, and in front of the opaque
// scene. Midpoint rule with equal steps and exact ends, so second order in the step whatever cuts
// the segment. A brick takes the steps whose midpoints lie in its clip box: bricks add no ends, and however many
// there are, all samples stay where they are.

#ifdef COMPUTE
uniform vec2 slabEnds; // nearest and farthest depth, from the reference depth
#define slab slabEnds
layout(TARGET_FORMAT, binding = TARGET_UNIT) uniform image2D target;
vec4 fragColor;
#ifdef SLOTS
vec4 fragThrough;
#endif
#else
flat in vec2 slab;
#if defined(SLOTS) && !defined(COARSE)
layout(location = 0, index = 0) out vec4 fragColor;
layout(location = 0, index = 1) out vec4 fragThrough; // what is left of the light behind
#else
out vec4 fragColor;
#endif
#endif

#ifdef OPAQUE_DEPTH
uniform sampler2D opaqueDepth;
uniform int opaqueRule;   // 0: nothing to end at; 1: segments end there; 2: they begin there
uniform vec2 depthRange;  // nearest window depth of the volume, and 1 over the length of its range
uniform vec3 clipZOrigin, clipZDirection, clipWOrigin, clipWDirection; // times (dx, dy, 1)
#endif
#ifdef SPLIT_DEPTH
uniform sampler2D splitDepth; // of the surfaces that split this segment
uniform bool inFrontOfSplit;  // which part is drawn
#endif

#ifdef RANKED
uniform sampler2D sortedFar, sortedNear; // window depths of the pixel's surfaces, far to near; -1: no more
uniform int rank;                        // of the surface that ends the segment at its near end
#endif

#ifdef SLOTS
uniform sampler2DArray sortedSlots; // window depths of the pixel's surfaces, near to far, then their slots
uniform sampler2DArray slotColors;
uniform vec2 surfaceWeights; // 1: colour, alpha is yet to be weighted by alpha
#endif

#ifdef OPAQUE_DEPTH
// Where the ray has a window depth.
float rayAt(float windowZ)
{
    vec3 window = vec3(windowPlace() - windowCenter, 1.0);
    float z = 2.0 * windowZ - 1.0;
    return (z * dot(clipWOrigin, window) - dot(clipZOrigin, window)) /
           (dot(clipZDirection, window) - z * dot(clipWDirection, window));
}

// Where the ray meets the opaque scene; far away where it does not. Depth ranges as of osg::Depth.
float opaqueOnRay()
{
    float windowZ = texelFetch(opaqueDepth, windowPixel(), 0).r;
    float z = (windowZ - depthRange.x) * depthRange.y;
    return z < 1.0 ? rayAt(max(z, 0.0)) : 1e30;
}

#ifdef SPLIT_DEPTH
// Where the ray meets what left its depth in a buffer; far away where nothing did.
float depthOnRay(sampler2D depths)
{
    float windowZ = texelFetch(depths, windowPixel(), 0).r;
    return windowZ < 1.0 ? rayAt(windowZ) : 1e30;
}
#endif
#endif

#ifdef RANKED
float sortedDepth(int i)
{
    ivec2 pixel = windowPixel();
    if (i < 4) return texelFetch(sortedFar, pixel, 0)[max(i, 0)];
    return i < 8 ? texelFetch(sortedNear, pixel, 0)[i - 4] : -1.0;
}
#endif

#ifdef SLOTS
// The pixel's surfaces, near to far, and the volume between them.
void compositeSurfaces(float enter, float leave)
{
    ivec2 pixel = windowPixel();
    fragColor = vec4(0.0);
    float through = 1.0, t = enter;
    vec4 depths;
    for (int i = 0; i <= SLOTS && through > opaqueEnough; ++i) {
        if (i < SLOTS && (i & 3) == 0) depths = texelFetch(sortedSlots, ivec3(pixel, i >> 2), 0);
        float depth = i < SLOTS ? depths[i & 3] : 2.0;
        float end = depth <= 1.0 ? min(rayAt(depth), leave) : leave;
        if (t < end) {
            vec4 c = lightBetween(t, end);
            fragColor += through * c;
            through *= 1.0 - c.a;
            t = end;
        }
        if (depth > 1.0) break;
        int four = int(texelFetch(sortedSlots, ivec3(pixel, SLOTS / 4 + (i >> 4)), 0)[(i >> 2) & 3]);
        vec4 c = texelFetch(slotColors, ivec3(pixel, (four >> (5 * (i & 3))) & 31), 0);
        fragColor += through * c * mix(vec2(1.0), vec2(c.a), surfaceWeights).xxxy;
        through *= 1.0 - c.a;
    }
#ifdef COARSE
    fragColor.a = 1.0 - through;
#else
    fragThrough = vec4(through);
#endif
}
#endif

void main()
{
#ifdef COMPUTE
    if (any(greaterThanEqual(vec2(gl_GlobalInvocationID.xy), area.zw))) return;
#endif
    float tNear = slab.x, tFar = slab.y;
#ifdef OPAQUE_DEPTH
    if (opaqueRule == 1) tFar = min(tFar, opaqueOnRay());
    if (opaqueRule == 2) tNear = max(tNear, opaqueOnRay());
#endif
#ifdef RANKED
    float nearer = sortedDepth(rank), farther = sortedDepth(rank - 1);
    if (rank > 0) {
        if (farther < 0.0) LEAVE;
        tFar = min(tFar, rayAt(farther));
    }
    if (nearer >= 0.0) tNear = max(tNear, rayAt(nearer));
#endif
    vec2 shown = findParts(tNear, tFar);
#ifdef SPLIT_DEPTH
    float tSplit = depthOnRay(splitDepth);
    if (!inFrontOfSplit && tSplit < 1e29)
        tNear = max(tNear, tSplit);
    else if (inFrontOfSplit)
        tFar = tSplit < 1e29 ? min(tFar, tSplit) : tNear;
#endif
    float enter = max(tNear, shown.x), leave = min(tFar, shown.y);
#ifdef SLOTS
    compositeSurfaces(enter, leave);
#else
    if (!(enter < leave)) LEAVE;
    fragColor = lightBetween(tNear, tFar);
#endif
#ifdef COUNT_SAMPLES
    fragColor = vec4(sampleCount, 0.0, 0.0, 0.0);
#endif
#ifdef COMPUTE
    ivec2 pixel = ivec2(windowPlace());
#ifdef SLOTS
    vec4 through = fragThrough;
#else
    float through = 1.0 - fragColor.a;
#endif
    imageStore(target, pixel, fragColor + through * imageLoad(target, pixel));
#endif
}
