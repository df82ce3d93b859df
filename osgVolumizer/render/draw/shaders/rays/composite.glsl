// Light emitted and absorbed along the ray.

#define EMPTY_RAY vec4(0.0)
#define JOIN_RAY(front, behind) (front + (1.0 - front.a) * behind)
#define RAY_DONE(light) (light.a >= 1.0 - opaqueEnough)

#ifdef TETRAHEDRA
// What vertices make of a colour and extinction.
vec4 ofVertices(vec4 c, float t)
{
#ifdef VERTEX_COLORS
#if defined(VOXELS) || defined(SCALARS)
    c *= colorOnRay(t);
#else
    c = colorOnRay(t);
    c.a = extinctionOf(c.a);
#endif
#endif
#ifdef FIELDS
    float fields[FIELDS];
    for (int i = 0; i < FIELDS; ++i) fields[i] = mix(entered.fields[i], left.fields[i], shareOfPart(t));
    c = shadeFields(vec4(c.rgb, 1.0 - exp2(-c.a)), fields);
    c.a = extinctionOf(c.a);
#endif
    return c;
}
#endif

#if defined(MEMBER) && defined(TETRAHEDRA)
// Adds to a step about t: extinction times colour, and extinction, per unit of depth.
void addLight(float t, float dt, inout vec4 sum)
{
    if (!hasPart || t < partBegin || t >= left.depth || t < segment.x || t >= segment.y) return;
    vec3 place;
#if defined(PLACES) || defined(SCALARS)
    takeVoxelRay();
#endif
#ifdef VOXELS
    vec3 voxel = voxelOnRay(memberOrigin, memberDirection, t);
    if (any(lessThan(voxel, clipMin)) || any(greaterThan(voxel, clipMax))) return;
#endif
    place = placeOnRay(memberOrigin, memberDirection, t);
    vec4 c = ofVertices(classify(place), t);
    c.a *= keptAbout(memberOrigin, memberDirection, t, dt);
    addClassified(c, place, t, sum);
}
float surfaceOnRay() { return 1e30; }
void addSurface(float t, inout vec3 color, inout float through) {}

#elif defined(CELLS)
// See cells.glsl.

#elif defined(MEMBER) && defined(PREINTEGRATED)
float knownDepth = -1e30; // where the entry and the integral of the last step's end are known
float knownEntry;
vec4 knownIntegral;

// Adds to a step of length dt about t: extinction times colour, and extinction, per unit of depth.
void addLight(float t, float dt, inout vec4 sum)
{
    float begin = t - 0.5 * dt, end = t + 0.5 * dt;
    if (end <= shown.x || begin >= shown.y || t < segment.x || t >= segment.y) return;
    vec3 place = placeOrigin + t * placeRate, halfStep = 0.5 * dt * placeRate;
    if (abs(begin - knownDepth) > 1e-3 * dt) {
        knownEntry = tableEntry(place - halfStep);
        knownIntegral = tableIntegral(knownEntry);
    }
    float entry = tableEntryAfter(knownEntry, place + halfStep);
    vec4 integral = tableIntegral(entry);
    vec4 c = classifyRun(knownEntry, knownIntegral, entry, integral);
    knownDepth = end;
    knownEntry = entry;
    knownIntegral = integral;
    c.a *= keptAbout(memberOrigin, memberDirection, t, dt);
    addClassified(c, place, t, sum);
}
float surfaceOnRay() { return 1e30; }
void addSurface(float t, inout vec3 color, inout float through) {}

#elif defined(MEMBER)
// Adds to a step about t: extinction times colour, and extinction, per unit of depth.
void addLight(float t, float dt, inout vec4 sum)
{
    if (t < shown.x || t >= shown.y) return;
    vec3 place = placeOrigin + t * placeRate;
    vec4 c = classify(place);
    c.a *= keptAbout(memberOrigin, memberDirection, t, dt);
    addClassified(c, place, t, sum);
}
float surfaceOnRay() { return 1e30; }
void addSurface(float t, inout vec3 color, inout float through) {}

#elif defined(SLAB) && defined(PREINTEGRATED)
uniform float stride; // steps taken as one: see BrickBatch

