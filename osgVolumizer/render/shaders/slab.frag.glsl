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
uniform float latticeOffset; // depth of a lattice plane
#ifdef OPAQUE_DEPTH
uniform sampler2D opaqueDepth;
uniform vec2 depthTextureScale; // window -> texture coordinate
uniform vec3 clipZOrigin, clipZDirection, clipWOrigin, clipWDirection; // times (dx, dy, 1)
#endif
#ifdef LAYER_DEPTH
uniform sampler2D layerDepth; // of the surfaces that split this segment
uniform bool inFrontOfLayer;  // which part is drawn
#endif

#ifdef OPAQUE_DEPTH
// Where the ray meets what left its depth in a buffer; far away where nothing did.
float depthOnRay(sampler2D depths)
{
    float windowZ = textureLod(depths, gl_FragCoord.xy * depthTextureScale, 0.0).r;
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
    tFar = min(tFar, depthOnRay(opaqueDepth));
#endif
#ifdef LAYER_DEPTH
    float tLayer = depthOnRay(layerDepth);
    if (!inFrontOfLayer && tLayer < 1e29)
        tNear = max(tNear, tLayer);
    else if (inFrontOfLayer)
        tFar = tLayer < 1e29 ? min(tFar, tLayer) : tNear;
#endif
    if (!(tNear < tFar)) discard;

    float unitsPerDepth = length(frameToUnits * direction);
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    float cell = floor((tNear - latticeOffset) / stepDepth) + 1.0;
    float t = tNear;
    for (int i = 0; i < maximumSteps && t < tFar; ++i) {
        float end = min(latticeOffset + cell * stepDepth, tFar);
        vec4 c = classify(origin + direction * (0.5 * (t + end)));
        float through = exp2(-c.a * (end - t) * unitsPerDepth);
        color += transmittance * (1.0 - through) * c.rgb;
        transmittance *= through;
        if (transmittance < OPAQUE_ENOUGH) break;
        t = max(t, end);
        cell += 1.0;
    }
    fragColor = vec4(color, 1.0 - transmittance);
}
