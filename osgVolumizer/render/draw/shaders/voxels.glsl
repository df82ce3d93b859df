// The voxels of one brick: interpolated, or fetched as they are.

#ifdef VOXELS
uniform sampler3D voxels;
uniform vec3 textureScale; // voxel coordinate -> texture coordinate
uniform vec3 textureOffset;
#ifdef BLENDS_STEPS
uniform sampler3D nextVoxels; // the same places, a time step later
uniform float stepFraction;
// Linear in both, so that interpolated values may be blended as well as samples.
#define OF_STEPS(FETCH_FROM) mix(FETCH_FROM(voxels), FETCH_FROM(nextVoxels), stepFraction)
#else
#define OF_STEPS(FETCH_FROM) FETCH_FROM(voxels)
#endif

#ifdef RGBA
#define TEXEL vec4
#define CHANNELS(t) (t)
#else
#define TEXEL float
#ifdef GRADIENT_TEXTURE
#define CHANNELS(t) (t).a
#else
#define CHANNELS(t) (t).r
#endif
#endif

#ifdef FETCH
// Places in the brick are coordinates of its samples. Those of a coarser level lie several voxels apart; else the
// offset is a whole number.
#define VOXEL_LENGTH samplesPerVoxel()
#define FIRST_PLACE vec3(0.0)
#define LAST_PLACE vec3(textureSize(voxels, 0) - 1)

vec3 samplesPerVoxel()
{
    vec3 rate = textureScale * vec3(textureSize(voxels, 0));
    return mix(rate, vec3(1.0), lessThan(abs(rate - 1.0), vec3(1e-3)));
}

vec3 placeOf(vec3 voxelCoordinate)
{
    vec3 rate = samplesPerVoxel(), first = 0.5 - textureOffset * vec3(textureSize(voxels, 0));
    return voxelCoordinate * rate - mix(first, round(first), equal(rate, vec3(1.0)));
}

TEXEL texelAt(ivec3 i)
{
    ivec3 held = clamp(i, ivec3(0), textureSize(voxels, 0) - 1);
#define HELD_IN(step) CHANNELS(texelFetch(step, held, 0))
    return OF_STEPS(HELD_IN);
}

// The samples about a place, and where it is between them.
void cellAt(vec3 place, out ivec3 cell, out vec3 f)
{
    vec3 p = clamp(place, FIRST_PLACE, LAST_PLACE);
    vec3 low = floor(p);
    cell = ivec3(low);
    f = p - low;
}
#else
// Places in the brick are texture coordinates: marching in them saves a sixth of the time on llvmpipe.
#define VOXEL_LENGTH textureScale
#define FIRST_PLACE (0.5 / vec3(textureSize(voxels, 0)))
#define LAST_PLACE (1.0 - FIRST_PLACE)

vec3 placeOf(vec3 voxelCoordinate) { return voxelCoordinate * textureScale + textureOffset; }
#endif

#ifdef CUBIC
// Keys's kernel with a = -1/2: weights of the samples -1, 0, 1 and 2.
vec4 cubicWeights(float f)
{
    return vec4(((2.0 - f) * f - 1.0) * f, (3.0 * f - 5.0) * f * f + 2.0,
                ((4.0 - 3.0 * f) * f + 1.0) * f, (f - 1.0) * f * f) * 0.5;
}

TEXEL cubicRow(ivec3 i, vec4 w)
{
    return w.x * texelAt(i) + w.y * texelAt(i + ivec3(1, 0, 0)) + w.z * texelAt(i + ivec3(2, 0, 0)) +
           w.w * texelAt(i + ivec3(3, 0, 0));
}
#endif

// The voxels' value at a place, as a texel.
TEXEL voxelAt(vec3 place)
{
#if defined(NEAREST)
    return texelAt(ivec3(floor(place + 0.5)));
#elif defined(CUBIC)
    ivec3 cell;
    vec3 f;
    cellAt(place, cell, f);
    vec4 wx = cubicWeights(f.x), wy = cubicWeights(f.y), wz = cubicWeights(f.z);
    TEXEL sum = TEXEL(0.0);
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) sum += wz[k] * wy[j] * cubicRow(cell + ivec3(-1, j - 1, k - 1), wx);
    return sum;
#elif defined(EXACT)
    ivec3 cell;
    vec3 f;
    cellAt(place, cell, f);
    TEXEL x00 = mix(texelAt(cell), texelAt(cell + ivec3(1, 0, 0)), f.x);
    TEXEL x10 = mix(texelAt(cell + ivec3(0, 1, 0)), texelAt(cell + ivec3(1, 1, 0)), f.x);
    TEXEL x01 = mix(texelAt(cell + ivec3(0, 0, 1)), texelAt(cell + ivec3(1, 0, 1)), f.x);
    TEXEL x11 = mix(texelAt(cell + ivec3(0, 1, 1)), texelAt(cell + ivec3(1, 1, 1)), f.x);
    return mix(mix(x00, x10, f.y), mix(x01, x11, f.y), f.z);
#else
    vec3 filtered = filterPlace(place, textureSize(voxels, 0));
#define FILTERED_IN(step) CHANNELS(texture(step, filtered))
    return OF_STEPS(FILTERED_IN);
#endif
}
#endif

#if defined(TETRAHEDRA) && !defined(VOXELS)
// Scalars of tetrahedra are places of their own.
#define TEXEL float
#define VOXEL_LENGTH 1.0
vec3 placeOf(vec3 scalar) { return scalar; }
float voxelAt(vec3 place) { return place.x; }
#endif

#if defined(VOXELS) || defined(SCALARS) || defined(TETRAHEDRA)
// The ray as places: that of the frame, which is the voxel frame, or that of the tetrahedron at hand.
#if defined(PLACES) || defined(SCALARS)
vec3 rayVoxelOrigin, rayVoxelRate;
#define VOXEL_RAY(origin, direction) rayVoxelOrigin, rayVoxelRate
#define VOXEL_RATE(direction) (VOXEL_LENGTH * rayVoxelRate)
vec3 voxelOnRay(vec3 origin, vec3 direction, float t) { return rayVoxelOrigin + t * rayVoxelRate; }

// Of the tetrahedron that is walked through.
void takeVoxelRay()
{
    float perDepth = 1.0 / max(left.depth - entered.depth, 1e-30);
#ifdef PLACES
    rayVoxelRate = (left.place - entered.place) * perDepth;
    rayVoxelOrigin = entered.place - entered.depth * rayVoxelRate;
#else
    rayVoxelRate = vec3((left.scalar - entered.scalar) * perDepth, 0.0, 0.0);
    rayVoxelOrigin = vec3(entered.scalar, 0.0, 0.0) - entered.depth * rayVoxelRate;
#endif
}
#else
#define VOXEL_RAY(origin, direction) origin, direction
#define VOXEL_RATE(direction) (VOXEL_LENGTH * direction)
vec3 voxelOnRay(vec3 origin, vec3 direction, float t) { return origin + t * direction; }
#endif
vec3 placeOnRay(vec3 origin, vec3 direction, float t) { return placeOf(voxelOnRay(origin, direction, t)); }
#endif
