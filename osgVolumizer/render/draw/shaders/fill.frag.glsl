// Pixels between the rays of a coarse image: bilinear, but each ray counts for less the farther the opaque depth that
// it ended at is from the pixel's.

uniform sampler2D image;       // premultiplied
uniform sampler2D opaqueDepth; // window depth
uniform bool hasOpaqueDepth;
uniform vec4 imageToWindow; // scale, offset
uniform vec4 windowEnds;    // first and last pixel that rays looked at
uniform vec4 imageEnds;     // first and last texel that was drawn
out vec4 fragColor;

// Window depths closer than this are taken to be of one surface.
const float SAME = 1e-4;

ivec2 texelAt(ivec2 p) { return clamp(p, ivec2(imageEnds.xy), ivec2(imageEnds.zw)); }

float depthAt(ivec2 texel)
{
    vec2 window = (vec2(texel) + 0.5) * imageToWindow.xy + imageToWindow.zw;
    return texelFetch(opaqueDepth, ivec2(clamp(window, windowEnds.xy, windowEnds.zw)), 0).r;
}

void main()
{
    vec2 place = (gl_FragCoord.xy - imageToWindow.zw) / imageToWindow.xy - 0.5;
    ivec2 low = ivec2(floor(place));
    vec2 f = place - vec2(low);
    ivec2 p00 = texelAt(low), p10 = texelAt(low + ivec2(1, 0));
    ivec2 p01 = texelAt(low + ivec2(0, 1)), p11 = texelAt(low + ivec2(1, 1));
    vec4 weight = vec4(1.0 - f.x, f.x, 1.0 - f.x, f.x) * vec4(1.0 - f.yy, f.yy);
    if (hasOpaqueDepth) {
        float depth = texelFetch(opaqueDepth, ivec2(gl_FragCoord.xy), 0).r;
        vec4 apart = abs(vec4(depthAt(p00), depthAt(p10), depthAt(p01), depthAt(p11)) - depth) + SAME;
        weight /= apart * apart;
        weight /= dot(weight, vec4(1.0));
    }
    fragColor = weight.x * texelFetch(image, p00, 0) + weight.y * texelFetch(image, p10, 0) +
                weight.z * texelFetch(image, p01, 0) + weight.w * texelFetch(image, p11, 0);
}
