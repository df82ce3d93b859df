// Leaping over cells that show nothing, from both ends of a ray (Deakin and Knackstedt, "Accelerated volume
// rendering with Chebyshev distance maps", SIGGRAPH Asia 2019). What lies between is marched without another look
// at cells: in most volumes that is cheaper than to leap over gaps inside.

#ifdef SKIPPING
uniform sampler3D cells; // bytes: distance to the next occupied cell
uniform vec3 cellOrigin; // voxel coordinate of the corner of the first cell
uniform float cellSize;  // voxels

// Where a ray (in cells: origin + t * direction) first meets an occupied cell; beyond `end` where it does not before.
float firstOccupied(vec3 origin, vec3 direction, float t, float end)
{
    vec3 rate = mix(direction, vec3(1e-30), equal(direction, vec3(0.0)));
    vec3 inverse = 1.0 / rate;
    vec3 ahead = vec3(greaterThan(rate, vec3(0.0)));
    vec3 lastCell = vec3(textureSize(cells, 0) - 1);
    float margin = 1e-4 / length(direction);
    float empty;
    do {
        vec3 cell = clamp(floor(origin + t * rate), vec3(0.0), lastCell);
        empty = floor(texelFetch(cells, ivec3(cell), 0).r * 255.0 + 0.5);
        // The faces of the cube of empty cells that the ray leaves through.
        vec3 leave = (cell + 1.0 - empty + ahead * (2.0 * empty - 1.0) - origin) * inverse;
        t = empty > 0.0 ? max(t, min(leave.x, min(leave.y, leave.z))) + margin : t;
    } while (empty > 0.0 && t < end);
    return t;
}

// The part of [tNear, tFar] beyond which the ray meets no occupied cell.
vec2 occupiedPart(vec3 origin, vec3 direction, float tNear, float tFar)
{
    origin = (origin - cellOrigin) / cellSize;
    direction /= cellSize;
    float first = firstOccupied(origin, direction, tNear, tFar);
    return vec2(first, -firstOccupied(origin, -direction, -tFar, -first));
}
#endif
