// One of several volumes, or bricks of one, that are marched together: its part of the ray, and what it adds there.
// No loop but the march itself: on llvmpipe the body of a loop is run once more than it is needed, and once at least.

vec3 memberOrigin, memberDirection; // the pixel's ray in its frame
float period; // depth between samples; infinite where one sample stands for all
#ifdef ADAPTIVE
#define STEP (period * stretch)
#else
#define STEP (period * min(stretch, 1.0))
#endif
vec2 segment; // the part of the ray that is stepped through; steps end at its ends
vec2 shown;   // the part of that which may show something
vec3 placeOrigin, placeRate; // the ray as places
float unitsPerDepth;

// Finds the part of the ray that may show something, of that in the volume's region.
vec2 findRegion(float tNear, float tFar, inout vec2 all)
{
    pixelRay(memberOrigin, memberDirection);
    vec2 region = regionSegment(memberOrigin, memberDirection);
    region = vec2(max(region.x, tNear), min(region.y, tFar));
    shown = boxSegment(clipMin, clipMax, memberOrigin, memberDirection);
    shown = vec2(max(region.x, shown.x), min(region.y, shown.y));
#ifdef TETRAHEDRA
    shown = region;
    beginWalk(memberOrigin, memberDirection);
#elif defined(SKIPPING)
    if (shown.x < shown.y) shown = occupiedPart(memberOrigin, memberDirection, shown.x, shown.y);
#endif
    if (!(shown.x < shown.y)) shown = vec2(1e30, -1e30);
    all = vec2(min(all.x, shown.x), max(all.y, shown.y));
    unitsPerDepth = length(frameToUnits * memberDirection);
#ifdef SHADING
    findEyeRay();
#endif
    return region;
}

#if !defined(CELLS) || defined(TETRAHEDRA) // else see cells.glsl
// Finds the member's part of the ray. Steps are counted from where the volume begins, whatever of it shows.
void findPart(float tNear, float tFar, inout vec2 all)
{
    vec2 region = findRegion(tNear, tFar, all);
    float perDepth = stepsOn(memberDirection);
    period = 1.0 / perDepth;
#ifdef TETRAHEDRA
    segment = shown;
#else
    vec2 steps = (shown - region.x) * perDepth;
    segment = perDepth > 0.0 ? min(region.x + vec2(floor(steps.x), ceil(steps.y)) * period, region.yy) : shown;
#ifdef PREINTEGRATED
    // The ends of steps are where the table is asked.
    vec2 texels = boxSegment(brickMin, brickMax, memberOrigin, memberDirection);
    segment = vec2(max(segment.x, texels.x), min(segment.y, texels.y));
#endif
    placeOrigin = placeOf(memberOrigin);
    placeRate = VOXEL_LENGTH * memberDirection;
#endif
}

#ifdef TETRAHEDRA
// Steps end where tetrahedra do: no step goes beyond the one at hand.
void cutStep(float t, inout float end)
{
    if (left.depth <= t && walked < mostTetrahedra) {
        if (tetrahedron < 0) {
            if (!enterMesh()) {
                left.depth = 1e30;
                hasPart = false;
            }
        } else {
            crossTetrahedron();
        }
    }
    float next = partBegin > t ? partBegin : min(t + STEP, left.depth);
    end = min(end, hasPart ? next : max(left.depth, t));
}
#else
// Moves the end of the step that begins at t to where the member's is, or where the member, or its paint, begins.
void cutStep(float t, inout float end)
{
    float ahead = t < segment.x ? segment.x : 1e30;
    end = min(end, t >= segment.x && t < segment.y ? min(t + STEP, segment.y) : ahead);
#ifdef PAINTED
    end = nextCut(memberOrigin, memberDirection, t, end);
#endif
}
#endif
#endif

// Adds a sample: extinction times colour, and extinction, per unit of depth.
void addClassified(vec4 c, vec3 place, float t, inout vec4 sum)
{
#ifdef SHADING
    c = lit(c, place, t);
#endif
#ifdef PAINTED
    c.rgb = painted(c.rgb, memberOrigin + t * memberDirection);
#endif
    c.rgb = fogged(c.rgb, t);
    COUNT_SAMPLE
    sum += vec4(c.rgb, 1.0) * (c.a * unitsPerDepth);
}
