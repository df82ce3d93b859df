// The first place where the interpolated value crosses the iso-value, opaque. Slabs only.

#define EMPTY_RAY vec4(0.0)
#define JOIN_RAY(front, behind) (front + (1.0 - front.a) * behind)
#define RAY_DONE(light) (light.a > 0.0)

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

#ifdef TETRAHEDRA
float partEnd = -1e30; // of the last part, and what it ended with: on a face the next one may differ by a rounding, or jump
bool partBelow;
#endif

// Where the ray first crosses the iso-value in a part of [tNear, tFar]; far away where it does not.
float crossing(vec3 origin, vec3 direction, float tNear, float tFar, vec2 part)
{
    tNear = max(tNear, part.x);
    tFar = min(tFar, part.y);
    float count = stepsOf(direction, tNear, tFar), dt = (tFar - tNear) / count;
    vec3 start = placeOnRay(origin, direction, tNear), rate = VOXEL_RATE(direction) * dt;
    float i = 0.0, last = count;
#ifdef SKIPPING
    vec2 occupied = occupiedPart(VOXEL_RAY(origin, direction), tNear, tFar);
    i = max(i, floor((occupied.x - tNear) / dt));
    last = min(last, ceil((occupied.y - tNear) / dt));
#endif
    vec3 place = start + i * rate;
    float before = overIso(place), after = before;
#ifdef TETRAHEDRA
    bool jumps = tNear == partEnd && partBelow != (overIso(start) < 0.0);
    partEnd = tFar;
    partBelow = overIso(start + count * rate) < 0.0;
    if (jumps && isKept(cutPoint(origin, direction, tNear))) return tNear;
#endif
    place += rate;
#ifdef CUT
    for (;;) {
#endif
    for (; i < last && (before < 0.0) == (after < 0.0); i += 1.0) {
        before = after;
        after = overIso(place);
        COUNT_SAMPLE
        place += rate;
    }
    if ((before < 0.0) == (after < 0.0)) return 1e30;
    float t = tNear + rootBetween(start, rate, i - 1.0, before, i, after) * dt;
#ifdef CUT
    if (!isKept(cutPoint(origin, direction, t))) { // on to the next one
        before = after;
        continue;
    }
    return t;
    }
#else
    return t;
#endif
}

vec3 colorAt(vec3 origin, vec3 direction, float t)
{
    vec4 color = vec4(classifyTexel(isoTexel).rgb, 1.0);
#ifdef SHADING
    color = lit(color, placeOnRay(origin, direction, t), t);
#endif
#ifdef PAINTED
    color.rgb = painted(color.rgb, origin + t * direction);
#endif
    return fogged(color.rgb, t);
}

#ifdef MEMBER
float surfaceDepth;

void addLight(float t, float dt, inout vec4 sum) {}
float surfaceOnRay()
{
    surfaceDepth = 1e30;
    if (shown.x < shown.y) surfaceDepth = crossing(memberOrigin, memberDirection, shown.x, shown.y, shown);
    return surfaceDepth;
}
void addSurface(float t, inout vec3 color, inout float through)
{
    if (t != surfaceDepth) return;
    color += through * colorAt(memberOrigin, memberDirection, t);
    through = 0.0;
}
#else
// The first crossing of the iso-value, opaque.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    float t = crossing(origin, direction, tNear, tFar, brick);
    return t < 1e29 ? vec4(colorAt(origin, direction, t), 1.0) : vec4(0.0);
}
#endif
