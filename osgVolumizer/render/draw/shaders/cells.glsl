// Rays cell by cell: between two samples on each axis, what is interpolated linearly is a cubic polynomial along a ray.
// So pieces that end at faces of cells, where its value turns round, and where it passes a corner of the table, are
// smooth, and Gauss's rule of two points integrates them to fourth order (Weiss and Westermann, "Analytic ray splitting
// for controlled precision DVR", 2021). The same as core/accuracy/CellRay.

#if defined(CELLS) && !(defined(MEMBER) && defined(TETRAHEDRA))
uniform float longestPiece; // depth
uniform float stride;       // more than 1: all voxels have one value

#define MOST_PIECES 1048576
// In the time that steps take for as many samples: see core/accuracy/PeriodChoice.
#ifndef COUNT_SAMPLES
#define COUNT_PIECE
#elif defined(CORNERS)
#define COUNT_PIECE sampleCount += 6.4;
#else
#define COUNT_PIECE sampleCount += 1.9;
#endif
#define MOST_BITS 1.0 // of extinction in a piece

// The ray in the frame of the brick's samples: cellStart + t * cellRate; and as places.
vec3 cellStart, cellRate, cellInverse, cellStep;
vec3 startPlace, placesPerDepth;
vec3 cellFace; // coordinates of the faces that it meets next
float cellBegin, cellEnd; // depths

// Of a piece in the interval at hand, depth: no shorter than floats can tell within a cell.
float longestPart(float unitsPerDepth, float cell)
{
    return min(longestPiece, max(MOST_BITS / max(mostExtinction * unitsPerDepth, 1e-30), cell / 64.0));
}

vec3 cellPlace(float t) { return startPlace + t * placesPerDepth; }
float fractionAt(float t) { return voxelAt(cellPlace(t)) * valueToEntry.x + valueToEntry.y; }

// At three places of the cell.
vec3 fractionsAt(vec3 t)
{
#ifdef EXACT
    ivec3 cell;
    vec3 f;
    vec3 middle = cellPlace(0.5 * (cellBegin + cellEnd));
    cellAt(middle, cell, f);
    vec4 low = vec4(texelAt(cell), texelAt(cell + ivec3(1, 0, 0)), texelAt(cell + ivec3(0, 1, 0)),
                    texelAt(cell + ivec3(1, 1, 0)));
    vec4 high = vec4(texelAt(cell + ivec3(0, 0, 1)), texelAt(cell + ivec3(1, 0, 1)),
                     texelAt(cell + ivec3(0, 1, 1)), texelAt(cell + ivec3(1, 1, 1)));
    vec3 value;
    for (int i = 0; i < 3; ++i) {
        f = clamp(cellPlace(t[i]) - vec3(cell), 0.0, 1.0);
        vec4 z = mix(low, high, f.z);
        vec2 y = mix(z.xy, z.zw, f.y);
        value[i] = mix(y.x, y.y, f.x);
    }
    return value * valueToEntry.x + valueToEntry.y;
#elif !defined(CORNERS)
    return vec3(fractionAt(t.x), fractionAt(t.y), 0.0);
#else
    return vec3(fractionAt(t.x), fractionAt(t.y), fractionAt(t.z));
#endif
}

// Before the first cell, which begins at t.
void beginCells(vec3 rayOrigin, vec3 rayDirection, float t)
{
    startPlace = cellStart = placeOf(rayOrigin);
    placesPerDepth = cellRate = VOXEL_LENGTH * rayDirection;
#ifndef FETCH
    vec3 size = vec3(textureSize(voxels, 0));
    cellStart = cellStart * size - 0.5;
    cellRate *= size;
#endif
    float shift = 0.0;
#ifdef NEAREST
    shift = 0.5; // cells are those about samples
#endif
    bvec3 stands = lessThan(abs(cellRate), vec3(1e-30));
    cellInverse = 1.0 / mix(cellRate, vec3(1e-30), stands);
    cellStep = sign(cellRate);
    vec3 p = cellStart + t * cellRate + shift;
    cellFace = mix(ceil(p) - 1.0, floor(p) + 1.0, greaterThanEqual(cellRate, vec3(0.0))) - shift;
    cellFace += cellStep * (stride > 1.0 ? 1e9 : 0.0); // all of one value
    cellEnd = t;
}

// On to the next face, or to an end before that.
void passCell(float end)
{
    cellBegin = cellEnd;
    vec3 next = (cellFace - cellStart) * cellInverse;
    cellEnd = max(min(min(next.x, next.y), min(next.z, end)), cellBegin);
    cellFace += cellStep * vec3(lessThanEqual(next, vec3(cellEnd)));
}

#ifdef CORNERS
float valueAtEnd;
vec4 cubic;       // of the cell's value, from 0 to 1 along the ray
vec2 turns;       // where it turns round; 1 where it does not
float piece;      // where the piece at hand begins
float pieceEnd;
bool passesCorner, rises; // at its end

