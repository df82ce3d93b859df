layout(location = 0) in vec3 position;
#ifdef VOXEL_COORDINATES
layout(location = 2) in vec3 voxelCoordinateIn;
#endif
#ifdef VERTEX_COLORS
layout(location = 3) in vec4 colorIn;
out vec4 vertexColor;
#endif
layout(location = 4) in float spacingIn;
out vec3 voxelCoordinate;
#if defined(PAINTED) || PLANES > 0
out vec3 framePosition;
#endif
flat out float spacing; // between surfaces
uniform mat4 frameToClip;
#if defined(SHADING) || defined(FOG)
uniform mat4 frameToEye;
out vec3 eyePosition;
#endif

void main()
{
#ifdef VOXEL_COORDINATES
    voxelCoordinate = voxelCoordinateIn;
#else
    voxelCoordinate = position;
#endif
#ifdef VERTEX_COLORS
    vertexColor = colorIn;
#endif
#if defined(PAINTED) || PLANES > 0
    framePosition = position;
#endif
    spacing = spacingIn;
#if defined(SHADING) || defined(FOG)
    eyePosition = (frameToEye * vec4(position, 1.0)).xyz;
#endif
    gl_Position = frameToClip * vec4(position, 1.0);
}
