// Tetrahedra on the pixel's ray, one after another, over the faces that they share: see core/geometry/TetraGraph.h. Corners
// are seen along the ray, which goes through the origin of the plane across it; the face that it leaves by is the one
// that the origin lies in, and its weights there are areas. So what lies on a face is computed once, for both sides.

uniform usamplerBuffer tetraGraph;   // words of a core::TetraGraph
uniform samplerBuffer tetraPositions; // frame
#ifdef SCALARS
uniform samplerBuffer tetraScalars; // fractions of the table's range, by vertex or tetrahedron; 3e38: none
#endif
#ifdef PLACES
uniform samplerBuffer tetraPlaces; // voxel coordinates
#endif
#ifdef VERTEX_COLORS
uniform samplerBuffer tetraColors; // straight RGBA
#endif
#ifdef FIELDS
uniform samplerBuffer tetraFields; // of one vertex after another
#endif
uniform samplerBuffer tetraBoxes; // of a tree over the outer faces
uniform int tetraFacesBegin;      // word
uniform int tetraFaceCount, tetraLeafCount, tetraLeafFaces;
uniform int mostTetrahedra; // on a ray
uniform float tetraSize;    // frame

vec3 acrossU, acrossV, alongRay; // frame -> the plane across the ray, and depth
vec3 walkOrigin, walkDirection;  // the ray

// What is known at a point: a vertex, or where the ray meets a face.
struct Known
{
    float depth;
#ifdef SCALARS
    float scalar;
#endif
#ifdef PLACES
    vec3 place;
#endif
#ifdef VERTEX_COLORS
    vec4 color;
#endif
#ifdef FIELDS
    float fields[FIELDS];
#endif
};

struct Corner
{
    uint vertex;
    vec2 across;
    Known known;
};

uint word(int i) { return texelFetch(tetraGraph, i).r; }

