// Colour and extinction of a point or a piece of a ray, shared by slices and slabs.

#ifdef VOXELS
#ifndef RGBA
uniform sampler2D lookupTable; // r, g, b, extinction in bits (-log2 of transmittance) per opacity unit
uniform vec2 valueToTable;     // texel -> coordinate in the table
#endif

// rgb: emitted colour; a: extinction, bits per opacity unit.
vec4 classifyTexel(TEXEL texel)
{
#ifdef RGBA
    return vec4(texel.rgb, -log2(max(1.0 - texel.a, 5.9604645e-8)));
#elif defined(PREINTEGRATED)
    return textureLod(lookupTable, vec2(texel * valueToTable.x + valueToTable.y, 0.25), 0.0);
#else
    return textureLod(lookupTable, vec2(texel * valueToTable.x + valueToTable.y, 0.5), 0.0);
#endif
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

vec4 classify(vec3 voxelCoordinate)
{
#ifndef VOXELS
    return vec4(1.0, 1.0, 1.0, 1.0);
#elif defined(BEFORE)
    ivec3 cell;
    vec3 f;
    cellAt(voxelCoordinate, cell, f);
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
    return classifyTexel(voxelAt(voxelCoordinate));
#endif
}

#ifdef PREINTEGRATED
uniform vec2 tableEnds;           // coordinates of the outermost texels' centres
uniform float tableTexel;         // distance between texels
uniform vec4 tableLow, tableHigh; // extinction times colour, extinction: beyond the ends

// The table's integral up to a coordinate.
vec4 tableIntegral(float x)
{
    return textureLod(lookupTable, vec2(x, 0.75), 0.0) + min(x - tableEnds.x, 0.0) * tableLow +
           max(x - tableEnds.y, 0.0) * tableHigh;
}

float tableCoordinate(vec3 voxelCoordinate)
{
    return voxelAt(voxelCoordinate) * valueToTable.x + valueToTable.y;
}

// Mean over the values that a piece of the ray runs through, from one table coordinate to another.
vec4 classifyRun(float x0, vec4 integral0, float x1, vec4 integral1)
{
    float run = x1 - x0;
    // Within a texel the table is as good, and a difference of integrals would lose its digits.
    if (abs(run) <= tableTexel)
        return textureLod(lookupTable, vec2(0.5 * (x0 + x1), 0.25), 0.0);
    vec4 mean = max((integral1 - integral0) / run, 0.0);
    return vec4(mean.rgb / max(mean.a, 1e-12), mean.a);
}
#endif
