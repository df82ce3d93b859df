// Where a texture of a size (texels) is filtered at. With FILTER_BITS weights are rounded to so many bits, as most
// texture units round them: a place that is rounded to such a fraction of a texel has exactly these weights.
#ifdef FILTER_BITS
vec3 filterPlace(vec3 place, ivec3 size)
{
    const float steps = float(1 << FILTER_BITS);
    vec3 p = floor((place * vec3(size) - 0.5) * steps + 0.5);
    return (p / steps + 0.5) / vec3(size);
}
#else
#define filterPlace(place, size) (place)
#endif