// Adds the piece of the ray from the last place to this one, where the depth is t; false where it is to be a shorter one.
bool addRun(vec3 origin, vec3 direction, float t, vec3 place, float depth, float unitsPerDepth,
            inout float entry, inout vec4 integral, inout vec4 light)
{
    float nextEntry = tableEntryAfter(entry, place);
    vec4 nextIntegral = tableIntegral(nextEntry);
    vec4 c = classifyRun(entry, integral, nextEntry, nextIntegral);
    COUNT_SAMPLE
#ifdef ADAPTIVE
    c.a *= keptAbout(origin, direction, t - 0.5 * depth, depth);
#else
    c.a *= keptUntil(cutPoint(origin, direction, t));
#endif
#ifdef TETRAHEDRA
    c = ofVertices(c, t - 0.5 * depth);
#endif
    float next = light.a * exp2(-c.a * (depth * unitsPerDepth));
#ifdef ADAPTIVE
    if (!suitsStep(light.a - next)) return false;
#endif
#ifdef SHADING
    c = lit(c, place - 0.5 * depth * VOXEL_RATE(direction), t - 0.5 * depth);
#endif
#ifdef PAINTED
    c.rgb = painted(c.rgb, origin + (t - 0.5 * depth) * direction);
#endif
    c.rgb = fogged(c.rgb, t - 0.5 * depth);
    light = vec4(light.rgb + (light.a - next) * c.rgb, next);
    entry = nextEntry;
    integral = nextIntegral;
    return true;
}

// Light of the steps that reach into what the brick shows, front to back: premultiplied colour, opacity. The ends
// of steps are where the table is asked, so steps are cut at the brick's ends.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 shown)
{
    float count = stepsOf(direction, tNear, tFar), dt = (tFar - tNear) / count;
    vec2 brick = boxSegment(brickMin, brickMax, VOXEL_RAY(origin, direction));
    float start = max(tNear, brick.x), stop = min(tFar, brick.y);
#ifdef SKIPPING
    shown = occupiedPart(VOXEL_RAY(origin, direction), max(start, shown.x), min(stop, shown.y));
#endif
    float i = max(0.0, floor((shown.x - tNear) / dt));
    float last = min(count, ceil((shown.y - tNear) / dt));
    float unitsPerDepth = length(frameToUnits * direction);
    vec3 rate = VOXEL_RATE(direction);
    vec4 light = vec4(0.0, 0.0, 0.0, 1.0); // colour, transmittance
    if (stride > 1.0 && i < last) {
        // Equal steps from end to end.
        float longer = ceil((last - i) / stride), end = min(stop, tNear + last * dt);
        tNear = max(start, tNear + i * dt);
        dt = (end - tNear) / longer;
        i = 0.0;
        last = longer;
    }
    float t = max(start, tNear + i * dt);
    vec3 first = placeOnRay(origin, direction, t), place = first; // as for steps without integrals
    float entry = tableEntry(place);
    vec4 integral = tableIntegral(entry);
#ifdef ADAPTIVE
    float begin = t, all = min(stop, tNear + last * dt) - begin, taken = 0.0; // periods
    if (stride > 1.0) stretch = LONGEST_STRETCH; // of one value: all are as good
    if (all > 0.0) do {
        float ahead = taken * dt, length = stretch, depth = min(length * dt, all - ahead);
        place = first + (ahead + depth) * rate;
        bool added = addRun(origin, direction, begin + ahead + depth, place, depth, unitsPerDepth, entry, integral, light);
        taken += added ? length : 0.0;
    } while (taken * dt < all && light.a > opaqueEnough);
#else
    beginCut(cutPoint(origin, direction, t));
    float depth = min(stop, tNear + (i + 1.0) * dt) - t; // of the first step, which may be cut
    float ahead = depth; // of the first place
    place = first + ahead * rate;
    t += depth;
    for (int steps = int(last - i); steps > 0 && light.a > opaqueEnough; --steps) {
        addRun(origin, direction, t, place, depth, unitsPerDepth, entry, integral, light);
        depth = min(dt, stop - t); // of the last one, which may be cut too
        t += depth;
        ahead += depth;
        place = first + ahead * rate;
    }
#endif
    return vec4(light.rgb, 1.0 - light.a);
}

