// One slice: the layer between two sampling surfaces, as thick as this pixel's ray finds it.

in vec3 voxelCoordinate;
#if defined(PAINTED) || PLANES > 0
in vec3 framePosition;
#endif
#ifdef VERTEX_COLORS
in vec4 vertexColor;
#endif
out vec4 fragColor;

flat in float spacing;
uniform vec3 surfaceNormal; // spacing is counted along it (frame units); planes
#if defined(SHADING) || defined(FOG)
in vec3 eyePosition;
#endif
#if defined(SPHERICAL) && !defined(SHADING)
uniform mat3 rayDirectionEye;
#endif

float kept = 1.0; // of the layer, by a cut

// What the ray function makes of a layer of the volume about a place, as thick as given in t.
// vec4 slice(vec3 place, vec3 direction, float thickness)
#pragma ray_function

void main()
{
#if PLANES > 0
    for (int i = 0; i < PLANES; ++i)
        if (dot(planes[i], vec4(framePosition, 1.0)) < 0.0) discard;
#endif
    vec3 origin, direction;
    pixelRay(origin, direction);
#ifdef SPHERICAL
    float thickness = spacing / length(rayDirectionEye * vec3(windowPlace() - windowCenter, 1.0));
#else
    // A ray along the planes would see an infinitely thick layer: it sees no plane either.
    float thickness = spacing / max(abs(dot(surfaceNormal, direction)), 1e-12);
#endif
#ifdef CUT
#ifdef VOXEL_COORDINATES
    kept = keptAbout(voxelCoordinate, vec3(0.0), 0.0, 0.0);
#else
    kept = keptAbout(voxelCoordinate, direction, 0.0, thickness);
#endif
    if (kept <= 0.0) discard;
#endif
#ifdef VOXELS
    vec3 place = placeOf(voxelCoordinate);
#else
    vec3 place = voxelCoordinate;
#endif
    fragColor = slice(place, direction, thickness);
}
