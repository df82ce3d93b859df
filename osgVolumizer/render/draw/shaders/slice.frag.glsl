// One slice: the layer between two sampling surfaces, as thick as this pixel's ray finds it.

in vec3 voxelCoordinate;
#ifdef PAINTED
in vec3 framePosition;
#endif
#ifdef VERTEX_COLORS
in vec4 vertexColor;
#endif
out vec4 fragColor;

flat in float spacing;
uniform vec3 surfaceNormal; // spacing is counted along it (frame units); planes
#ifdef SHADING
in vec3 eyePosition;
#elif defined(SPHERICAL)
uniform mat3 rayDirectionEye;
#endif

void main()
{
    vec3 origin, direction;
    pixelRay(origin, direction);
#ifdef SPHERICAL
    float layer = spacing / length(rayDirectionEye * vec3(gl_FragCoord.xy - windowCenter, 1.0));
#else
    // A ray along the planes would see an infinitely thick layer: it sees no plane either.
    float layer = spacing / max(abs(dot(surfaceNormal, direction)), 1e-12);
#endif
    float units = layer * length(frameToUnits * direction);
#ifdef VOXELS
    vec3 place = placeOf(voxelCoordinate);
#else
    vec3 place = voxelCoordinate;
#endif
#if defined(MAXIMUM) || defined(MINIMUM)
#ifdef RGBA
    vec4 texel = voxelAt(place);
    fragColor = vec4(texel.rgb * texel.a, texel.a);
#else
    fragColor = vec4(voxelAt(place));
#endif
#elif defined(AVERAGE) || defined(SUM)
    fragColor = vec4(voxelAt(place) * units, units, 0.0, 0.0);
#else
#ifdef PREINTEGRATED
    // The layer's own ends; one frame unit of the ray is `direction`.
    vec3 halfLayer = 0.5 * layer * direction * VOXEL_LENGTH;
    float entry0 = tableEntry(place - halfLayer);
    float entry1 = tableEntryAfter(entry0, place + halfLayer);
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
    vec3 directionEye = rayDirectionEye * vec3(gl_FragCoord.xy - windowCenter, 1.0);
    c.rgb = shade(c.rgb, place, eyePosition, -normalize(directionEye));
#endif
#ifdef PAINTED
    c.rgb = painted(c.rgb, framePosition);
#endif
    float depth = 0.6931471806 * c.a * units; // optical
    // 1 - exp(-depth) without cancelling the digits of thin layers.
    float alpha =
        depth < 0.01 ? depth * (1.0 - depth * (0.5 - depth * 0.16666667)) : 1.0 - exp(-depth);
    fragColor = vec4(c.rgb * alpha, alpha);
#endif
}
