// A volume, or bricks of one, which have an order: one after another, near to far. "#pragma each" stands before what is
// done for each of them.

vec2 findParts(float tNear, float tFar)
{
    vec2 all = vec2(1e30, -1e30);
#pragma each findPart(tNear, tFar, all);
    return all;
}

// Light of a part of the ray, premultiplied colour and opacity, or what the ray function gathers of it.
vec4 lightBetween(float tNear, float tFar)
{
    vec4 sum = vec4(0.0);
#pragma each sum += (1.0 - sum.a) * light(tNear, tFar);
    return sum;
}
