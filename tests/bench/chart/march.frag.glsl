// A plain march through a box of voxels: midpoint rule, equal steps, exact ends.
out vec4 fragColor;

uniform mat3 rayOrigin, rayDirection; // times (window x, y, 1): voxel frame
uniform vec3 boxMin, boxMax;
uniform float stepLength;
uniform sampler3D voxels;
uniform vec3 textureScale, textureOffset;
uniform sampler2D lookupTable;
uniform vec2 valueToTable;
uniform vec4 tableInfo; // texels, -, -, -

#ifdef TABLE_1D
uniform sampler1D lookupTable1D;
#endif
#ifdef TABLE_UBO
layout(std140) uniform Table { vec4 entries[1024]; };
#endif
#if defined(TABLE_BUFFER) || defined(AVG2D) || defined(AVG1D)
uniform samplerBuffer tableBuffer;
#endif

float fetchValue(vec3 p)
{
#ifdef FAKE_VOXELS
    return fract(p.x + p.y + p.z);
#elif defined(MANUAL)
    vec3 q = p * vec3(textureSize(voxels, 0)) - 0.5;
    vec3 f = fract(q);
    ivec3 i = ivec3(q);
    float a = texelFetch(voxels, i, 0).r, b = texelFetch(voxels, i + ivec3(1, 0, 0), 0).r;
    float c = texelFetch(voxels, i + ivec3(0, 1, 0), 0).r, d = texelFetch(voxels, i + ivec3(1, 1, 0), 0).r;
    float e = texelFetch(voxels, i + ivec3(0, 0, 1), 0).r, g = texelFetch(voxels, i + ivec3(1, 0, 1), 0).r;
    float h = texelFetch(voxels, i + ivec3(0, 1, 1), 0).r, k = texelFetch(voxels, i + ivec3(1, 1, 1), 0).r;
    vec4 z = mix(vec4(a, b, c, d), vec4(e, g, h, k), f.z);
    vec2 y = mix(z.xy, z.zw, f.y);
    return mix(y.x, y.y, f.x);
#elif defined(PACKED)
    vec3 q = p * vec3(textureSize(voxels, 0)) - 0.5;
    vec3 f = fract(q);
    ivec3 i = ivec3(q);
    vec4 z = mix(texelFetch(voxels, i, 0), texelFetch(voxels, i + ivec3(0, 0, 1), 0), f.z);
    vec2 y = mix(z.xy, z.zw, f.y);
    return mix(y.x, y.y, f.x);
#elif defined(VOXELS_LOD)
    return textureLod(voxels, p, 0.0).r;
#else
    return texture(voxels, p).r;
#endif
}

vec4 lookUp(float value)
{
#ifdef FAKE_TABLE
    return vec4(value, 1.0 - value, 0.5, 0.06 * value);
#elif defined(TABLE_1D)
    return textureLod(lookupTable1D, value * valueToTable.x + valueToTable.y, 0.0);
#elif defined(TABLE_NEAREST)
    return texelFetch(lookupTable, ivec2(int(value * tableInfo.y + tableInfo.z), 0), 0);
#elif defined(TABLE_BUFFER)
    return texelFetch(tableBuffer, int(value * tableInfo.y + tableInfo.z));
#elif defined(TABLE_FETCH_LINEAR)
    float x = value * tableInfo.y + (tableInfo.z - 0.5);
    int i = int(x);
    return mix(texelFetch(lookupTable, ivec2(i, 0), 0), texelFetch(lookupTable, ivec2(i + 1, 0), 0), x - float(i));
#elif defined(TABLE_UBO)
    float x = value * tableInfo.y + (tableInfo.z - 0.5);
    int i = int(x);
    return mix(entries[i], entries[i + 1], x - float(i));
#else
    return textureLod(lookupTable, vec2(value * valueToTable.x + valueToTable.y, 0.5), 0.0);
#endif
}

