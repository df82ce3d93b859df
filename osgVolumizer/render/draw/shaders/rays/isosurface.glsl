// The first place where the interpolated value crosses the iso-value, opaque. Slabs only.

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
