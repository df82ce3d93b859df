// The practical limit: a march through one box of voxels. Equal steps from entry to exit.
out vec4 fragColor;

uniform mat3 rayOrigin, rayDirection; // times (window x, y, 1), object frame
uniform vec3 boxMin, boxMax;
uniform float stepLength;
uniform sampler3D voxels; // fractions of the table's range
uniform vec3 textureScale, textureOffset;
// Red, green, blue, extinction (bits per unit); with INTEGRAL the sums, over the entries before, of
// extinction * colour and extinction.
uniform samplerBuffer table;
uniform float lastEntry;

float entryAt(vec3 p)
{
    return floor(texture(voxels, p).r * lastEntry + 0.5);
}

void main()
{
    vec3 window = vec3(gl_FragCoord.xy, 1.0);
    vec3 origin = rayOrigin * window, direction = rayDirection * window;
    vec3 safe = mix(direction, vec3(1e-30), equal(direction, vec3(0.0)));
    vec3 a = (boxMin - origin) / safe, b = (boxMax - origin) / safe;
    vec3 enter = min(a, b), leave = max(a, b);
    float tNear = max(max(enter.x, enter.y), enter.z);
    float tFar = min(min(leave.x, leave.y), leave.z);
    if (tFar <= tNear) discard;

    int n = int(ceil((tFar - tNear) * length(direction) / stepLength));
    float dt = (tFar - tNear) / float(n);
    float bits = -dt * length(direction); // times extinction: log2 of a step's transmittance
    vec3 dp = dt * direction * textureScale;
    vec3 p = (origin + tNear * direction) * textureScale + textureOffset;
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
    // On Mesa's llvmpipe it matters (40 %) that the position moves at the end of the body, and that
    // the test for opaque pixels is not in its middle.
#ifdef INTEGRAL
    // Mean colour and extinction of all values that a segment passes (as if they were linear in it).
    float entry = entryAt(p);
    vec4 sum = texelFetch(table, int(entry));
    p += dp;
    for (int i = 0; i < n && transmittance > 3e-5; ++i) {
        float nextEntry = entryAt(p);
        nextEntry += nextEntry == entry ? 1.0 : 0.0;
        vec4 nextSum = texelFetch(table, int(nextEntry));
        vec4 mean = (nextSum - sum) / (nextEntry - entry);
        float extinction = max(mean.a, 1e-20);
        float next = transmittance * exp2(extinction * bits);
        color += (transmittance - next) / extinction * mean.rgb;
        transmittance = next;
        sum = nextSum;
        entry = nextEntry;
        p += dp;
    }
#else
    p += 0.5 * dp;
    for (int i = 0; i < n && transmittance > 3e-5; ++i) {
        vec4 c = texelFetch(table, int(entryAt(p)));
        float next = transmittance * exp2(c.a * bits);
        color += (transmittance - next) * c.rgb;
        transmittance = next;
        p += dp;
    }
#endif
    fragColor = vec4(color, 1.0 - transmittance);
}
