// The pixel's ray, in the frame of the vertices: origin + t * direction, t in eye units along the view axis
// from the reference depth, the same for every pixel. Linear in window coordinates for every
// perspective, orthographic and off-axis projection.
uniform vec2 windowCenter;
uniform mat3 rayOrigin;    // times (dx, dy, 1)
uniform mat3 rayDirection;
uniform mat3 frameToUnits; // frame vector -> vector in opacity units

void pixelRay(out vec3 origin, out vec3 direction)
{
    vec3 window = vec3(windowPlace() - windowCenter, 1.0);
    origin = rayOrigin * window;
    direction = rayDirection * window;
}

// The pixel of the window that the ray looks at.
#ifdef COARSE
uniform vec4 imageToWindow; // scale, offset
uniform vec4 windowEnds;    // first and last pixel that may be looked at
ivec2 windowPixel()
{
    return ivec2(clamp(windowPlace() * imageToWindow.xy + imageToWindow.zw, windowEnds.xy, windowEnds.zw));
}
#else
ivec2 windowPixel() { return ivec2(windowPlace()); }
#endif