// Into the next cell, which ends at a face or before.
void enterCell(float end)
{
    passCell(end);
    piece = 0.0;
#ifdef NEAREST
    cubic = vec4(fractionAt(0.5 * (cellBegin + cellEnd)), 0.0, 0.0, 0.0);
    valueAtEnd = cubic.x;
    turns = vec2(1.0);
    findInterval(valueAtEnd);
#else
    vec3 v = fractionsAt(mix(vec3(cellBegin), vec3(cellEnd), vec3(0.33333333, 0.66666667, 1.0)));
    float first = valueAtEnd;
    valueAtEnd = v.z;
    // Differences to the first value keep digits.
    v -= first;
    cubic = vec4(first, 9.0 * v.x - 4.5 * v.y + v.z, 18.0 * v.y - 22.5 * v.x - 4.5 * v.z,
                 4.5 * (3.0 * (v.x - v.y) + v.z));
    float discriminant = cubic.z * cubic.z - 3.0 * cubic.w * cubic.y;
    float q = sqrt(max(discriminant, 0.0));
    q = -(cubic.z + (cubic.z < 0.0 ? -q : q));
    vec2 roots = vec2(q, cubic.y) / vec2(3.0 * cubic.w, q);
    roots = mix(vec2(1.0), roots, lessThan(abs(roots - 0.5), vec2(0.5)));
    turns = discriminant > 0.0 ? vec2(min(roots.x, roots.y), max(roots.x, roots.y)) : vec2(1.0);
#endif
}

float cubicAt(float s) { return cubic.x + s * (cubic.y + s * (cubic.z + s * cubic.w)); }
float cubicSlope(float s) { return cubic.y + s * (2.0 * cubic.z + s * 3.0 * cubic.w); }

// Where the cubic has a value that lies between those at two places, between which it does not turn.
float cubicRoot(float value, float low, float atLow, float high, float atHigh)
{
    float rising = atHigh > atLow ? 1.0 : -1.0, h = high - low, slope = cubicSlope(low), rest = value - atLow;
    // On a parabola that agrees in both ends' values, and in the slope at the first.
    float bend = (atHigh - atLow - slope * h) / (h * h);
    float s = low + 2.0 * rest / (slope + rising * sqrt(max(slope * slope + 4.0 * bend * rest, 0.0)));
    for (int i = 0; i < 6; ++i) {
        s = s >= low && s <= high ? s : 0.5 * (low + high);
        float off = cubicAt(s) - value;
        bool beyond = off * rising > 0.0;
        high = beyond ? s : high;
        low = beyond ? low : s;
        s -= off / cubicSlope(s);
    }
    return s >= low && s <= high ? s : 0.5 * (low + high);
}

// Finds the end of the piece at hand, which is no longer than a length.
void findPieceEnd(float mostLength)
{
    pieceEnd = piece < turns.x ? turns.x : piece < turns.y ? turns.y : 1.0;
    float here = cubicAt(piece), last = pieceEnd < 1.0 ? cubicAt(pieceEnd) : valueAtEnd;
    rises = last > here;
    float corner = rises ? inInterval.y : inInterval.x;
    passesCorner = rises ? last > corner : last < corner;
    bool before = rises ? here < corner : here > corner;
    float root = cubicRoot(corner, piece, here, pieceEnd, last);
    pieceEnd = passesCorner ? (before ? root : piece) : pieceEnd;
    float longest = piece + mostLength / max(cellEnd - cellBegin, 1e-30);
    passesCorner = passesCorner && pieceEnd <= longest;
    pieceEnd = min(pieceEnd, longest);
}

// On to the next piece of the cell.
void leavePiece()
{
    piece = pieceEnd;
    if (passesCorner) takeInterval(clamp(interval + (rises ? 1 : -1), 0, intervals - 1));
}

#endif

#ifdef MEMBER
float pieceDepth; // where the piece at hand ends

void findPart(float tNear, float tFar, inout vec2 all)
{
    findRegion(tNear, tFar, all);
    beginCells(memberOrigin, memberDirection, shown.x);
    pieceDepth = shown.x;
#ifdef CORNERS
    piece = pieceEnd = 1.0;
    passesCorner = false;
    valueAtEnd = fractionAt(shown.x);
    findInterval(valueAtEnd);
#else
    takeInterval(1); // between those of values beyond the table
#endif
}

// Steps end where pieces do.
void cutStep(float t, inout float end)
{
    bool within = t >= shown.x && t < shown.y;
    if (within && pieceDepth <= t) {
#ifdef CORNERS
        leavePiece();
        if (piece >= 1.0) enterCell(shown.y);
        findPieceEnd(longestPart(unitsPerDepth, cellEnd - cellBegin));
        pieceDepth = pieceEnd < 1.0 ? mix(cellBegin, cellEnd, pieceEnd) : cellEnd;
        COUNT_PIECE
#else
        passCell(min(shown.y, cellEnd + longestPart(unitsPerDepth, 1.0 / length(cellRate))));
        pieceDepth = cellEnd;
        COUNT_PIECE
#endif
    }
    end = min(end, within ? pieceDepth : t < shown.x ? shown.x : 1e30);
#ifdef PAINTED
    end = nextCut(memberOrigin, memberDirection, t, end);
#endif
}

