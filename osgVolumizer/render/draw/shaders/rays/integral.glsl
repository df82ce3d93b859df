// The integral of the value along the ray, and of 1, in opacity units.

#define EMPTY_RAY vec4(0.0)
#define JOIN_RAY(front, behind) (front + behind)
#define RAY_DONE(light) false

#if defined(SLAB)
// Integral of the value over the brick's steps, and of 1.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    float count = stepsOf(direction, tNear, tFar), dt = (tFar - tNear) / count;
    float first = max(0.0, ceil((brick.x - tNear) / dt - 0.5));
    int steps = int(min(count, ceil((brick.y - tNear) / dt - 0.5)) - first);
    vec3 place = placeOnRay(origin, direction, tNear + (first + 0.5) * dt);
    vec3 rate = VOXEL_RATE(direction) * dt;
    float sum = 0.0, keptSteps = 0.0;
    beginCut(cutPoint(origin, direction, tNear + first * dt));
    for (int i = 0; i < steps; ++i) {
        float kept = keptUntil(cutPoint(origin, direction, tNear + (first + float(i) + 1.0) * dt));
        sum += kept * voxelAt(place);
        keptSteps += kept;
        COUNT_SAMPLE
        place += rate;
    }
    float stepUnits = dt * length(frameToUnits * direction);
    return vec4(sum * stepUnits, keptSteps * stepUnits, 0.0, 0.0);
}

#elif defined(SLICE)
vec4 slice(vec3 place, vec3 direction, float thickness)
{
    float units = kept * thickness * length(frameToUnits * direction);
    return vec4(voxelAt(place) * units, units, 0.0, 0.0);
}
#endif
