// One segment: the part of the pixel's ray in the volume's region and the slab, and in front of the opaque
// scene. Midpoint rule with equal steps and exact ends, so second order in the step whatever cuts
// the segment. A brick takes the steps whose midpoints lie in its clip box: bricks add no ends, and however many
// there are, all samples stay where they are.

// What is left of the light when marching stops: the most that this may change any pixel.
#define OPAQUE_ENOUGH 3e-5

flat in vec2 slab; // nearest and farthest depth, from the reference depth
#if defined(SLOTS) && !defined(COARSE)
layout(location = 0, index = 0) out vec4 fragColor;
layout(location = 0, index = 1) out vec4 fragThrough; // what is left of the light behind
#else
out vec4 fragColor;
#endif

uniform vec3 regionMin, regionMax; // of the whole volume
uniform vec3 clipMin, clipMax;     // of the brick
#if PLANES > 0
uniform vec4 planes[PLANES];
#endif
uniform float stepsPerDepth;
uniform float maximumSteps;
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
    vec3 window = vec3(gl_FragCoord.xy - windowCenter, 1.0);
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

// Number of steps for a segment, such that their mean over all segments is the period.
float stepsOf(float tNear, float tFar)
{
    return clamp(floor((tFar - tNear) * stepsPerDepth + 0.5), 1.0, maximumSteps);
}

#ifdef SHADING
vec3 originEye, directionEye, towardsEye; // the ray in the eye frame

// The colour that the scene's lights make of a classified one.
vec4 lit(vec4 c, vec3 place, float t)
{
    if (!(c.a > 0.0)) return c;
    return vec4(shade(c.rgb, place, originEye + t * directionEye, towardsEye), c.a);
}
#endif

#ifdef COUNT_SAMPLES
float sampleCount = 0.0;
#define COUNT_SAMPLE sampleCount += 1.0;
#else
#define COUNT_SAMPLE
#endif

// What the ray function makes of the part of the segment in the brick (both in t). In its loops the place is advanced
// by the last statement, and what ends them early is in the condition: either saves a third of the time on llvmpipe.
// Steps that meet nothing are left out whole.
// vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
#pragma ray_function

// Light of a segment. Colours jump where paint begins, so its parts end there.
vec4 light(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
#ifdef PAINTED
    vec4 sum = vec4(0.0);
    for (float t = tNear; t < tFar && sum.a < 1.0 - OPAQUE_ENOUGH;) {
        float next = nextCut(origin, direction, t, tFar);
        sum += (1.0 - sum.a) * march(origin, direction, t, next, brick);
        t = next;
    }
    return sum;
#else
    return march(origin, direction, tNear, tFar, brick);
#endif
}

#ifdef SLOTS
// The pixel's surfaces, near to far, and the volume between them.
void compositeSurfaces(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    ivec2 pixel = windowPixel();
    float enter = max(tNear, brick.x), leave = min(tFar, brick.y);
    fragColor = vec4(0.0);
    float through = 1.0, t = enter;
    vec4 depths;
    for (int i = 0; i <= SLOTS && through > OPAQUE_ENOUGH; ++i) {
        if (i < SLOTS && (i & 3) == 0) depths = texelFetch(sortedSlots, ivec3(pixel, i >> 2), 0);
        float depth = i < SLOTS ? depths[i & 3] : 2.0;
        float end = depth <= 1.0 ? min(rayAt(depth), leave) : leave;
        if (t < end) {
            vec4 c = light(origin, direction, t, end, brick);
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
    vec3 origin, direction;
    pixelRay(origin, direction);
    vec2 region = boxSegment(regionMin, regionMax, origin, direction);
    vec2 brick = boxSegment(clipMin, clipMax, origin, direction);
    float tNear = max(region.x, slab.x);
    float tFar = min(region.y, slab.y);
#if PLANES > 0
    for (int i = 0; i < PLANES; ++i) clipToPlane(planes[i], origin, direction, tNear, tFar);
#endif
#ifdef OPAQUE_DEPTH
    if (opaqueRule == 1) tFar = min(tFar, opaqueOnRay());
    if (opaqueRule == 2) tNear = max(tNear, opaqueOnRay());
#endif
#ifdef SPLIT_DEPTH
    float tSplit = depthOnRay(splitDepth);
    if (!inFrontOfSplit && tSplit < 1e29)
        tNear = max(tNear, tSplit);
    else if (inFrontOfSplit)
        tFar = tSplit < 1e29 ? min(tFar, tSplit) : tNear;
#endif
#ifdef RANKED
    float nearer = sortedDepth(rank), farther = sortedDepth(rank - 1);
    if (rank > 0) {
        if (farther < 0.0) discard;
        tFar = min(tFar, rayAt(farther));
    }
    if (nearer >= 0.0) tNear = max(tNear, rayAt(nearer));
#endif
#ifdef SHADING
    vec3 window = vec3(gl_FragCoord.xy - windowCenter, 1.0);
    originEye = rayOriginEye * window;
    directionEye = rayDirectionEye * window;
    towardsEye = -normalize(directionEye);
#endif
#ifdef SLOTS
    compositeSurfaces(origin, direction, tNear, tFar, brick);
#else
    if (!(max(tNear, brick.x) < min(tFar, brick.y))) discard;
    fragColor = light(origin, direction, tNear, tFar, brick);
#endif
#ifdef COUNT_SAMPLES
    fragColor = vec4(sampleCount, 0.0, 0.0, 0.0);
#endif
}
