// A volume of tetrahedra, or a brick of it, that is marched by itself: tetrahedron by tetrahedron. Parts of the ray come near
// to far, so the walk goes on where it was. No loop in that over tetrahedra but marches: see member.glsl.

vec3 origin, direction; // the pixel's ray
vec2 region;            // the part of it in the volume's region, in t

void findPart(float tNear, float tFar, inout vec2 all)
{
    pixelRay(origin, direction);
    region = regionSegment(origin, direction);
    vec2 part = vec2(max(region.x, tNear), min(region.y, tFar));
    if (part.x < part.y) all = vec2(min(all.x, part.x), max(all.y, part.y));
#ifdef SHADING
    findEyeRay();
#endif
    beginWalk(origin, direction);
}

#ifdef EXACT_CELLS
#define MOST_PIECES 4194304
float at = -1e30; // depth that light is known up to
#ifdef SCALARS
float scalarAt;
#endif

// Light with that of the scene, paint and fog, about one depth.
vec4 inScene(vec4 light, float t)
{
#if defined(SHADING) || defined(FOG) || defined(PAINTED)
    vec4 c = vec4(light.rgb / max(light.a, 1e-30), light.a);
#ifdef SHADING
    c = lit(c, vec3(0.0), t);
#endif
#ifdef PAINTED
    c.rgb = painted(c.rgb, origin + t * direction);
#endif
    return vec4(fogged(c.rgb, t) * c.a, c.a);
#else
    return light;
#endif
}

// On to the next piece: into the next tetrahedron, and to where the part of the ray begins.
void goOn(float tNear, out float rate)
{
    if (at >= left.depth) {
        crossTetrahedron();
        at = hasPart ? entered.depth : left.depth;
#ifdef SCALARS
        if (hasPart) scalarAt = entered.scalar;
#ifdef CELL_SCALARS
        findPoint(scalarAt);
#endif
#endif
    }
    float skipped = clamp(max(tNear, partBegin), at, left.depth) - at;
    rate = 1.0 / max(left.depth - entered.depth, 1e-30);
#ifdef SCALARS
    rate *= hasPart ? left.scalar - entered.scalar : 0.0; // perhaps not even finite
    scalarAt += skipped * rate;
#endif
    at += skipped;
}

// The piece that begins where light is known up to: its end, and colour and opacity at both.
#ifdef SCALARS
void findPiece(float tFar, float rate, out float next, out float scalarNext, out vec4 c0, out vec4 c1)
{
    next = min(left.depth, tFar);
    scalarNext = next < left.depth ? scalarAt + (next - at) * rate : hasPart ? left.scalar : scalarAt;
    bool up = scalarNext >= scalarAt;
    bool higher = up ? scalarAt >= pointHigh : scalarAt > pointHigh;
    bool lower = up ? scalarAt < pointLow : scalarAt <= pointLow;
    movePoint(higher, lower);
    // Further points come one by one.
    bool here = up ? scalarAt >= pointLow && scalarAt < pointHigh : scalarAt > pointLow && scalarAt <= pointHigh;
    float bound = up ? pointHigh : pointLow;
    if (!here || (up ? scalarNext > bound : scalarNext < bound)) {
        bound = here ? bound : scalarAt;
        next = here && rate != 0.0 ? clamp(at + (bound - scalarAt) / rate, at, next) : at;
        scalarNext = bound;
    }
    c0 = colorBetweenPoints(scalarAt);
    c1 = colorBetweenPoints(scalarNext);
}
#else
void findPiece(float tFar, float rate, out float next, out vec4 c0, out vec4 c1)
{
    next = min(left.depth, tFar);
    c0 = mix(entered.color, left.color, (at - entered.depth) * rate);
    c1 = mix(entered.color, left.color, (next - entered.depth) * rate);
}
#endif

// No piece is longer where something else may begin or end within it.
float longestPiece()
{
#if defined(CUT) || defined(FOG) || defined(PAINTED)
    return tetraSize / (64.0 * length(direction));
#else
    return 1e30;
#endif
}

vec4 light(float tNear, float tFar)
{
    tNear = max(tNear, region.x);
    tFar = min(tFar, region.y);
    int pieces = 0;
    float longest = longestPiece();
    vec3 color = vec3(0.0);
    float through = 1.0, unitsPerDepth = length(frameToUnits * direction);
    bool more = tNear < tFar, inMesh;
    if (more) do {
        if (at >= left.depth && tetrahedron < 0) {
            more = enterMesh();
            at = left.depth;
#ifdef SCALARS
            if (more) findPoint(left.scalar);
#endif
        }
        if (more) do {
            float rate, next, share;
            vec4 c0, c1;
            goOn(tNear, rate);
#ifdef SCALARS
            float scalarNext;
            findPiece(min(tFar, at + longest), rate, next, scalarNext, c0, c1);
#else
            findPiece(min(tFar, at + longest), rate, next, c0, c1);
#endif
            float units = max(next - at, 0.0) * unitsPerDepth;
            units *= keptAbout(origin, direction, 0.5 * (at + next), next - at);
            float least = 4e-7 * max(abs(at), abs(next)) / max(next - at, 1e-30); // that floats can tell
            vec4 piece = linearLight(c0, c1, hasPart ? units : 0.0, least, share);
            float reached = at + share * (next - at);
            piece = inScene(piece, 0.5 * (at + reached));
            color += through * piece.rgb;
            through *= 1.0 - piece.a;
            at = share < 1.0 ? reached : next;
#ifdef SCALARS
            scalarAt = share < 1.0 ? mix(scalarAt, scalarNext, share) : scalarNext;
#endif
            COUNT_SAMPLE
            more = at < tFar && through > opaqueEnough && walked < mostTetrahedra && ++pieces < MOST_PIECES;
            inMesh = at < left.depth || tetrahedron >= 0;
        } while (more && inMesh);
    } while (more);
    return vec4(color, 1.0 - through);
}

#else
// Of the tetrahedron that is walked through, between two depths.
vec4 lightOfPart(float tNear, float tFar)
{
#if defined(PLACES) || defined(SCALARS)
    takeVoxelRay();
#endif
#ifdef VOXELS
    vec2 shown = boxSegment(clipMin, clipMax, VOXEL_RAY(origin, direction));
    if (!(max(tNear, shown.x) < min(tFar, shown.y))) return EMPTY_RAY;
#else
    vec2 shown = vec2(tNear, tFar);
#endif
    return march(origin, direction, tNear, tFar, shown);
}

// What the ray function makes of a part of the ray, front to back.
vec4 light(float tNear, float tFar)
{
    tNear = max(tNear, region.x);
    tFar = min(tFar, region.y);
    vec4 sum = EMPTY_RAY;
    bool more = tNear < tFar, on;
    if (more) do {
        do {
            float begin = max(partBegin, tNear), end = min(left.depth, tFar);
            if (hasPart && begin < end) sum = JOIN_RAY(sum, lightOfPart(begin, end));
            more = left.depth < tFar && !RAY_DONE(sum) && walked < mostTetrahedra;
            on = more && tetrahedron >= 0;
#ifdef WHOLE_RUNS
            if (on) crossMesh();
#else
            if (on) crossTetrahedron();
#endif
        } while (on);
        if (more) more = enterMesh();
    } while (more);
    return sum;
}
#endif
