// One volume that paints others: its colour at a point of their frame, faded to white where it is transparent.
// Every "@" stands for its number.

uniform sampler3D paint@Voxels;
uniform samplerBuffer paint@Table;
uniform mat4 paint@FromFrame; // the painted volume's frame -> voxel coordinate
uniform vec3 paint@TextureScale, paint@TextureOffset;
uniform vec3 paint@Min, paint@Max; // voxel coordinates
uniform vec4 paint@Planes[8];      // half-spaces
uniform vec2 paint@ValueToEntry;
uniform float paint@LastEntry;
uniform bool paint@Rgba, paint@Nearest;

// The part of a ray that is painted: where it enters and leaves.
vec2 paint@Segment(vec3 origin, vec3 direction)
{
    origin = (paint@FromFrame * vec4(origin, 1.0)).xyz;
    direction = mat3(paint@FromFrame) * direction;
    vec2 ends = boxSegment(paint@Min, paint@Max, origin, direction);
    for (int i = 0; i < 8; ++i)
        clipToPlane(paint@Planes[i], origin, direction, ends.x, ends.y);
    return ends;
}

vec3 paint@At(vec3 point)
{
    vec3 p = (paint@FromFrame * vec4(point, 1.0)).xyz;
    if (any(lessThan(p, paint@Min)) || any(greaterThanEqual(p, paint@Max))) return vec3(1.0);
    for (int i = 0; i < 8; ++i)
        if (dot(paint@Planes[i], vec4(p, 1.0)) < 0.0) return vec3(1.0);
    if (paint@Nearest) p = floor(p + 0.5);
    vec3 place = p * paint@TextureScale + paint@TextureOffset;
    vec4 c = texture(paint@Voxels, filterPlace(place, textureSize(paint@Voxels, 0)));
    if (!paint@Rgba) {
        float entry =
            clamp(c.r * paint@ValueToEntry.x + paint@ValueToEntry.y, 0.0, paint@LastEntry);
        int low = int(entry);
        vec4 low4 = texelFetch(paint@Table, low);
        vec4 high4 = texelFetch(paint@Table, min(low + 1, int(paint@LastEntry)));
        c = mix(low4, high4, fract(entry));
        c.a = 1.0 - exp2(-c.a); // opacity of a layer one unit thick
    }
    return mix(vec3(1.0), c.rgb, c.a);
}
