// A volume of tetrahedra, or a brick of it, that is marched by itself: tetrahedron by tetrahedron.

vec3 origin, direction; // the pixel's ray
vec2 region;            // the part of it in the volume's region, in t

void findPart(float tNear, float tFar, inout vec2 all)
{
    pixelRay(origin, direction);
    region = regionSegment(origin, direction);
    vec2 part = vec2(max(region.x, tNear), min(region.y, tFar));
    if (part.x < part.y) all = vec2(min(all.x, part.x), max(all.y, part.y));
#ifdef SHADING
    findEyeRay();
#endif
    beginWalk(origin, direction);
}

#ifdef EXACT_CELLS
// Light with that of the scene, and fog, about one depth.
vec4 inScene(vec4 light, float t)
{
#if defined(SHADING) || defined(FOG)
    vec4 c = vec4(light.rgb / max(light.a, 1e-30), light.a);
#ifdef SHADING
    c = lit(c, vec3(0.0), t);
#endif
    return vec4(fogged(c.rgb, t) * c.a, c.a);
#else
    return light;
#endif
}
#endif

#ifdef EXACT_CELLS
#define ENOUGH(light) (light.a >= 1.0 - EXACT_ENOUGH)
#else
#define ENOUGH(light) RAY_DONE(light)
#endif

// Of the tetrahedron that is walked through, between two depths.
vec4 lightOfPart(float tNear, float tFar)
{
    float length1 = max(left.depth - entered.depth, 1e-30);
#ifdef EXACT_CELLS
    vec2 f = (vec2(tNear, tFar) - entered.depth) / length1;
    float units = (tFar - tNear) * length(frameToUnits * direction);
    units *= keptAbout(origin, direction, 0.5 * (tNear + tFar), tFar - tNear);
    vec4 sum = vec4(0.0, 0.0, 0.0, 1.0);
#ifdef SCALARS
    addScalars(mix(entered.scalar, left.scalar, f.x), mix(entered.scalar, left.scalar, f.y), units, sum);
#else
    addLinear(mix(entered.color, left.color, f.x), mix(entered.color, left.color, f.y), units, sum);
#endif
    return inScene(vec4(sum.rgb, 1.0 - sum.a), 0.5 * (tNear + tFar));
#else
#ifdef PLACES
    rayVoxelRate = (left.place - entered.place) / length1;
    rayVoxelOrigin = entered.place - entered.depth * rayVoxelRate;
#elif defined(SCALARS)
    rayVoxelRate = vec3((left.scalar - entered.scalar) / length1, 0.0, 0.0);
    rayVoxelOrigin = vec3(entered.scalar, 0.0, 0.0) - entered.depth * rayVoxelRate;
#endif
#ifdef VOXELS
    vec2 shown = boxSegment(clipMin, clipMax, VOXEL_RAY(origin, direction));
    if (!(max(tNear, shown.x) < min(tFar, shown.y))) return EMPTY_RAY;
#else
    vec2 shown = vec2(tNear, tFar);
#endif
    return march(origin, direction, tNear, tFar, shown);
#endif
}

// Light of a part of the ray, front to back, or what the ray function gathers of it. Parts come near to far, so the walk
// goes on where it was.
vec4 light(float tNear, float tFar)
{
    tNear = max(tNear, region.x);
    tFar = min(tFar, region.y);
    vec4 sum = EMPTY_RAY;
    if (!(tNear < tFar)) return sum;
    for (;;) {
        float begin = max(partBegin, tNear), end = min(left.depth, tFar);
        if (hasPart && begin < end) sum = JOIN_RAY(sum, lightOfPart(begin, end));
        if (left.depth >= tFar || ENOUGH(sum) || !nextPart()) break;
    }
    return sum;
}
