// One segment: the part of the pixel's ray in the volume's region and the slab, and in front of the opaque
// scene. Midpoint rule with equal steps and exact ends, so second order in the step whatever cuts
// the segment. A brick takes the steps whose midpoints lie in its clip box: bricks add no ends, and however many
// there are, all samples stay where they are.

// What is left of the light when marching stops: the most that this may change any pixel.
#define OPAQUE_ENOUGH 3e-5

flat in vec2 slab; // nearest and farthest depth, from the reference depth
#ifdef SLOTS
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
#ifdef LAYER_DEPTH
uniform sampler2D layerDepth; // of the surfaces that split this segment
uniform bool inFrontOfLayer;  // which part is drawn
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
    float windowZ = texelFetch(opaqueDepth, ivec2(gl_FragCoord.xy), 0).r;
    float z = (windowZ - depthRange.x) * depthRange.y;
    return z < 1.0 ? rayAt(max(z, 0.0)) : 1e30;
}

#ifdef LAYER_DEPTH
// Where the ray meets what left its depth in a buffer; far away where nothing did.
float depthOnRay(sampler2D depths)
{
    float windowZ = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
    return windowZ < 1.0 ? rayAt(windowZ) : 1e30;
}
#endif
#endif

#ifdef RANKED
float sortedDepth(int i)
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
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

// In the loops below the place is advanced by the last statement, and what ends them early is in the condition:
// either saves a third of the time on llvmpipe. Steps that meet nothing are left out whole.

#if defined(MAXIMUM) || defined(MINIMUM)
#ifdef MAXIMUM
#define BETTER(a, b) max(a, b)
#else
#define BETTER(a, b) min(a, b)
#endif

#ifdef RGBA
// Highest or lowest premultiplied components on the brick's part of the segment, ends included.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    tNear = max(tNear, brick.x);
    tFar = min(tFar, brick.y);
    float count = stepsOf(tNear, tFar);
    vec3 place = placeOf(origin + direction * tNear);
    vec3 rate = VOXEL_LENGTH * direction * ((tFar - tNear) / count);
    vec4 texel = voxelAt(place);
    vec4 best = vec4(texel.rgb * texel.a, texel.a);
    place += rate;
    for (int i = int(count); i > 0; --i) {
        texel = voxelAt(place);
        best = BETTER(best, vec4(texel.rgb * texel.a, texel.a));
        COUNT_SAMPLE
        place += rate;
    }
    return best;
}
#else
// Highest or lowest value on the brick's part of the segment, ends included. Between samples the extreme is looked
// for about the best one, by halving: an interpolant has kinks, which would make plain sampling first order.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    tNear = max(tNear, brick.x);
    tFar = min(tFar, brick.y);
    float count = stepsOf(tNear, tFar);
    vec3 start = placeOf(origin + direction * tNear);
    vec3 rate = VOXEL_LENGTH * direction * ((tFar - tNear) / count);
    vec3 place = start + rate;
    float best = voxelAt(start), at = 0.0;
    int steps = int(count);
    for (int i = 1; i <= steps; ++i) {
        float value = voxelAt(place);
        at = BETTER(value, best) != best ? float(i) : at;
        best = BETTER(value, best);
        COUNT_SAMPLE
        place += rate;
    }
    float reach = 0.5;
    for (int i = 0; i < 5; ++i) {
        float before = max(at - reach, 0.0), after = min(at + reach, count);
        float low = voxelAt(start + before * rate), high = voxelAt(start + after * rate);
        float better = BETTER(low, high);
        if (BETTER(better, best) != best) at = better == low ? before : after;
        best = BETTER(better, best);
        reach *= 0.5;
    }
    return vec4(best);
}
#endif

