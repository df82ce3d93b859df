// Several volumes in one march. Depth along the view is common to their rays, each has its own frame. All are sampled
// at the middle of the same steps, which end where any volume begins or ends; extinctions add, and colours are weighted
// by extinction. So constant volumes come out exact, others to second order, and none is first. Where one of them is
// marched cell by cell, steps end with its pieces, too, and are sampled at the points of Gauss's rule.
// "#pragma each" stands before what is done for each of them.

uniform float mostSteps;

// No ray of a volume by itself is off by more than that; here their errors add.
#define TOGETHER_ENOUGH (0.25 * opaqueEnough)

#ifdef SURFACES
float surface; // where the nearest isosurface is; far away where none is
#endif

vec2 findParts(float tNear, float tFar)
{
    vec2 all = vec2(1e30, -1e30);
#pragma each findPart(tNear, tFar, all);
#ifdef SURFACES
    surface = 1e30;
#pragma each surface = min(surface, surfaceOnRay());
#endif
    return all;
}

// Light of a part of the ray, front to back: premultiplied colour, opacity.
vec4 lightBetween(float tNear, float tFar)
{
    vec3 color = vec3(0.0);
    float through = 1.0, t = tNear, end = tFar, left = mostSteps;
#ifdef SURFACES
    end = min(end, surface);
#endif
    if (t < end) do {
        float next = end;
#pragma each cutStep(t, next);
        float middle = 0.5 * (t + next), dt = next - t;
#ifdef PIECES
        vec4 first = vec4(0.0), second = vec4(0.0);
#pragma each addPoints(t, next, first, second);
        vec4 piece = lightOfPiece(vec4(first.rgb / max(first.a, 1e-30), first.a),
                                  vec4(second.rgb / max(second.a, 1e-30), second.a), dt);
        float behind = through - through * piece.a;
        vec3 light = through * piece.rgb;
#else
        vec4 sum = vec4(0.0);
#pragma each addLight(middle, dt, sum);
        float behind = through * exp2(-sum.a * dt);
        vec3 light = (through - behind) * sum.rgb / max(sum.a, 1e-30);
#endif
#ifdef STEPS_ADAPT
        bool added = suitsStep(through - behind);
        color += added ? light : vec3(0.0);
        through = added ? behind : through;
        t = added ? next : t;
#else
        color += light;
        through = behind;
        t = next;
#endif
    } while (t < end && --left > 0.0 && through > TOGETHER_ENOUGH);
#ifdef SURFACES
    if (surface >= tNear && surface <= tFar) {
#pragma each addSurface(surface, color, through);
    }
#endif
    return vec4(color, 1.0 - through);
}
