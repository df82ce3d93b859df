// Colour and extinction of a point or a piece of a ray, shared by slices and slabs.

#ifdef VOXELS
#ifdef CELLS
uniform samplerBuffer lookupTable; // see core/transfer/IntervalTable.h
uniform vec2 valueToEntry;         // texel -> fraction of the range
uniform int intervals;

// The interval of the table that the value is in.
int interval;
vec4 inInterval; // first and last value, first entry, entries per value

float mostExtinction;

void takeInterval(int i)
{
    interval = i;
    inInterval = texelFetch(lookupTable, 2 * i);
    mostExtinction = texelFetch(lookupTable, 2 * i + 1).r;
}

void findInterval(float value)
{
    int low = 0, high = intervals - 1;
    for (int i = 0; i < 24 && low < high; ++i) {
        int middle = (low + high + 1) / 2;
        bool below = value < texelFetch(lookupTable, 2 * middle).r;
        low = below ? low : middle;
        high = below ? middle - 1 : high;
    }
    takeInterval(low);
}

// Colour and extinction of a value, which is held to the interval.
vec4 inIntervalAt(float value)
{
    float entry = inInterval.z + max(clamp(value, inInterval.x, inInterval.y) - inInterval.x, 0.0) * inInterval.w;
    int i = int(entry);
    return mix(texelFetch(lookupTable, i), texelFetch(lookupTable, i + 1), entry - float(i));
}

#elif !defined(RGBA)
uniform samplerBuffer lookupTable; // r, g, b, extinction in bits (-log2 of transmittance) per opacity unit
uniform vec2 valueToEntry;         // texel -> entry of the table
uniform float lastEntry;

vec4 entryAt(float entry)
{
    float held = clamp(entry, 0.0, lastEntry);
#ifdef SMOOTH_TABLE
    int low = int(held); // one more texel than entries, for the last
    return mix(texelFetch(lookupTable, low), texelFetch(lookupTable, low + 1), fract(held));
#else
    return texelFetch(lookupTable, int(held + 0.5));
#endif
}
#endif

// rgb: emitted colour; a: extinction, bits per opacity unit.
vec4 classifyTexel(TEXEL texel)
{
#ifdef RGBA
    return vec4(texel.rgb, -log2(max(1.0 - texel.a, 5.9604645e-8)));
#elif defined(CELLS)
    float fraction = texel * valueToEntry.x + valueToEntry.y;
    findInterval(fraction);
    return inIntervalAt(fraction);
#else
    return entryAt(texel * valueToEntry.x + valueToEntry.y);
#endif
}
#endif

#ifdef SCALARS
vec4 classifyTexel(float fraction)
{
    vec4 c = pointColor(fraction);
    return vec4(c.rgb, extinctionOf(c.a));
}
#endif

#ifdef BEFORE
// Adds one classified sample: extinction times colour, and extinction.
void addSample(ivec3 i, float weight, inout vec4 sum)
{
    vec4 c = classifyTexel(texelAt(i));
    sum += weight * vec4(c.rgb * c.a, c.a);
}
#endif

vec4 classify(vec3 place)
{
#ifdef SCALARS
    return classifyTexel(voxelAt(place));
#elif !defined(VOXELS)
    return vec4(1.0, 1.0, 1.0, 1.0);
#elif defined(BEFORE)
    ivec3 cell;
    vec3 f;
    cellAt(place, cell, f);
    vec4 sum = vec4(0.0);
#ifdef CUBIC
    vec4 wx = cubicWeights(f.x), wy = cubicWeights(f.y), wz = cubicWeights(f.z);
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i)
                addSample(cell + ivec3(i, j, k) - 1, wx[i] * wy[j] * wz[k], sum);
#else
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                addSample(cell + ivec3(i, j, k),
                          (i == 1 ? f.x : 1.0 - f.x) * (j == 1 ? f.y : 1.0 - f.y) *
                              (k == 1 ? f.z : 1.0 - f.z),
                          sum);
#endif
    return sum.a > 0.0 ? vec4(max(sum.rgb, 0.0) / sum.a, sum.a) : vec4(0.0);
#else
    return classifyTexel(voxelAt(place));
#endif
}

#ifdef PREINTEGRATED
uniform vec4 tableLow, tableHigh; // extinction times colour, extinction: beyond the ends

// The entry nearest to the value at a place; beyond the table's ends too.
float tableEntry(vec3 place)
{
    return floor(voxelAt(place) * valueToEntry.x + valueToEntry.y + 0.5);
}

// The same, but not equal to the one before where integrals alone tell what lies between.
float tableEntryAfter(float before, vec3 place)
{
    float entry = tableEntry(place);
#ifndef SHORT_RUNS
    entry += float(entry == before);
#endif
    return entry;
}

// The table's integral from its first entry to another.
vec4 tableIntegral(float entry)
{
    float held = clamp(entry, 0.0, lastEntry);
    return texelFetch(lookupTable, int(held + lastEntry + 1.5)) + min(entry, 0.0) * tableLow +
           max(entry - lastEntry, 0.0) * tableHigh;
}

// Mean over the entries that a piece of the ray runs through.
vec4 classifyRun(float entry0, vec4 integral0, float entry1, vec4 integral1)
{
    float run = entry1 - entry0;
#ifdef SHORT_RUNS
    // In a short run the table is as good, and a difference of integrals would lose its digits.
    if (abs(run) <= 4.0) return entryAt(0.5 * (entry0 + entry1));
#endif
    vec4 mean = max((integral1 - integral0) / run, 0.0);
    return vec4(mean.rgb / max(mean.a, 1e-12), mean.a);
}
#endif
