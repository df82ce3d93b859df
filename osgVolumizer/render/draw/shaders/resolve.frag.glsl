// One layer from what all bricks left of a pixel's ray: looked up, drawn over what is behind.

uniform sampler2D rays; // values, or premultiplied colours
uniform vec3 fogColor;
uniform float fogShare; // of colours, as far away as the volume's middle
out vec4 fragColor;
#ifndef RGBA
uniform samplerBuffer lookupTable;
uniform vec2 valueToEntry;
uniform float lastEntry;

// The entry of the table for what the ray function gathered; discards where that is nothing.
// float gatheredEntry(vec4 ray)
#pragma ray_function
#endif

void main()
{
    vec4 ray = texelFetch(rays, ivec2(gl_FragCoord.xy), 0);
    if (!(abs(ray.x) < 1e37)) discard; // nothing drawn
#ifdef RGBA
    fragColor = vec4(mix(fogColor * ray.a, ray.rgb, fogShare), ray.a);
#else
    float entry = gatheredEntry(ray);
    float held = clamp(entry, 0.0, lastEntry);
    int low = int(held);
    vec4 c = mix(texelFetch(lookupTable, low), texelFetch(lookupTable, low + 1), fract(held));
    float alpha = 1.0 - exp2(-c.a);
    fragColor = vec4(mix(fogColor, c.rgb, fogShare) * alpha, alpha);
#endif
}
