// A slice: a surface that is coloured by the voxels in it.
layout(location = 0) in vec3 position;
layout(location = 2) in vec3 voxelCoordinateIn;
layout(location = 3) in vec3 acrossIn;
layout(location = 4) in float distanceIn;
out vec3 voxelCoordinate;
flat out vec3 across; // voxels per unit of length along the normal
flat out float distanceAlong; // of the face, along the normal
uniform mat4 frameToClip;
#if PLANES > 0
out vec3 framePosition;
#endif
#ifdef FOG
uniform mat4 frameToEye;
out float depthEye;
#endif

void main()
{
    voxelCoordinate = voxelCoordinateIn;
    across = acrossIn;
    distanceAlong = distanceIn;
#if PLANES > 0
    framePosition = position;
#endif
#ifdef FOG
    depthEye = -(frameToEye * vec4(position, 1.0)).z;
#endif
    gl_Position = frameToClip * vec4(position, 1.0);
}
