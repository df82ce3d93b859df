// What filtering and blending make of SIDE * SIDE fractions from 0 to 1: see MeasurePrecision.cpp. Each texture has
// two texels.
uniform sampler3D floatTexels; // 0 and 1
uniform sampler3D byteTexels;  // 0 and 1 of 255
uniform int blended;
out vec4 result;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float f = float(pixel.x + SIDE * pixel.y) / float(SIDE * SIDE);
    vec3 place = filterPlace(vec3(0.5 * f + 0.25, 0.5, 0.5), ivec3(2, 1, 1));
    if (blended == 1)
        result = vec4(0.0, 0.0, 0.25 * f, 0.75 * f);
    else
        result = vec4(textureLod(floatTexels, place, 0.0).r, textureLod(byteTexels, place, 0.0).r, 1.0 - f, 1.0);
}