#elif defined(SLAB)
uniform float stride; // steps taken as one: see BrickBatch

// Light of the brick's steps, front to back: premultiplied colour, opacity.
vec4 march(vec3 origin, vec3 direction, float tNear, float tFar, vec2 brick)
{
    float count = stepsOf(direction, tNear, tFar), dt = (tFar - tNear) / count;
#ifdef SKIPPING
    brick = occupiedPart(VOXEL_RAY(origin, direction), max(tNear, brick.x), min(tFar, brick.y));
#endif
    float perDepth = count / (tFar - tNear);
    float i = max(0.0, ceil((brick.x - tNear) * perDepth - 0.5));
    float last = min(count, ceil((brick.y - tNear) * perDepth - 0.5)); // not one of the brick's
    if (stride > 1.0 && i < last) {
        // Equal steps from end to end.
        float longer = ceil((last - i) / stride);
        tNear += i * dt;
        dt *= (last - i) / longer;
        i = 0.0;
        last = longer;
    }
    vec3 rate = VOXEL_RATE(direction) * dt;
    float units = dt * length(frameToUnits * direction);
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    float t = tNear + (i + 0.5) * dt;
    // Places are counted from the first one: each sum of two is off by as much as all others, which adds up.
    vec3 first = placeOnRay(origin, direction, t), place = first;
    int steps = int(last - i);
    float taken = 0.0;
    beginCut(cutPoint(origin, direction, t - 0.5 * dt));
    if (steps > 0) do {
        vec4 c = classify(place);
        c.a *= keptUntil(cutPoint(origin, direction, t + 0.5 * dt));
#ifdef TETRAHEDRA
        c = ofVertices(c, t);
#endif
#ifdef SHADING
        c = lit(c, place, t);
#endif
#ifdef PAINTED
        c.rgb = painted(c.rgb, origin + t * direction);
#endif
        c.rgb = fogged(c.rgb, t);
        t += dt;
        COUNT_SAMPLE
        float next = transmittance * exp2(-c.a * units);
        color += (transmittance - next) * c.rgb;
        transmittance = next;
        taken += 1.0;
        place = first + taken * rate;
    } while (--steps > 0 && transmittance > opaqueEnough);
    return vec4(color, 1.0 - transmittance);
}

#else
#ifdef FOG
float sliceDepth() { return -eyePosition.z - fogDepth; }
#endif
vec4 slice(vec3 place, vec3 direction, float thickness)
{
#ifdef PREINTEGRATED
    // The layer's own ends; one frame unit of the ray is `direction`.
    vec3 halfRun = 0.5 * thickness * direction * VOXEL_LENGTH;
    float entry0 = tableEntry(place - halfRun);
    float entry1 = tableEntryAfter(entry0, place + halfRun);
    vec4 c = classifyRun(entry0, tableIntegral(entry0), entry1, tableIntegral(entry1));
#else
    vec4 c = classify(place);
#endif
#ifdef VERTEX_COLORS
#ifdef VOXELS
    c *= vertexColor;
#else
    c = vec4(vertexColor.rgb, -log2(max(1.0 - vertexColor.a, 5.9604645e-8)));
#endif
#endif
#ifdef SHADING
    vec3 directionEye = rayDirectionEye * vec3(windowPlace() - windowCenter, 1.0);
    c.rgb = shade(c.rgb, place, eyePosition, -normalize(directionEye));
#endif
#ifdef PAINTED
    c.rgb = painted(c.rgb, framePosition);
#endif
    c.rgb = fogged(c.rgb, sliceDepth());
    c.a *= kept;
    float units = thickness * length(frameToUnits * direction);
    float depth = 0.6931471806 * c.a * units; // optical
    // 1 - exp(-depth) without cancelling the digits of thin layers.
    float alpha =
        depth < 0.01 ? depth * (1.0 - depth * (0.5 - depth * 0.16666667)) : 1.0 - exp(-depth);
    return vec4(c.rgb * alpha, alpha);
}
#endif
