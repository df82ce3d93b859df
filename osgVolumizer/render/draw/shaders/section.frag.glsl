in vec3 voxelCoordinate;
uniform vec3 voxelBase; // that it is counted from
flat in vec3 across;
flat in float distanceAlong;
uniform bool hasRays; // the pixel's ray, in the frame of positions; see setRays()
uniform vec2 windowCenter;
uniform mat3 rayOrigin;
uniform mat3 rayDirection;
uniform vec3 positionScale; // position -> voxel coordinate as it is counted here
uniform vec3 positionOffset;
#if PLANES > 0
in vec3 framePosition;
uniform vec4 planes[PLANES];
#endif
#ifdef FOG
in float depthEye;
#endif
#ifdef CUT
uniform float cutTolerance; // what lies no farther outside is shown
#endif
out vec4 fragColor;
uniform samplerBuffer colorPoints; // two texels a point: fraction of the range; colour, opacity
uniform int pointCount;
uniform vec2 texelToFraction; // scale, offset
uniform float opacity;
uniform bool usesTableOpacity;
#ifdef THICK
uniform float thickness, period; // object units; voxels, at most
#endif

// Linear between points; of two at one value the later one holds from there on.
#ifdef RAMP
uniform vec2 rampEnds;
uniform vec4 rampLow;
uniform vec4 rampHigh;

vec4 colorOf(float fraction)
{
    float width = rampEnds.y - rampEnds.x;
    float t = width > 0.0 ? clamp((fraction - rampEnds.x) / width, 0.0, 1.0)
                          : float(fraction >= rampEnds.x);
    return mix(rampLow, rampHigh, t);
}
#else
vec4 colorOf(float fraction)
{
    int low = 0, high = pointCount;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (texelFetch(colorPoints, 2 * middle).r <= fraction)
            low = middle;
        else
            high = middle;
    }
    int next = min(low + 1, pointCount - 1);
    float from = texelFetch(colorPoints, 2 * low).r, to = texelFetch(colorPoints, 2 * next).r;
    float t = to > from ? clamp((fraction - from) / (to - from), 0.0, 1.0) : 0.0;
    return mix(texelFetch(colorPoints, 2 * low + 1), texelFetch(colorPoints, 2 * next + 1), t);
}
#endif

// Where the pixel's ray meets the face; what was interpolated is as good to less, and tells where
// rays along the face would be wrong.
vec3 voxelOfPixel()
{
#ifdef FETCH // else texture units are less precise
    if (!hasRays) return voxelCoordinate;
    vec3 w = vec3(gl_FragCoord.xy - windowCenter, 1.0);
    vec3 origin = rayOrigin * w, direction = rayDirection * w, normal = across / positionScale;
    float t = (distanceAlong - dot(normal, origin)) / dot(normal, direction);
    vec3 found = (origin + t * direction) * positionScale + positionOffset;
    return all(lessThan(abs(found - voxelCoordinate), vec3(0.01))) ? found : voxelCoordinate;
#else
    return voxelCoordinate;
#endif
}

void main()
{
#if PLANES > 0
    for (int i = 0; i < PLANES; ++i)
        if (dot(planes[i], vec4(framePosition, 1.0)) < 0.0) discard;
#endif
#if defined(REDUCTION_MAXIMUM)
    vec4 total = vec4(-3e38);
#elif defined(REDUCTION_MINIMUM)
    vec4 total = vec4(3e38);
#else
    vec4 total = vec4(0.0);
#endif
    float counted = 0.0;
    vec3 middle = voxelOfPixel();
#ifdef CUT
    if (cutDistance(middle + voxelBase) < -cutTolerance) discard;
#endif
#ifdef THICK
    // One loop over all bricks: several in a row take some compilers for ever.
    vec3 slab = across * thickness;
    int layers = clamp(int(ceil(length(slab) / period - 1e-4)), 1, 4096);
    for (int i = 0; i < layers; ++i) {
        vec3 place = middle + slab * ((float(i) + 0.5) / float(layers) - 0.5) + voxelBase;
#pragma take
    }
#else
    vec3 place = middle + voxelBase;
#pragma take
#endif
    if (counted == 0.0) discard;
#ifdef REDUCTION_MEAN
    total /= counted;
#endif
#ifdef RGBA
    vec4 color = vec4(total.rgb / max(total.a, 1e-12), total.a);
#else
    vec4 color = colorOf(total.r * texelToFraction.x + texelToFraction.y);
#endif
    fragColor = vec4(fogged(color.rgb, depthEye), usesTableOpacity ? color.a * opacity : opacity);
}
