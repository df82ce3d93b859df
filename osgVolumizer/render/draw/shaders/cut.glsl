// What a VolumeCut leaves of a volume: see core/cutting/Cut.h.

// A point of the ray in the frame of cuts before cutFromVolume: of deformed voxels their own.
#ifdef PLACES
vec3 cutPoint(vec3 origin, vec3 direction, float t) { return rayVoxelOrigin + t * rayVoxelRate; }
#else
vec3 cutPoint(vec3 origin, vec3 direction, float t) { return origin + t * direction; }
#endif

#ifdef CUT
uniform mat4 cutFromVolume;
uniform int cutPlaneCount, cutShapeCount;
uniform vec4 cutPlanes[8];
uniform vec4 cutCenters[8];   // and radius
uniform vec4 cutHalfSizes[8]; // and 1 where the inside is kept, else -1
uniform float cutSharpness;   // 1 over the width of fading; 0: sharp
#ifdef CUT_FIELD
uniform sampler3D cutField;
uniform vec3 cutFieldScale, cutFieldOffset;
#endif

// Signed distance, positive in what is kept.
float cutDistance(vec3 point)
{
    vec3 p = (cutFromVolume * vec4(point, 1.0)).xyz;
#ifdef CUT_FIELD
    float d = texture(cutField, p * cutFieldScale + cutFieldOffset).r;
#else
    float d = 1e30;
#endif
    for (int i = 0; i < cutPlaneCount; ++i) d = min(d, dot(cutPlanes[i], vec4(p, 1.0)));
    for (int i = 0; i < cutShapeCount; ++i) {
        vec3 q = abs(p - cutCenters[i].xyz) - cutHalfSizes[i].xyz;
        float outside = length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0) - cutCenters[i].w;
        d = min(d, -cutHalfSizes[i].w * outside);
    }
    return d;
}

// What is left of a piece of a ray, by the distances at its ends.
float keptShare(float before, float after)
{
    if (cutSharpness > 0.0) return clamp(0.5 * (before + after) * cutSharpness + 0.5, 0.0, 1.0);
    float low = min(before, after), high = max(before, after);
    return low >= 0.0 ? 1.0 : high > 0.0 ? high / (high - low) : 0.0;
}

float keptAbout(vec3 origin, vec3 direction, float t, float dt)
{
    return keptShare(cutDistance(cutPoint(origin, direction, t - 0.5 * dt)),
                     cutDistance(cutPoint(origin, direction, t + 0.5 * dt)));
}

// Of pieces one after another.
float cutBefore; // at the end of the last one
void beginCut(vec3 point) { cutBefore = cutDistance(point); }
float keptUntil(vec3 point)
{
    float before = cutBefore;
    cutBefore = cutDistance(point);
    return keptShare(before, cutBefore);
}
#define isKept(point) (cutDistance(point) >= 0.0)
#else
#define keptAbout(origin, direction, t, dt) 1.0
#define beginCut(point)
#define keptUntil(point) 1.0
#define isKept(point) true
#endif
