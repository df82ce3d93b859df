in vec3 voxelCoordinate;
uniform vec3 voxelBase; // that it is counted from
flat in vec3 across;
#if PLANES > 0
in vec3 framePosition;
uniform vec4 planes[PLANES];
#endif
#ifdef FOG
in float depthEye;
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
#ifdef THICK
    // One loop over all bricks: several in a row take some compilers for ever.
    vec3 slab = across * thickness;
    int layers = clamp(int(ceil(length(slab) / period - 1e-4)), 1, 4096);
    for (int i = 0; i < layers; ++i) {
        vec3 place = voxelCoordinate + slab * ((float(i) + 0.5) / float(layers) - 0.5) + voxelBase;
#pragma take
    }
#else
    vec3 place = voxelCoordinate + voxelBase;
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