float crossed(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

Corner cornerOf(uint vertex)
{
    vec3 p = texelFetch(tetraPositions, int(vertex)).xyz - walkOrigin;
    Corner c;
    c.vertex = vertex;
    c.across = vec2(dot(acrossU, p), dot(acrossV, p));
    c.known.depth = dot(alongRay, p);
#if defined(SCALARS) && !defined(CELL_SCALARS)
    c.known.scalar = texelFetch(tetraScalars, int(vertex)).r;
#endif
#ifdef PLACES
    c.known.place = texelFetch(tetraPlaces, int(vertex)).xyz;
#endif
#ifdef VERTEX_COLORS
    c.known.color = texelFetch(tetraColors, int(vertex));
#endif
#ifdef FIELDS
    for (int i = 0; i < FIELDS; ++i) c.known.fields[i] = texelFetch(tetraFields, int(vertex) * FIELDS + i).r;
#endif
    return c;
}

// Where the ray meets a face.
Known inFace(Corner a, Corner b, Corner c)
{
    vec3 w = max(vec3(crossed(b.across, c.across), crossed(c.across, a.across), crossed(a.across, b.across)), 0.0);
    float sum = w.x + w.y + w.z;
    w = sum > 0.0 ? w * (1.0 / sum) : vec3(1.0 / 3.0);
    Known k;
#define MEET(field) k.field = w.x * a.known.field + w.y * b.known.field + w.z * c.known.field
    MEET(depth);
#if defined(SCALARS) && !defined(CELL_SCALARS)
    MEET(scalar);
#endif
#ifdef PLACES
    MEET(place);
#endif
#ifdef VERTEX_COLORS
    MEET(color);
#endif
#ifdef FIELDS
    for (int i = 0; i < FIELDS; ++i) MEET(fields[i]);
#endif
    return k;
}

// The walk: the tetrahedron that lies ahead of the face, -1 outside; its part of the ray; and the last outer face that was
// come in by. The parts are those that no part before has.
int tetrahedron;
Corner corner0, corner1, corner2; // of the face, counter-clockwise
Known entered, left;
bool hasPart; // there is something between those two
int walked;
float lastDepth; // of the last outer face
int lastFace;
float walkedUntil; // depth
float partBegin;   // where the part begins, which may be later than where the tetrahedron does
#if defined(SHADING) && (defined(PLACES) || defined(SCALARS))
mat3 placesToFrame; // gradient by place -> gradient in the frame
#endif

// How far a depth is through the tetrahedron.
float shareOfPart(float t)
{
    return clamp((t - entered.depth) / max(left.depth - entered.depth, 1e-30), 0.0, 1.0);
}

#ifdef VERTEX_COLORS
vec4 colorOnRay(float t) { return mix(entered.color, left.color, shareOfPart(t)); }
#endif

void beginWalk(vec3 origin, vec3 direction)
{
    walkOrigin = origin;
    walkDirection = direction;
    // The least of its components is replaced: never parallel.
    vec3 size = abs(direction);
    vec3 other = size.x <= size.y && size.x <= size.z ? vec3(1.0, 0.0, 0.0)
                 : size.y <= size.z                   ? vec3(0.0, 1.0, 0.0)
                                                      : vec3(0.0, 0.0, 1.0);
    acrossU = normalize(cross(other, direction));
    acrossV = normalize(cross(direction, acrossU));
    alongRay = direction / dot(direction, direction);
    // A little beside edges and vertices that the ray would meet exactly, as it does in regular meshes.
    walkOrigin += (1.3e-7 * acrossU + 0.9e-7 * acrossV) * tetraSize;
    tetrahedron = -1;
    walked = 0;
    lastDepth = walkedUntil = -1e30;
    lastFace = -1;
    hasPart = false;
    entered.depth = left.depth = -1e30;
}

// Whether the ray comes in by an outer face after the last one, and before `best`.
void tryFace(int face, inout float best, inout int bestFace)
{
    int at = tetraFacesBegin + 4 * face;
    // From outside they are counter-clockwise, and so clockwise along the ray.
    Corner a = cornerOf(word(at)), b = cornerOf(word(at + 2)), c = cornerOf(word(at + 1));
    vec3 w = vec3(crossed(b.across, c.across), crossed(c.across, a.across), crossed(a.across, b.across));
    float sum = w.x + w.y + w.z;
    float depth = dot(w, vec3(a.known.depth, b.known.depth, c.known.depth)) / max(sum, 1e-30);
    bool hit = all(greaterThanEqual(w, vec3(0.0))) && sum > 0.0;
    bool later = depth > lastDepth || (depth == lastDepth && face > lastFace);
    bool first = depth < best || (depth == best && face < bestFace);
    if (hit && later && first) {
        best = depth;
        bestFace = face;
    }
}

// Goes on to the next outer face that the ray comes in by. The tree is complete, so that its nodes need no pointers: after
// node n and all below it comes n + 1, or the parent's next, and so on up.
bool enterMesh()
{
    float best = 1e30;
    int bestFace = -1, node = 1;
    for (;;) {
        int first = 0, end = 0;
        for (;;) { // on to a leaf that may hold it
            vec2 span = boxSegment(texelFetch(tetraBoxes, 2 * node).xyz, texelFetch(tetraBoxes, 2 * node + 1).xyz,
                                   walkOrigin, walkDirection);
            bool meets = span.x <= span.y && span.y >= lastDepth && span.x <= best;
            bool leaf = meets && node >= tetraLeafCount;
            if (leaf) {
                first = (node - tetraLeafCount) * tetraLeafFaces;
                end = min(first + tetraLeafFaces, tetraFaceCount);
            }
            int next = node + 1;
            int up = (floatBitsToInt(float(next & -next)) >> 23) - 127; // zeros at the end of it
            node = meets && !leaf ? 2 * node : next >> up;
            if (leaf || node == 1) break;
        }
        for (int face = first; face < end; ++face) tryFace(face, best, bestFace);
        if (node == 1) break;
    }
    bool found = bestFace >= 0;
    if (found) {
        lastDepth = best;
        lastFace = bestFace;
        int at = tetraFacesBegin + 4 * bestFace;
        corner0 = cornerOf(word(at));
        corner1 = cornerOf(word(at + 2));
        corner2 = cornerOf(word(at + 1));
        tetrahedron = int(word(at + 3));
        left = inFace(corner0, corner1, corner2);
        hasPart = false;
#ifdef CELL_SCALARS
        left.scalar = 0.0;
#endif
    }
    return found;
}

#if defined(SHADING) && (defined(PLACES) || defined(SCALARS))
// Places are linear in a tetrahedron.
void findGradientFrame(Corner apex)
{
    mat3 edges = mat3(vec3(corner0.across, corner0.known.depth), vec3(corner1.across, corner1.known.depth),
                      vec3(corner2.across, corner2.known.depth));
    vec3 from = vec3(apex.across, apex.known.depth);
    edges -= mat3(from, from, from);
    // Edge differences -> gradient along the ray's axes; flat ones have none.
    mat3 rows = abs(determinant(edges)) > 1e-30 ? inverse(transpose(edges)) : mat3(0.0);
    mat3 axes = mat3(acrossU, acrossV, alongRay);
#ifdef PLACES
    mat3 places = transpose(mat3(corner0.known.place - apex.known.place, corner1.known.place - apex.known.place,
                                 corner2.known.place - apex.known.place));
    placesToFrame = axes * rows * places;
#elif !defined(CELL_SCALARS)
    vec3 scalars = vec3(corner0.known.scalar, corner1.known.scalar, corner2.known.scalar) - apex.known.scalar;
    placesToFrame = mat3(axes * (rows * scalars), vec3(0.0), vec3(0.0));
#else
    placesToFrame = mat3(0.0);
#endif
}
#endif

// Through the tetrahedron ahead, to the face that the ray leaves it by. Signs choose the face, so that there always is
// one, however thin the tetrahedron.
void crossTetrahedron()
{
    int at = 5 * tetrahedron;
    Corner apex = cornerOf(word(at) ^ corner0.vertex ^ corner1.vertex ^ corner2.vertex);
#if defined(SHADING) && (defined(PLACES) || defined(SCALARS))
    findGradientFrame(apex);
#endif
    float side0 = crossed(corner0.across, apex.across), side1 = crossed(corner1.across, apex.across),
          side2 = crossed(corner2.across, apex.across);
    uint dropped;
    if (side0 >= 0.0 && side2 <= 0.0) {
        dropped = corner1.vertex;
        corner1 = apex;
    } else if (side1 >= 0.0 && side0 <= 0.0) {
        dropped = corner2.vertex;
        corner2 = apex;
    } else {
        dropped = corner0.vertex;
        corner0 = apex;
    }
    int rank = int(dropped > corner0.vertex) + int(dropped > corner1.vertex) + int(dropped > corner2.vertex);
    entered = left;
    left = inFace(corner0, corner1, corner2);
    partBegin = max(entered.depth, walkedUntil);
    hasPart = left.depth > partBegin;
#ifdef CELL_SCALARS
    entered.scalar = left.scalar = texelFetch(tetraScalars, tetrahedron).r;
#endif
#ifdef SCALARS
    // One of the two has a part in each corner.
    hasPart = hasPart && max(entered.scalar, left.scalar) < 1e31;
#endif
    walkedUntil = max(walkedUntil, left.depth);
    tetrahedron = int(word(at + 1 + rank)); // -1 outside
    ++walked;
}

#ifdef WHOLE_RUNS
// All that lies between outer faces.
void crossMesh()
{
    Known first = left;
    float begin = max(first.depth, walkedUntil);
    do crossTetrahedron(); while (tetrahedron >= 0 && walked < mostTetrahedra);
    entered = first;
    partBegin = begin;
    hasPart = left.depth > begin;
}
#endif
