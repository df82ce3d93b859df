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
