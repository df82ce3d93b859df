// The highest or lowest value, by BETTER; where nothing is kept it is WORST.

#define EMPTY_RAY vec4(WORST)
#define JOIN_RAY(front, behind) BETTER(front, behind)
#define RAY_DONE(light) false

#if defined(SLAB)
#ifdef RGBA
// Highest or lowest premultiplied components on the brick's part of the segment, ends included.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    tNear = max(tNear, brick.x);
    tFar = min(tFar, brick.y);
    float count = stepsOf(direction, tNear, tFar);
    vec3 place = placeOnRay(origin, direction, tNear);
    vec3 rate = VOXEL_RATE(direction) * ((tFar - tNear) / count);
    float dt = (tFar - tNear) / count;
    vec4 best = vec4(WORST);
    for (int i = 0; i <= int(count); ++i) {
        vec4 texel = voxelAt(place);
        if (isKept(cutPoint(origin, direction, tNear + float(i) * dt)))
            best = BETTER(best, vec4(texel.rgb * texel.a, texel.a));
        COUNT_SAMPLE
        place += rate;
    }
    return best;
}
#else
#ifdef CUT
// The value at a step of the ray, if it is kept.
float valueAt(vec3 place, vec3 point) { return isKept(point) ? voxelAt(place) : WORST; }
#else
#define valueAt(place, point) voxelAt(place)
#endif

// Highest or lowest value on the brick's part of the segment, ends included. Between samples the extreme is looked
// for about the best one, by halving: an interpolant has kinks, which would make plain sampling first order.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    tNear = max(tNear, brick.x);
    tFar = min(tFar, brick.y);
    float count = stepsOf(direction, tNear, tFar);
    vec3 start = placeOnRay(origin, direction, tNear);
    vec3 rate = VOXEL_RATE(direction) * ((tFar - tNear) / count);
    vec3 place = start + rate;
    vec3 first = cutPoint(origin, direction, tNear);
    vec3 pointRate = (cutPoint(origin, direction, tFar) - first) / count;
    float best = valueAt(start, first), at = 0.0;
    int steps = int(count);
    for (int i = 1; i <= steps; ++i) {
        float value = valueAt(place, first + float(i) * pointRate);
        at = BETTER(value, best) != best ? float(i) : at;
        best = BETTER(value, best);
        COUNT_SAMPLE
        place += rate;
    }
    float reach = 0.5;
    for (int i = 0; i < 5; ++i) {
        float before = max(at - reach, 0.0), after = min(at + reach, count);
        float low = valueAt(start + before * rate, first + before * pointRate);
        float high = valueAt(start + after * rate, first + after * pointRate);
        float better = BETTER(low, high);
        if (BETTER(better, best) != best) at = better == low ? before : after;
        best = BETTER(better, best);
        reach *= 0.5;
    }
    return vec4(best);
}
#endif

#elif defined(SLICE)
vec4 slice(vec3 place, vec3 direction, float thickness)
{
    if (kept < 0.5) discard;
#ifdef RGBA
    vec4 texel = voxelAt(place);
    return vec4(texel.rgb * texel.a, texel.a);
#else
    return vec4(voxelAt(place));
#endif
}

#elif defined(RESOLVE) && !defined(RGBA)
float gatheredEntry(vec4 ray) { return ray.x * valueToEntry.x + valueToEntry.y; }
#endif
