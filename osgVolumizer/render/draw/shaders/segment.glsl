// Parts of rays in convex regions.

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

// The segment in a box; boxes are half-open, so that neighbours share no ray and leave none out: the bias, which is
// nothing otherwise, decides for rays in a face.
vec2 boxSegment(vec3 low, vec3 high, vec3 origin, vec3 direction)
{
    vec3 inverse = 1.0 / mix(direction, vec3(1e-30), equal(direction, vec3(0.0)));
    vec3 bias = -1e-15 * inverse;
    vec3 a = (low - origin) * inverse + bias;
    vec3 b = (high - origin) * inverse + bias;
    vec3 enter = min(a, b), leave = max(a, b);
    return vec2(max(enter.x, max(enter.y, enter.z)), min(leave.x, min(leave.y, leave.z)));
}

// Moves the end of what begins at t to where a part of the ray begins or ends, if that comes before.
void cut(vec2 ends, float t, inout float end)
{
    if (ends.x >= ends.y) return;
    if (ends.x > t)
        end = min(end, ends.x);
    else if (ends.y > t)
        end = min(end, ends.y);
}
