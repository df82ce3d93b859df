layout(location = 0) in vec3 position;
#ifdef VOXEL_COORDINATES
layout(location = 1) in vec3 voxelCoordinateIn;
#endif
#ifdef VERTEX_COLORS
layout(location = 2) in vec4 colorIn;
out vec4 vertexColor;
#endif
out vec3 voxelCoordinate;
uniform mat4 frameToClip;

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
    gl_Position = frameToClip * vec4(position, 1.0);
}