// Adds to a point of a step: extinction times colour, and extinction, per unit of depth.
void addPoint(float t, float begin, float end, inout vec4 sum)
{
    if (t < shown.x || t >= shown.y) return;
#ifdef CORNERS
    vec4 c = inIntervalAt(cubicAt((t - cellBegin) / max(cellEnd - cellBegin, 1e-30)));
#else
    vec4 c = inIntervalAt(fractionAt(t));
#endif
    c.a *= keptAbout(memberOrigin, memberDirection, 0.5 * (begin + end), end - begin);
    addClassified(c, cellPlace(t), t, sum);
}

// Adds to both points of a step.
void addPoints(float begin, float end, inout vec4 first, inout vec4 second)
{
    addPoint(mix(begin, end, GAUSS), begin, end, first);
    addPoint(mix(end, begin, GAUSS), begin, end, second);
}
float surfaceOnRay() { return 1e30; }
void addSurface(float t, inout vec3 color, inout float through) {}
#else
// Colour and extinction of a point, with the scene's light, paint and fog.
vec4 pointInScene(vec3 origin, vec3 direction, float value, float t)
{
    vec4 c = inIntervalAt(value);
#ifdef TETRAHEDRA
    c = ofVertices(c, t);
#endif
#ifdef SHADING
    c = lit(c, cellPlace(t), t);
#endif
#ifdef PAINTED
    c.rgb = painted(c.rgb, origin + t * direction);
#endif
    c.rgb = fogged(c.rgb, t);
    return c;
}

// Adds a piece between two depths, with the values at the points of Gauss's rule.
void addPiece(vec3 origin, vec3 direction, vec2 values, float begin, float end, float unitsPerDepth, inout vec4 light)
{
    float length = end - begin;
    vec4 first = pointInScene(origin, direction, values.x, begin + GAUSS * length);
    vec4 second = pointInScene(origin, direction, values.y, end - GAUSS * length);
    float units = length * unitsPerDepth * keptUntil(cutPoint(origin, direction, end));
    light += (1.0 - light.a) * lightOfPiece(first, second, units);
}

// Light of the part of the ray in the brick, front to back: premultiplied colour, opacity.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
#ifdef SKIPPING
    brick = occupiedPart(VOXEL_RAY(origin, direction), max(tNear, brick.x), min(tFar, brick.y));
#endif
    float begin = max(tNear, brick.x), end = min(tFar, brick.y), unitsPerDepth = length(frameToUnits * direction);
    vec4 light = vec4(0.0);
    if (!(begin < end)) return light;
    beginCells(VOXEL_RAY(origin, direction), begin);
    beginCut(cutPoint(origin, direction, begin));
#ifdef CORNERS
    valueAtEnd = fractionAt(begin);
    findInterval(valueAtEnd);
    piece = 1.0;
    // One loop for both: on llvmpipe bodies of inner loops are run once more than any ray wants.
    for (int i = 0; i < MOST_PIECES && (piece < 1.0 || cellEnd < end) && light.a < 1.0 - opaqueEnough; ++i) {
        if (piece >= 1.0) enterCell(end);
        findPieceEnd(longestPart(unitsPerDepth, cellEnd - cellBegin));
        float part = pieceEnd - piece, length = cellEnd - cellBegin;
        vec2 values = vec2(cubicAt(piece + GAUSS * part), cubicAt(pieceEnd - GAUSS * part));
        addPiece(origin, direction, values, cellBegin + piece * length, cellBegin + pieceEnd * length,
                 unitsPerDepth, light);
        leavePiece();
        COUNT_PIECE
    }
#else
    takeInterval(1); // between those of values beyond the table
    for (int i = 0; i < MOST_PIECES && cellEnd < end && light.a < 1.0 - opaqueEnough; ++i) {
        passCell(min(end, cellEnd + longestPart(unitsPerDepth, 1.0 / length(cellRate))));
        float length = cellEnd - cellBegin;
#ifdef NEAREST
        vec2 values = vec2(fractionAt(0.5 * (cellBegin + cellEnd)));
#else
        vec2 values = fractionsAt(vec3(cellBegin + GAUSS * length, cellEnd - GAUSS * length, cellEnd)).xy;
#endif
        COUNT_PIECE
        addPiece(origin, direction, values, cellBegin, cellEnd, unitsPerDepth, light);
    }
#endif
    return light;
}
#endif

#elif defined(MEMBER)
// One sample stands for both points.
void addPoints(float begin, float end, inout vec4 first, inout vec4 second)
{
    vec4 sum = vec4(0.0);
    addLight(0.5 * (begin + end), end - begin, sum);
    first += sum;
    second += sum;
}
#endif
