// One segment: the part of the pixel's ray in the volume's region and the slab, and in front of the opaque
// scene. Midpoint rule with equal steps and exact ends, so second order in the step whatever cuts
// the segment. A brick takes the steps whose midpoints lie in its clip box: bricks add no ends, and however many
// there are, all samples stay where they are.

// What is left of the light when marching stops: the most that this may change any pixel.
#define OPAQUE_ENOUGH 3e-5

flat in vec2 slab; // nearest and farthest depth, from the reference depth
out vec4 fragColor;

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

// The segment in a box; boxes are half-open, so that neighbours share no ray and leave none out.
vec2 boxSegment(vec3 low, vec3 high, vec3 origin, vec3 direction)
{
    bvec3 parallel = equal(direction, vec3(0.0));
    vec3 safe = mix(direction, vec3(1.0), parallel);
    vec3 a = (low - origin) / safe;
    vec3 b = (high - origin) / safe;
    vec3 always = mix(vec3(1e30), vec3(-1e30), lessThanEqual(low, origin));
    always = mix(vec3(1e30), always, lessThan(origin, high));
    vec3 enter = mix(min(a, b), always, parallel);
    vec3 leave = mix(max(a, b), -always, parallel);
    return vec2(max(enter.x, max(enter.y, enter.z)), min(leave.x, min(leave.y, leave.z)));
}

// Number of steps for a segment, such that their mean over all segments is the period.
float stepsOf(float tNear, float tFar)
{
    return clamp(floor((tFar - tNear) / stepDepth + 0.5), 1.0, maximumSteps);
}

#ifdef PREINTEGRATED
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
        float through = exp2(-c.a * stepUnits);
        color += transmittance * (1.0 - through) * c.rgb;
        transmittance *= through;
        if (transmittance < OPAQUE_ENOUGH) break;
    }
    return vec4(color, 1.0 - transmittance);
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
    if (!(max(tNear, brick.x) < min(tFar, brick.y))) discard;

    fragColor = march(origin, direction, tNear, tFar, brick);
}
