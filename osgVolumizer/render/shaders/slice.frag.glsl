// One slice: the layer between two sampling surfaces, as thick as this pixel's ray finds it.

in vec3 voxelCoordinate;
#ifdef VERTEX_COLORS
in vec4 vertexColor;
#endif
out vec4 fragColor;

uniform float spacing; // between surfaces
uniform vec3 surfaceNormal; // spacing is counted along it (frame units); planes
#ifdef SPHERICAL
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
    vec4 c = classify(voxelCoordinate);
#ifdef VERTEX_COLORS
#ifdef VOXELS
    c *= vertexColor;
#else
    c = vec4(vertexColor.rgb, -log2(max(1.0 - vertexColor.a, 5.9604645e-8)));
#endif
#endif
    float alpha = 1.0 - exp2(-c.a * layer * length(frameToUnits * direction));
    fragColor = vec4(c.rgb * alpha, alpha);
}
