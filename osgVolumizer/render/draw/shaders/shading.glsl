// Light from the scene on a point of the volume: Blinn-Phong, two-sided, in the eye frame (Blinn, "Models of
// light reflection for computer synthesized pictures", SIGGRAPH 1977).

#ifdef SHADING
#define MAXIMUM_LIGHTS 8
uniform int lightCount;
uniform vec4 lightPosition[MAXIMUM_LIGHTS]; // eye frame; w = 0: the direction to it
uniform vec3 lightAmbient[MAXIMUM_LIGHTS], lightDiffuse[MAXIMUM_LIGHTS], lightSpecular[MAXIMUM_LIGHTS];
uniform vec3 lightAttenuation[MAXIMUM_LIGHTS]; // constant, linear, quadratic, per eye unit
uniform vec4 lightSpot[MAXIMUM_LIGHTS];        // direction it shines to, cosine of its cone; -1: none
uniform float lightSpotExponent[MAXIMUM_LIGHTS];
uniform vec4 material; // ambient, diffuse, specular, shininess
uniform mat3 gradientToEye; // texels per voxel -> normal in the eye frame, in ranges per opacity unit
uniform mat3 rayOriginEye, rayDirectionEye; // times (dx, dy, 1)

#ifdef SCALARS
vec3 gradientAt(vec3 place) { return vec3(1.0, 0.0, 0.0); }
#elif defined(GRADIENT_TEXTURE)
uniform vec2 gradientDecode; // scale, offset

vec3 gradientAt(vec3 place)
{
#if defined(EXACT)
    ivec3 cell;
    vec3 f;
    cellAt(place, cell, f);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 8; ++i) {
        ivec3 step = ivec3(i & 1, (i >> 1) & 1, i >> 2), at = min(cell + step, textureSize(voxels, 0) - 1);
        vec3 w = mix(1.0 - f, f, vec3(step));
#define GRADIENT_OF(step) texelFetch(step, at, 0).rgb
        sum += w.x * w.y * w.z * OF_STEPS(GRADIENT_OF);
    }
    return sum * gradientDecode.x + gradientDecode.y;
#else
#ifdef FETCH
    place = (place + 0.5) / vec3(textureSize(voxels, 0));
#endif
    place = filterPlace(place, textureSize(voxels, 0));
#define GRADIENT_IN(step) textureLod(step, place, 0.0).rgb
    return OF_STEPS(GRADIENT_IN) * gradientDecode.x + gradientDecode.y;
#endif
}
#elif defined(CUBIC)
// Weights of the derivatives of what cubicWeights() are those of.
vec4 cubicSlopes(float f)
{
    return vec4((4.0 - 3.0 * f) * f - 1.0, (9.0 * f - 10.0) * f, (8.0 - 9.0 * f) * f + 1.0, (3.0 * f - 2.0) * f) * 0.5;
}

// The derivative of the interpolant: at samples, central differences.
vec3 gradientAt(vec3 place)
{
    ivec3 cell;
    vec3 f;
    cellAt(place, cell, f);
    vec4 wx = cubicWeights(f.x), wy = cubicWeights(f.y), wz = cubicWeights(f.z);
    vec4 sx = cubicSlopes(f.x), sy = cubicSlopes(f.y), sz = cubicSlopes(f.z);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            vec4 row;
            for (int i = 0; i < 4; ++i)
#ifdef RGBA
                row[i] = texelAt(cell + ivec3(i, j, k) - 1).a;
#else
                row[i] = texelAt(cell + ivec3(i, j, k) - 1);
#endif
            float value = dot(row, wx);
            sum += vec3(dot(row, sx) * wy[j] * wz[k], value * sy[j] * wz[k], value * wy[j] * sz[k]);
        }
    return sum * VOXEL_LENGTH;
}
#else
float scalarAt(vec3 place)
{
#ifdef RGBA
    return voxelAt(place).a;
#else
    return voxelAt(place);
#endif
}

// Central differences over one sample to each side, less at the last samples.
vec3 gradientAt(vec3 place)
{
    vec3 low = max(place - VOXEL_LENGTH, FIRST_PLACE);
    vec3 high = min(place + VOXEL_LENGTH, LAST_PLACE);
    return vec3(scalarAt(vec3(high.x, place.yz)) - scalarAt(vec3(low.x, place.yz)),
                scalarAt(vec3(place.x, high.y, place.z)) - scalarAt(vec3(place.x, low.y, place.z)),
                scalarAt(vec3(place.xy, high.z)) - scalarAt(vec3(place.xy, low.z))) *
           VOXEL_LENGTH / max(high - low, 1e-6 * VOXEL_LENGTH);
}
#endif

vec3 shade(vec3 color, vec3 place, vec3 eye, vec3 toEye)
{
#if defined(PLACES) || defined(SCALARS)
    vec3 n = gradientToEye * (placesToFrame * gradientAt(place));
#else
    vec3 n = gradientToEye * gradientAt(place);
#endif
    // No direction where nothing varies, without a jump to it.
    n *= inversesqrt(dot(n, n) + 1e-8);
    vec3 diffuse = vec3(material.x), specular = vec3(0.0);
    int i = 0; // there is one at least
    do {
        vec3 l = lightPosition[i].xyz - lightPosition[i].w * eye;
        float distance = length(l);
        l /= max(distance, 1e-30);
        float strength = 1.0;
        if (lightPosition[i].w != 0.0)
            strength /= dot(lightAttenuation[i], vec3(1.0, distance, distance * distance));
        float spot = dot(-l, lightSpot[i].xyz);
        if (lightSpot[i].w > -1.0)
            strength *= spot < lightSpot[i].w ? 0.0 : pow(max(spot, 0.0), lightSpotExponent[i]);
        vec3 h = l + toEye;
        h *= inversesqrt(max(dot(h, h), 1e-30));
        diffuse += strength * (lightAmbient[i] + material.y * abs(dot(n, l)) * lightDiffuse[i]);
        float highlight = pow(max(abs(dot(n, h)), 1e-30), material.w);
        specular += strength * material.z * highlight * lightSpecular[i];
    } while (++i < lightCount);
    return color * diffuse + specular;
}
#endif
