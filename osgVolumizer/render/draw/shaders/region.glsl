// Where a volume is on the pixel's ray, and how it is sampled and lit there.

uniform vec3 regionMin, regionMax; // of the whole volume
uniform vec3 clipMin, clipMax;     // of the brick
#if PLANES > 0
uniform vec4 planes[PLANES];
#endif
#ifdef PREINTEGRATED
uniform vec3 brickMin, brickMax; // what the brick's texture has values for
#endif
uniform float stepsPerDepth;
uniform float stepsPerLength; // of the frame, along each ray, where an error is kept; else 0
uniform float maximumSteps;

// The part of the ray in the volume's region.
vec2 regionSegment(vec3 origin, vec3 direction)
{
    vec2 ends = boxSegment(regionMin, regionMax, origin, direction);
#if PLANES > 0
    for (int i = 0; i < PLANES; ++i) clipToPlane(planes[i], origin, direction, ends.x, ends.y);
#endif
    return ends;
}

// Steps per depth on a ray.
float stepsOn(vec3 direction) { return stepsPerLength > 0.0 ? stepsPerLength * length(direction) : stepsPerDepth; }

// Number of steps for a segment, such that their mean over all segments is the period.
float stepsOf(vec3 direction, float tNear, float tFar)
{
    return clamp(floor((tFar - tNear) * stepsOn(direction) + 0.5), 1.0, maximumSteps);
}

#ifdef SHADING
vec3 originEye, directionEye, towardsEye; // the ray in the eye frame

// Finds where the ray is in the eye frame.
void findEyeRay()
{
    vec3 window = vec3(windowPlace() - windowCenter, 1.0);
    originEye = rayOriginEye * window;
    directionEye = rayDirectionEye * window;
    towardsEye = -normalize(directionEye);
}

// The colour that the scene's lights make of a classified one.
vec4 lit(vec4 c, vec3 place, float t)
{
    if (!(c.a > 0.0)) return c;
    return vec4(shade(c.rgb, place, originEye + t * directionEye, towardsEye), c.a);
}
#endif
