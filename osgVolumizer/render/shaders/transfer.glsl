// Colour and extinction of a point, shared by slices and slabs.

#ifdef VOXELS
uniform sampler3D voxels;
uniform vec3 textureScale;  // voxel coordinate -> texture coordinate
uniform vec3 textureOffset;
#endif
uniform sampler2D lookupTable; // r, g, b, extinction in bits (-log2 of transmittance) per opacity unit
uniform vec2 valueToTable;     // texel -> coordinate in the table

// rgb: emitted colour; a: extinction, bits per opacity unit.
vec4 classify(vec3 voxelCoordinate)
{
#ifndef VOXELS
    return vec4(1.0, 1.0, 1.0, 1.0);
#elif defined(RGBA)
    vec4 c = texture(voxels, voxelCoordinate * textureScale + textureOffset);
    return vec4(c.rgb, -log2(max(1.0 - c.a, 5.9604645e-8)));
#else
    float value = texture(voxels, voxelCoordinate * textureScale + textureOffset).r;
    return textureLod(lookupTable, vec2(value * valueToTable.x + valueToTable.y, 0.5), 0.0);
#endif
}

// The pixel's ray, in the frame of the vertices: origin + t * direction, t in eye units along the view axis
// from the reference depth, the same for every pixel. Linear in window coordinates for every
// perspective, orthographic and off-axis projection.
uniform vec2 windowCenter;
uniform mat3 rayOrigin;    // times (dx, dy, 1)
uniform mat3 rayDirection;
uniform mat3 frameToUnits; // frame vector -> vector in opacity units

void pixelRay(out vec3 origin, out vec3 direction)
{
    vec3 window = vec3(gl_FragCoord.xy - windowCenter, 1.0);
    origin = rayOrigin * window;
    direction = rayDirection * window;
}
