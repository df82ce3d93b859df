// Light of a piece of a ray, premultiplied colour and opacity, along which colour and opacity are linear: exact to some
// 1e-6. Emission is weighted by what it passes on its way out, integrated by parts; extinction and colour of each step
// are parabolas through its ends and its middle, whose integrals Simpson's rule has exactly.

#define EXACT_ENOUGH 1e-6 // what is let through

// Extinction in bits per opacity unit.
float extinctionOf(float opacity) { return -log2(max(1.0 - opacity, 5.9604645e-8)); }

// Opacity of bits of extinction, without cancelling the digits of little.
float opacityOf(float bits)
{
    float depth = 0.6931471806 * bits;
    return depth < 0.02 ? depth * (1.0 - depth * (0.5 - depth * (0.16666667 - depth * 0.041666668))) : 1.0 - exp2(-bits);
}

// Adds a piece of a length in opacity units behind what there is already: light.a is what is let through.
void addLinear(vec4 c0, vec4 c1, float units, inout vec4 light)
{
    if (!(max(c0.a, c1.a) > 0.0)) return;
    const float BITS = 0.35; // of extinction in a step: the rule is off by 1e-6 then
    float rise = max(c1.a - c0.a, 0.0), turn = max(abs(c1.a - c0.a), 1e-30);
    float at = 0.0, e0 = extinctionOf(c0.a);
    vec3 color0 = c0.rgb;
    float end = units * extinctionOf(c1.a);
    for (int i = 0; i < 96; ++i) {
        // So long that extinction comes to BITS, and that -log2(1 - opacity) is near a parabola.
        float here = units * e0, slope = max(end - here, 0.0) / max(1.0 - at, 1e-6);
        float dx = 2.0 * BITS / max(here + sqrt(here * here + 2.0 * BITS * slope), 1e-30);
        dx = min(dx, max(0.25 * (1.0 - mix(c0.a, c1.a, at)) / turn, 0.03125));
        bool last = at + dx * 1.001 >= 1.0;
        dx = last ? 1.0 - at : dx;
        vec4 middle = mix(c0, c1, at + 0.5 * dx), next = last ? c1 : mix(c0, c1, at + dx);
        float e1 = extinctionOf(middle.a), e2 = extinctionOf(next.a);
        float bits = dx * units;
        float halfway = opacityOf(max(bits * (5.0 * e0 + 8.0 * e1 - e2) * (1.0 / 24.0), 0.0));
        float all = opacityOf(bits * (e0 + 4.0 * e1 + e2) * (1.0 / 6.0));
        vec3 change = next.rgb - color0;
        light.rgb += light.a * (next.rgb * all - change * ((4.0 * halfway + all) * (1.0 / 6.0)));
        light.a *= 1.0 - all;
        at += dx;
        e0 = e2;
        color0 = next.rgb;
        COUNT_SAMPLE
        if (last || light.a <= EXACT_ENOUGH) break;
    }
}

#ifdef SCALARS
// The points of the lookup table: colour and opacity, then the fraction of the range where; first and last far away.
uniform samplerBuffer lookupTable;
uniform int lastPoint;
int point = -1; // the last one that is not beyond the scalar
float pointLow, pointHigh;
vec4 colorLow, colorHigh;

void takePoint(int i)
{
    point = i;
    colorLow = texelFetch(lookupTable, 2 * i);
    pointLow = texelFetch(lookupTable, 2 * i + 1).r;
    colorHigh = texelFetch(lookupTable, 2 * i + 2);
    pointHigh = texelFetch(lookupTable, 2 * i + 3).r;
}

// Finds the points about a scalar; of a jump what comes after it.
void findPoint(float scalar)
{
    if (point >= 0 && scalar >= pointLow && scalar < pointHigh) return;
    int low = 0, high = lastPoint;
    for (int i = 0; i < 24 && high - low > 1; ++i) {
        int middle = (low + high) / 2;
        if (texelFetch(lookupTable, 2 * middle + 1).r <= scalar)
            low = middle;
        else
            high = middle;
    }
    takePoint(low);
}

vec4 colorBetweenPoints(float scalar)
{
    float f = clamp((scalar - pointLow) / max(pointHigh - pointLow, 1e-30), 0.0, 1.0);
    return mix(colorLow, colorHigh, f);
}

// Colour and opacity of a scalar.
vec4 pointColor(float scalar)
{
    findPoint(scalar);
    return colorBetweenPoints(scalar);
}

// Adds a piece along which the scalar is linear: from point to point of the table.
void addScalars(float from, float to, float units, inout vec4 light)
{
    findPoint(from);
    if (from == to) {
        vec4 same = colorBetweenPoints(from);
        addLinear(same, same, units, light);
        return;
    }
    bool up = to > from;
    float at = from, perUnit = units / abs(to - from);
    for (int i = 0; i < 65536; ++i) {
        float bound = up ? pointHigh : pointLow;
        bool last = up ? to <= bound : to >= bound;
        float next = last ? to : bound;
        if (next != at) addLinear(colorBetweenPoints(at), colorBetweenPoints(next), abs(next - at) * perUnit, light);
        if (last || light.a <= EXACT_ENOUGH) break;
        at = next;
        takePoint(clamp(point + (up ? 1 : -1), 0, lastPoint - 1));
    }
}
#endif
