// One segment: the part of the pixel's ray in the clip box, the region's half-spaces and the slab, and in
// front of the opaque scene. Midpoint rule on a lattice of depths that all bricks share, with exact
// ends, so second order in the step whatever cuts the segment.

// What is left of the light when marching stops: the most that this may change any pixel.
#define OPAQUE_ENOUGH 3e-5

flat in vec2 slab; // nearest and farthest depth, from the reference depth
out vec4 fragColor;

uniform vec3 clipMin, clipMax;
#if PLANES > 0
uniform vec4 planes[PLANES];
#endif
uniform float stepDepth;
uniform int maximumSteps;
#ifdef OPAQUE_DEPTH
uniform sampler2D opaqueDepth;
uniform vec2 opaqueDepthScale;  // window -> texture coordinate
uniform vec2 opaqueDepthOffset;
uniform vec3 clipZOrigin, clipZDirection, clipWOrigin, clipWDirection; // times (dx, dy, 1)
#endif

#ifdef OPAQUE_DEPTH
// Where the ray meets the opaque scene.
float opaqueEnd()
{
    float windowZ =
        textureLod(opaqueDepth, gl_FragCoord.xy * opaqueDepthScale + opaqueDepthOffset, 0.0).r;
    if (windowZ >= 1.0) return 1e30;
    vec3 window = vec3(gl_FragCoord.xy - windowCenter, 1.0);
    float z = 2.0 * windowZ - 1.0;
    return (z * dot(clipWOrigin, window) - dot(clipZOrigin, window)) /
           (dot(clipZDirection, window) - z * dot(clipWDirection, window));
}
#endif

// Narrows the segment to a half-space.
void clipToPlane(vec4 plane, vec3 origin, vec3 direction, inout float tNear, inout float tFar)
{
    float distance = dot(plane.xyz, origin) + plane.w;
    float rate = dot(plane.xyz, direction);
    if (rate > 0.0)
        tNear = max(tNear, -distance / rate);
    else if (rate < 0.0)
        tFar = min(tFar, -distance / rate);
    else if (distance < 0.0)
        tFar = tNear;
}

// Light of the segment [tNear, tFar], front to back: premultiplied colour, opacity.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar)
{
    float unitsPerDepth = length(frameToUnits * direction);
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    float cell = floor(tNear / stepDepth) + 1.0;
    float t = tNear;
#ifdef PREINTEGRATED
    float coordinate = tableCoordinate(origin + direction * t);
    vec4 integral = tableIntegral(coordinate);
#endif
    for (int i = 0; i < maximumSteps && t < tFar; ++i) {
        float end = min(cell * stepDepth, tFar);
#ifdef PREINTEGRATED
        float nextCoordinate = tableCoordinate(origin + direction * end);
        vec4 nextIntegral = tableIntegral(nextCoordinate);
        vec4 c = classifyRun(coordinate, integral, nextCoordinate, nextIntegral);
        coordinate = nextCoordinate;
        integral = nextIntegral;
#else
        vec4 c = classify(origin + direction * (0.5 * (t + end)));
#endif
        float through = exp2(-c.a * (end - t) * unitsPerDepth);
        color += transmittance * (1.0 - through) * c.rgb;
        transmittance *= through;
        if (transmittance < OPAQUE_ENOUGH) break;
        t = max(t, end);
        cell += 1.0;
    }
    return vec4(color, 1.0 - transmittance);
}

void main()
{
    vec3 origin, direction;
    pixelRay(origin, direction);
    vec3 safe = mix(direction, vec3(1e-30), equal(direction, vec3(0.0)));
    vec3 a = (clipMin - origin) / safe;
    vec3 b = (clipMax - origin) / safe;
    vec3 enter = min(a, b), leave = max(a, b);
    float tNear = max(max(enter.x, enter.y), max(enter.z, slab.x));
    float tFar = min(min(leave.x, leave.y), min(leave.z, slab.y));
#if PLANES > 0
    for (int i = 0; i < PLANES; ++i) clipToPlane(planes[i], origin, direction, tNear, tFar);
#endif
#ifdef OPAQUE_DEPTH
    tFar = min(tFar, opaqueEnd());
#endif

    fragColor = march(origin, direction, tNear, tFar);
}