void main()
{
    vec3 window = vec3(gl_FragCoord.xy, 1.0);
    vec3 origin = rayOrigin * window, direction = rayDirection * window;
    vec3 safe = mix(direction, vec3(1e-30), equal(direction, vec3(0.0)));
    vec3 a = (boxMin - origin) / safe, b = (boxMax - origin) / safe;
    vec3 enter = min(a, b), leave = max(a, b);
    float tNear = max(max(enter.x, enter.y), enter.z), tFar = min(min(leave.x, leave.y), leave.z);
    if (tFar <= tNear) discard;
    float rayLength = length(direction);
    int n = int(ceil((tFar - tNear) * rayLength / stepLength));
    float dt = (tFar - tNear) / float(n);
    vec3 p = ((origin + (tNear + 0.5 * dt) * direction) * textureScale) + textureOffset;
    vec3 dp = dt * direction * textureScale;
    float scale = -dt * rayLength;

#if defined(AVG2D) && defined(FORMB)
    vec3 color = vec3(0.0);
    float T = 1.0;
    p = (origin + tNear * direction) * textureScale + textureOffset;
    const float N = float(AVG2D);
    float i0 = floor(fetchValue(p) * (N - 1.0) + 0.5);
    p += dp;
    for (int i = 0; i < n && T > 3e-5; ++i) {
        float i1 = floor(fetchValue(p) * (N - 1.0) + 0.5);
        vec4 c = texelFetch(tableBuffer, int(i0 * N + i1));
        float T1 = T * exp2(c.a * scale);
        color += (T - T1) * c.rgb;
        T = T1;
        i0 = i1;
        p += dp;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(AVG2D)
    // segments between samples; table of mean extinction and colour over [v0, v1]
    vec3 color = vec3(0.0);
    float T = 1.0;
    p = (origin + tNear * direction) * textureScale + textureOffset;
    const float N = float(AVG2D);
    int i0 = int(fetchValue(p) * (N - 1.0) + 0.5);
    for (int i = 0; i < n && T > 3e-5; ++i) {
        p += dp;
        int i1 = int(fetchValue(p) * (N - 1.0) + 0.5);
        vec4 c = texelFetch(tableBuffer, i0 * AVG2D + i1);
        float T1 = T * exp2(c.a * scale);
        color += (T - T1) * c.rgb;
        T = T1;
        i0 = i1;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(AVG1D)
    vec3 color = vec3(0.0);
    float T = 1.0;
    p = (origin + tNear * direction) * textureScale + textureOffset;
    float i0 = floor(fetchValue(p) * tableInfo.y + 0.5);
    vec4 g0 = texelFetch(tableBuffer, int(i0));
    p += dp;
    for (int i = 0; i < n && T > 3e-5; ++i) {
        float i1 = floor(fetchValue(p) * tableInfo.y + 0.5);
        i1 += i1 == i0 ? 1.0 : 0.0;
        vec4 g1 = texelFetch(tableBuffer, int(i1));
        vec4 c = (g1 - g0) / (i1 - i0); // extinction * colour, extinction: means
        float extinction = max(c.a, 1e-20);
        float T1 = T * exp2(extinction * scale);
        color += ((T - T1) / extinction) * c.rgb;
        T = T1;
        g0 = g1;
        i0 = i1;
        p += dp;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(LATTICE)
    // as the library did at first
    vec3 color = vec3(0.0);
    float T = 1.0;
    float stepDepth = stepLength / rayLength;
    float cell = floor(tNear / stepDepth) + 1.0;
    float t = tNear;
    for (int i = 0; i < 4096 && t < tFar; ++i) {
        float end = min(cell * stepDepth, tFar);
        vec4 c = lookUp(fetchValue((origin + direction * (0.5 * (t + end))) * textureScale + textureOffset));
        float through = exp2(-c.a * (end - t) * rayLength);
        color += T * (1.0 - through) * c.rgb;
        T *= through;
        if (T < 3e-5) break;
        t = max(t, end);
        cell += 1.0;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(LATTICE2)
    // first and last partial steps apart, whole ones between
    vec3 color = vec3(0.0);
    float T = 1.0;
    float stepDepth = stepLength / rayLength;
    float first = floor(tNear / stepDepth) + 1.0, last = ceil(tFar / stepDepth) - 1.0;
    int count = int(last - first) + 2;
    p = (origin + direction * ((first - 0.5) * stepDepth)) * textureScale + textureOffset;
    dp = stepDepth * direction * textureScale;
    float middle = -stepLength;
    for (int i = 0; i < count; ++i) {
        vec3 q = p;
        float h = middle;
        if (i == 0 || i == count - 1) {
            float t0 = max(tNear, (first - 1.0 + float(i)) * stepDepth);
            float t1 = min(tFar, (first + float(i)) * stepDepth);
            q = (origin + direction * (0.5 * (t0 + t1))) * textureScale + textureOffset;
            h = -(t1 - t0) * rayLength;
        }
        vec4 c = lookUp(fetchValue(q));
        float T1 = T * exp2(c.a * h);
        color += (T - T1) * c.rgb;
        T = T1;
        p += dp;
        if (T1 < 3e-5) break;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(LATTICE3)
    // clamped ends, ray in texture coordinates
    vec3 color = vec3(0.0);
    float T = 1.0;
    float stepDepth = stepLength / rayLength;
    float cell = floor(tNear / stepDepth) + 1.0;
    int count = int(ceil(tFar / stepDepth) - cell) + 1;
    vec3 o = origin * textureScale + textureOffset, d = 0.5 * direction * textureScale;
    float t = tNear, end = cell * stepDepth;
    for (int i = 0; i < count; ++i) {
        float e = min(end, tFar);
        vec4 c = lookUp(fetchValue(o + d * (t + e)));
        float T1 = T * exp2(c.a * (rayLength * (t - e)));
        color += (T - T1) * c.rgb;
        T = T1;
        t = e;
        end += stepDepth;
        if (T1 < 3e-5) break;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(L6)
    // lattice, exact ends, only the first and last step differ: lengths by clamping
    vec3 color = vec3(0.0);
    float T = 1.0;
    float stepDepth = stepLength / rayLength;
    float cell = floor(tNear / stepDepth) + 1.0;
    int count = int(ceil(tFar / stepDepth) - cell) + 1;
    vec3 o = origin * textureScale + textureOffset, d = 0.5 * direction * textureScale;
    float t = tNear, end = cell * stepDepth;
    for (int i = 0; i < count && T > 3e-5; ++i) {
        float e = min(end, tFar);
        vec4 c = lookUp(fetchValue(o + d * (t + e)));
        float T1 = T * exp2(c.a * (rayLength * (t - e)));
        color += (T - T1) * c.rgb;
        T = T1;
        t = e;
        end += stepDepth;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(L7)
    vec3 color = vec3(0.0);
    float T = 1.0;
    float end = tNear + dt, t = tNear;
    vec3 o = origin * textureScale + textureOffset, d = 0.5 * direction * textureScale;
    for (int i = 0; i < n && T > 3e-5; ++i) {
        float e = min(end, tFar);
        vec4 c = lookUp(fetchValue(o + d * (t + e)));
        float T1 = T * exp2(c.a * (rayLength * (t - e)));
        color += (T - T1) * c.rgb;
        T = T1;
        t = e;
        end += dt;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(L8)
    // lattice; p of whole steps runs along, ends by shifting p back
    vec3 color = vec3(0.0);
    float T = 1.0;
    float stepDepth = stepLength / rayLength;
    float cell = floor(tNear / stepDepth);
    int count = int(ceil(tFar / stepDepth) - cell);
    float lo = tNear / stepDepth - cell, hi = tFar / stepDepth - cell; // in steps
    p = (origin + direction * (cell * stepDepth)) * textureScale + textureOffset;
    dp = direction * stepDepth * textureScale;
    float x = 0.0;
    for (int i = 0; i < count && T > 3e-5; ++i) {
        float t0 = max(x, lo), t1 = min(x + 1.0, hi);
        vec4 c = lookUp(fetchValue(p + (0.5 * (t0 + t1)) * dp));
        float T1 = T * exp2(c.a * (stepLength * (t0 - t1)));
        color += (T - T1) * c.rgb;
        T = T1;
        x += 1.0;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(L9)
    // equal steps, but samples on a lattice moved per ray: position from float(i)
    vec3 color = vec3(0.0);
    float T = 1.0;
    vec3 o = origin * textureScale + textureOffset, d = direction * textureScale;
    float t = tNear + 0.5 * dt;
    for (int i = 0; i < n && T > 3e-5; ++i) {
        vec4 c = lookUp(fetchValue(o + d * t));
        float T1 = T * exp2(c.a * scale);
        color += (T - T1) * c.rgb;
        T = T1;
        t += dt;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(L4)
    // bare, but h by min
    vec3 color = vec3(0.0);
    float T = 1.0;
    float end = tNear + dt, t = tNear;
    for (int i = 0; i < n; ++i) {
        float e = min(end, tFar);
        vec4 c = lookUp(fetchValue(p));
        float T1 = T * exp2(c.a * (rayLength * (t - e)));
        color += (T - T1) * c.rgb;
        T = T1;
        t = e; end += dt; p += dp;
        if (T1 < 3e-5) break;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(L5)
    // bare, but lattice start: plain steps, no exact ends
    vec3 color = vec3(0.0);
    float T = 1.0;
    float stepDepth = stepLength / rayLength;
    float cell = floor(tNear / stepDepth);
    int count = int(ceil(tFar / stepDepth) - cell);
    p = (origin + direction * ((cell + 0.5) * stepDepth)) * textureScale + textureOffset;
    dp = direction * stepDepth * textureScale;
    for (int i = 0; i < count; ++i) {
        vec4 c = lookUp(fetchValue(p));
        float T1 = T * exp2(c.a * -stepLength);
        color += (T - T1) * c.rgb;
        T = T1;
        p += dp;
        if (T1 < 3e-5) break;
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(ONE_VEC)
    // color.rgb and transmittance in one accumulator
    vec4 sum = vec4(0.0, 0.0, 0.0, 1.0);
    for (int i = 0; i < n; ++i) {
        vec4 c = lookUp(fetchValue(p));
        float through = exp2(c.a * scale);
        float next = sum.a * through;
        sum.rgb += (sum.a - next) * c.rgb;
        sum.a = next;
        p += dp;
        if (next < 3e-5) break;
    }
    fragColor = vec4(sum.rgb, 1.0 - sum.a);
#elif defined(UNROLL)
    vec3 color = vec3(0.0);
    float T = 1.0;
    int i = 0;
    for (; i < n; i += UNROLL) {
#if UNROLL == 2
        vec4 c0 = lookUp(fetchValue(p));
        vec4 c1 = lookUp(fetchValue(p + dp));
        float s1 = i + 1 < n ? scale : 0.0;
        float T1 = T * exp2(c0.a * scale), T2 = T1 * exp2(c1.a * s1);
        color += (T - T1) * c0.rgb + (T1 - T2) * c1.rgb;
        T = T2;
        p += 2.0 * dp;
#else
        vec4 c0 = lookUp(fetchValue(p));
        vec4 c1 = lookUp(fetchValue(p + dp));
        vec4 c2 = lookUp(fetchValue(p + 2.0 * dp));
        vec4 c3 = lookUp(fetchValue(p + 3.0 * dp));
        float s1 = i + 1 < n ? scale : 0.0, s2 = i + 2 < n ? scale : 0.0, s3 = i + 3 < n ? scale : 0.0;
        float T1 = T * exp2(c0.a * scale), T2 = T1 * exp2(c1.a * s1), T3 = T2 * exp2(c2.a * s2), T4 = T3 * exp2(c3.a * s3);
        color += (T - T1) * c0.rgb + (T1 - T2) * c1.rgb + (T2 - T3) * c2.rgb + (T3 - T4) * c3.rgb;
        T = T4;
        p += 4.0 * dp;
#endif
#ifndef NO_EXIT
        if (T < 3e-5) break;
#endif
    }
    fragColor = vec4(color, 1.0 - T);
#elif defined(ZERO_SKIP)
    vec3 color = vec3(0.0);
    float T = 1.0;
    for (int i = 0; i < n; ++i) {
        float v = fetchValue(p);
        p += dp;
        if (v > 0.0) {
            vec4 c = lookUp(v);
            float T1 = T * exp2(c.a * scale);
            color += (T - T1) * c.rgb;
            T = T1;
            if (T1 < 3e-5) break;
        }
    }
    fragColor = vec4(color, 1.0 - T);
#else
    vec3 color = vec3(0.0);
    float T = 1.0;
#ifdef COUNT_DOWN
    while (n-- > 0) {
#elif defined(NO_EXIT)
    for (int i = 0; i < n; ++i) {
#else
    for (int i = 0; i < n && T > 3e-5; ++i) {
#endif
#ifdef FROM_ORIGIN
        vec4 c = lookUp(fetchValue(p + float(i) * dp));
#else
        vec4 c = lookUp(fetchValue(p));
        p += dp;
#endif
#ifdef PREMULTIPLIED
        float T1 = T * (1.0 - c.a);
        color += T * c.rgb;
#elif defined(RATIONAL)
        // (1 - x/2 + x^2/10 - x^3/120) / (1 + ...): exp(-x)
        float x = -c.a * scale * 0.69314718;
        float x2 = x * x;
        float T1 = T * ((1.0 + 0.1 * x2) - x * (0.5 + x2 * 0.0083333333)) / ((1.0 + 0.1 * x2) + x * (0.5 + x2 * 0.0083333333));
        color += (T - T1) * c.rgb;
#elif defined(CUBIC_EXP)
        float x = c.a * scale;
        float T1 = T * (1.0 + x * (0.69314718 + x * (0.24022651 + x * (0.05550411 + x * 0.00961813))));
        color += (T - T1) * c.rgb;
#else
        float T1 = T * exp2(c.a * scale);
        color += (T - T1) * c.rgb;
#endif
        T = T1;
#ifdef COUNT_DOWN
        if (T1 < 3e-5) break;
#endif
    }
    fragColor = vec4(color, 1.0 - T);
#endif
}
