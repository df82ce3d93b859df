// A volume, or a brick of it, that is marched by itself.

vec3 origin, direction; // the pixel's ray
vec2 region;            // the part of it in the volume's region, in t
vec2 shown;             // the part in the brick

void findPart(float tNear, float tFar, inout vec2 all)
{
    pixelRay(origin, direction);
    region = regionSegment(origin, direction);
    shown = boxSegment(clipMin, clipMax, origin, direction);
    vec2 part = vec2(max(max(region.x, shown.x), tNear), min(min(region.y, shown.y), tFar));
    if (part.x < part.y) all = vec2(min(all.x, part.x), max(all.y, part.y));
#ifdef SHADING
    findEyeRay();
#endif
}

// Light of a part of the ray. Colours jump where paint begins, so its parts end there.
vec4 light(float tNear, float tFar)
{
    tNear = max(tNear, region.x);
    tFar = min(tFar, region.y);
    if (!(max(tNear, shown.x) < min(tFar, shown.y))) return vec4(0.0);
#ifdef PAINTED
    vec4 sum = vec4(0.0);
    for (float t = tNear; t < tFar && sum.a < 1.0 - opaqueEnough;) {
        float next = nextCut(origin, direction, t, tFar);
        sum += (1.0 - sum.a) * march(origin, direction, t, next, shown);
        t = next;
    }
    return sum;
#else
    return march(origin, direction, tNear, tFar, shown);
#endif
}