#elif defined(AVERAGE) || defined(SUM)
// Integral of the value over the brick's steps, and of 1.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    float count = stepsOf(tNear, tFar), dt = (tFar - tNear) / count;
    float first = max(0.0, ceil((brick.x - tNear) / dt - 0.5));
    int steps = int(min(count, ceil((brick.y - tNear) / dt - 0.5)) - first);
    vec3 place = placeOf(origin + direction * (tNear + (first + 0.5) * dt));
    vec3 rate = VOXEL_LENGTH * direction * dt;
    float sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        sum += voxelAt(place);
        COUNT_SAMPLE
        place += rate;
    }
    float stepUnits = dt * length(frameToUnits * direction);
    return vec4(sum * stepUnits, float(max(steps, 0)) * stepUnits, 0.0, 0.0);
}

#elif defined(ISOSURFACE)
uniform float isoTexel;

float overIso(vec3 place) { return voxelAt(place) - isoTexel; }

// Root between t0 and t1, where the function has other signs: false position, Illinois variant (Dowell and
// Jarratt, "A modified regula falsi method", BIT 11, 1971).
float rootBetween(vec3 start, vec3 rate, float t0, float f0, float t1, float f1)
{
    for (int i = 0; i < 8 && f1 != 0.0; ++i) {
        float t = t1 - f1 * (t1 - t0) / (f1 - f0);
        float f = overIso(start + t * rate);
        if (f * f1 < 0.0) {
            t0 = t1;
            f0 = f1;
        } else {
            f0 *= 0.5;
        }
        t1 = t;
        f1 = f;
    }
    return t1;
}

// The first crossing of the iso-value, opaque.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    tNear = max(tNear, brick.x);
    tFar = min(tFar, brick.y);
    float count = stepsOf(tNear, tFar), dt = (tFar - tNear) / count;
    vec3 start = placeOf(origin + direction * tNear), rate = VOXEL_LENGTH * direction * dt;
    float i = 0.0, last = count;
#ifdef SKIPPING
    vec2 shown = occupiedPart(origin, direction, tNear, tFar);
    i = max(i, floor((shown.x - tNear) / dt));
    last = min(last, ceil((shown.y - tNear) / dt));
#endif
    vec3 place = start + i * rate;
    float before = overIso(place), after = before;
    place += rate;
    for (; i < last && (before < 0.0) == (after < 0.0); i += 1.0) {
        before = after;
        after = overIso(place);
        COUNT_SAMPLE
        place += rate;
    }
    if ((before < 0.0) == (after < 0.0)) return vec4(0.0);
    float at = rootBetween(start, rate, i - 1.0, before, i, after);
    vec4 color = vec4(classifyTexel(isoTexel).rgb, 1.0);
#ifdef SHADING
    color = lit(color, start + at * rate, tNear + at * dt);
#endif
#ifdef PAINTED
    color.rgb = painted(color.rgb, origin + (tNear + at * dt) * direction);
#endif
    return color;
}

#elif defined(PREINTEGRATED)
uniform bool homogeneous;           // all of the brick has one value
uniform vec3 brickMin, brickMax; // what the brick's texture has values for

// Adds the piece of the ray from the last place to this one, where the depth is t.
void addRun(vec3 origin, vec3 direction, float t, vec3 place, float depth, float unitsPerDepth,
            inout float entry, inout vec4 integral, inout vec4 light)
{
    float nextEntry = tableEntryAfter(entry, place);
    vec4 nextIntegral = tableIntegral(nextEntry);
    vec4 c = classifyRun(entry, integral, nextEntry, nextIntegral);
#ifdef SHADING
    c = lit(c, place - 0.5 * depth * VOXEL_LENGTH * direction, t - 0.5 * depth);
#endif
#ifdef PAINTED
    c.rgb = painted(c.rgb, origin + (t - 0.5 * depth) * direction);
#endif
    COUNT_SAMPLE
    float next = light.a * exp2(-c.a * (depth * unitsPerDepth));
    light = vec4(light.rgb + (light.a - next) * c.rgb, next);
    entry = nextEntry;
    integral = nextIntegral;
}

