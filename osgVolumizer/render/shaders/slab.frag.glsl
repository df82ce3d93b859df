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
uniform float stepDepth;
uniform float maximumSteps;
#ifdef OPAQUE_DEPTH
uniform sampler2D opaqueDepth;
uniform vec2 depthTextureScale; // window -> texture coordinate
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

// Where the ray meets what left its depth in a buffer; far away where nothing did.
float depthOnRay(sampler2D depths)
{
    float windowZ = textureLod(depths, gl_FragCoord.xy * depthTextureScale, 0.0).r;
    return windowZ < 1.0 ? rayAt(windowZ) : 1e30;
}
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
    return clamp(floor((tFar - tNear) / stepDepth + 0.5), 1.0, maximumSteps);
}

#ifdef SHADING
// The colour that the scene's lights make of a classified one.
vec4 lit(vec4 c, vec3 origin, vec3 direction, float t)
{
    if (!(c.a > 0.0)) return c;
    vec3 window = vec3(gl_FragCoord.xy - windowCenter, 1.0);
    vec3 directionEye = rayDirectionEye * window;
    return vec4(shade(c.rgb, origin + t * direction, rayOriginEye * window + t * directionEye,
                      -normalize(directionEye)),
                c.a);
}
#endif

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
    vec3 p = origin + direction * tNear, dp = direction * ((tFar - tNear) / count);
    vec4 texel = voxelAt(p);
    vec4 best = vec4(texel.rgb * texel.a, texel.a);
    for (float i = 1.0; i <= count; i += 1.0) {
        texel = voxelAt(p + i * dp);
        best = BETTER(best, vec4(texel.rgb * texel.a, texel.a));
    }
    return best;
}
#else
// Highest or lowest value on the brick's part of the segment, ends included. Between samples the extreme is looked for about the best
// one, by halving: an interpolant has kinks, which would make plain sampling first order.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    tNear = max(tNear, brick.x);
    tFar = min(tFar, brick.y);
    float count = stepsOf(tNear, tFar);
    vec3 p = origin + direction * tNear, dp = direction * ((tFar - tNear) / count);
    float best = voxelAt(p), at = 0.0;
    for (float i = 1.0; i <= count; i += 1.0) {
        float value = voxelAt(p + i * dp);
        if (BETTER(value, best) != best) at = i;
        best = BETTER(value, best);
    }
    float reach = 0.5;
    for (int i = 0; i < 5; ++i) {
        float before = max(at - reach, 0.0), after = min(at + reach, count);
        float low = voxelAt(p + before * dp), high = voxelAt(p + after * dp);
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
    float count = stepsOf(tNear, tFar);
    float dt = (tFar - tNear) / count;
    float first = max(0.0, ceil((brick.x - tNear) / dt - 0.5));
    float last = min(count, ceil((brick.y - tNear) / dt - 0.5));
    vec3 p = origin + direction * (tNear + 0.5 * dt), dp = direction * dt;
    float sum = 0.0;
    for (float i = first; i < last; i += 1.0) sum += voxelAt(p + i * dp);
    float stepUnits = dt * length(frameToUnits * direction);
    return vec4(sum * stepUnits, max(last - first, 0.0) * stepUnits, 0.0, 0.0);
}

#elif defined(ISOSURFACE)
uniform float isoTexel;

float overIso(vec3 p) { return voxelAt(p) - isoTexel; }

// Root between t0 and t1, where the function has other signs: false position, Illinois variant (Dowell and
// Jarratt, "A modified regula falsi method", BIT 11, 1971).
float rootBetween(vec3 origin, vec3 direction, float t0, float f0, float t1, float f1)
{
    for (int i = 0; i < 8 && f1 != 0.0; ++i) {
        float t = t1 - f1 * (t1 - t0) / (f1 - f0);
        float f = overIso(origin + direction * t);
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
    float count = stepsOf(tNear, tFar);
    float dt = (tFar - tNear) / count;
    float before = overIso(origin + direction * tNear);
    for (float i = 1.0; i <= count; i += 1.0) {
        float t = tNear + i * dt;
        float after = overIso(origin + direction * t);
        if ((before < 0.0) != (after < 0.0)) {
            t = rootBetween(origin, direction, t - dt, before, t, after);
            vec3 color = classifyTexel(isoTexel).rgb;
#ifdef SHADING
            color = lit(vec4(color, 1.0), origin, direction, t).rgb;
#endif
#ifdef PAINTED
            color = painted(color, origin + t * direction);
#endif
            return vec4(color, 1.0);
        }
        before = after;
    }
    return vec4(0.0);
}

#elif defined(PREINTEGRATED)
// Light of the part of [tNear, tFar] in the brick, front to back: premultiplied colour, opacity. The ends of
// steps are where the table is asked, so steps are cut at the brick's ends.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    float dt = (tFar - tNear) / stepsOf(tNear, tFar);
    float unitsPerDepth = length(frameToUnits * direction);
    float t = max(tNear, brick.x), end = min(tFar, brick.y);
    float step = floor((t - tNear) / dt);
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    float entry = tableEntry(origin + t * direction);
    vec4 integral = tableIntegral(entry);
    for (float i = 0.0; i < maximumSteps + 2.0 && t < end; i += 1.0) {
        step += 1.0;
        float next = max(t, min(tNear + step * dt, end));
        float nextEntry = tableEntry(origin + next * direction);
        vec4 nextIntegral = tableIntegral(nextEntry);
        vec4 c = classifyRun(entry, integral, nextEntry, nextIntegral);
#ifdef SHADING
        c = lit(c, origin, direction, 0.5 * (t + next));
#endif
#ifdef PAINTED
        c.rgb = painted(c.rgb, origin + 0.5 * (t + next) * direction);
#endif
        float through = exp2(-c.a * (next - t) * unitsPerDepth);
        color += transmittance * (1.0 - through) * c.rgb;
        transmittance *= through;
        t = next;
        entry = nextEntry;
        integral = nextIntegral;
        if (transmittance < OPAQUE_ENOUGH) break;
    }
    return vec4(color, 1.0 - transmittance);
}
#else
// Light of the brick's steps, front to back: premultiplied colour, opacity.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    float count = stepsOf(tNear, tFar);
    float dt = (tFar - tNear) / count;
    float first = max(0.0, ceil((brick.x - tNear) / dt - 0.5));
    float last = min(count, ceil((brick.y - tNear) / dt - 0.5)); // not one of the brick's
    vec3 dp = direction * dt;
    vec3 p = origin + direction * (tNear + 0.5 * dt);
    float stepUnits = dt * length(frameToUnits * direction);
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    for (float i = first; i < last; i += 1.0) {
        vec4 c = classify(p + i * dp);
#ifdef SHADING
        c = lit(c, origin, direction, tNear + (i + 0.5) * dt);
#endif
#ifdef PAINTED
        c.rgb = painted(c.rgb, p + i * dp);
#endif
        float through = exp2(-c.a * stepUnits);
        color += transmittance * (1.0 - through) * c.rgb;
        transmittance *= through;
        if (transmittance < OPAQUE_ENOUGH) break;
    }
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
    tFar = min(tFar, depthOnRay(opaqueDepth));
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
#ifdef SLOTS
    compositeSurfaces(origin, direction, tNear, tFar, brick);
#else
    if (!(max(tNear, brick.x) < min(tFar, brick.y))) discard;
    fragColor = light(origin, direction, tNear, tFar, brick);
#endif
}
