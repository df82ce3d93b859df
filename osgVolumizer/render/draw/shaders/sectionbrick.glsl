// What a slice takes from one brick.

uniform vec3 clipMin, clipMax; // the brick's part of the volume, half-open

TEXEL valueAt(vec3 voxelCoordinate)
{
#ifdef FETCH
    // Samples of bricks are counted exactly, those of coarse pages as textures do.
    vec3 size = vec3(textureSize(voxels, 0));
    vec3 scale = textureScale * size, offset = textureOffset * size - 0.5;
    if (all(lessThan(abs(scale - 1.0), vec3(1e-5)))) return voxelAt(voxelCoordinate + round(offset));
    return voxelAt(voxelCoordinate * scale + offset);
#else
    return voxelAt(placeOf(voxelCoordinate));
#endif
}

// Premultiplied, for RGBA.
vec4 componentsAt(vec3 voxelCoordinate)
{
    TEXEL t = valueAt(voxelCoordinate);
#ifdef RGBA
    return vec4(t.rgb * t.a, t.a);
#else
    return vec4(t);
#endif
}

// Reduces a value with those before; of a slab that of a place in the brick only.
void take(vec3 place, inout vec4 total, inout float counted)
{
#ifdef THICK
    if (any(lessThan(place, clipMin)) || any(greaterThanEqual(place, clipMax))) return;
#endif
#if defined(REDUCTION_MAXIMUM)
    total = max(total, componentsAt(place));
#elif defined(REDUCTION_MINIMUM)
    total = min(total, componentsAt(place));
#else
    total += componentsAt(place);
#endif
    counted += 1.0;
}