// Light of the steps that reach into what the brick shows, front to back: premultiplied colour, opacity. The ends
// of steps are where the table is asked, so steps are cut at the brick's ends.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 shown)
{
    float count = stepsOf(tNear, tFar), dt = (tFar - tNear) / count;
    vec2 brick = boxSegment(brickMin, brickMax, origin, direction);
    float start = max(tNear, brick.x), stop = min(tFar, brick.y);
#ifdef SKIPPING
    shown = occupiedPart(origin, direction, max(start, shown.x), min(stop, shown.y));
#endif
    float i = max(0.0, floor((shown.x - tNear) / dt));
    float last = min(count, ceil((shown.y - tNear) / dt));
    float unitsPerDepth = length(frameToUnits * direction);
    vec3 rate = VOXEL_LENGTH * direction;
    vec4 light = vec4(0.0, 0.0, 0.0, 1.0); // colour, transmittance
    if (homogeneous && i < last) {
        // One step from end to end.
        float end = min(stop, tNear + last * dt);
        tNear = max(start, tNear + i * dt);
        dt = end - tNear;
        i = 0.0;
        last = 1.0;
    }
    float t = max(start, tNear + i * dt);
    vec3 place = placeOf(origin + t * direction);
    float entry = tableEntry(place);
    vec4 integral = tableIntegral(entry);
    float depth = min(stop, tNear + (i + 1.0) * dt) - t; // of the first step, which may be cut
    place += rate * depth;
    t += depth;
    for (int steps = int(last - i); steps > 0 && light.a > OPAQUE_ENOUGH; --steps) {
        addRun(origin, direction, t, place, depth, unitsPerDepth, entry, integral, light);
        depth = min(dt, stop - t); // of the last one, which may be cut too
        t += depth;
        place += rate * depth;
    }
    return vec4(light.rgb, 1.0 - light.a);
}

#else
uniform bool homogeneous; // all of the brick has one value

// Light of the brick's steps, front to back: premultiplied colour, opacity.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    float count = stepsOf(tNear, tFar), dt = (tFar - tNear) / count;
#ifdef SKIPPING
    brick = occupiedPart(origin, direction, max(tNear, brick.x), min(tFar, brick.y));
#endif
    float perDepth = count / (tFar - tNear);
    float i = max(0.0, ceil((brick.x - tNear) * perDepth - 0.5));
    float last = min(count, ceil((brick.y - tNear) * perDepth - 0.5)); // not one of the brick's
    vec3 rate = VOXEL_LENGTH * direction * dt;
    float units = dt * length(frameToUnits * direction);
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    if (homogeneous && i < last) {
        units *= last - i;
        last = i + 1.0;
    }
    float t = tNear + (i + 0.5) * dt;
    vec3 place = placeOf(origin + t * direction);
    int steps = int(last - i);
    if (steps > 0) do {
        vec4 c = classify(place);
#ifdef SHADING
        c = lit(c, place, t);
#endif
#ifdef PAINTED
        c.rgb = painted(c.rgb, origin + t * direction);
#endif
        t += dt;
        COUNT_SAMPLE
        float next = transmittance * exp2(-c.a * units);
        color += (transmittance - next) * c.rgb;
        transmittance = next;
        place += rate;
    } while (--steps > 0 && transmittance > OPAQUE_ENOUGH);
    return vec4(color, 1.0 - transmittance);
}
#endif

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
    ivec2 pixel = ivec2(gl_FragCoord.xy);
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
    fragThrough = vec4(through);
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
#ifdef LAYER_DEPTH
    float tLayer = depthOnRay(layerDepth);
    if (!inFrontOfLayer && tLayer < 1e29)
        tNear = max(tNear, tLayer);
    else if (inFrontOfLayer)
        tFar = tLayer < 1e29 ? min(tFar, tLayer) : tNear;
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
