// Light of pieces of a ray, premultiplied colour and opacity, along which colour and opacity are linear: exact to some
// 1e-6. Emission is weighted by what it passes on its way out, integrated by parts; extinction and colour of each step
// are parabolas through its ends and its middle, whose integrals Simpson's rule has exactly.

// Extinction in bits per opacity unit. What is opaque but for a rounding is opaque.
float extinctionOf(float opacity) { return opacity > 0.999999 ? 24.0 : -log2(1.0 - opacity); }

// Mean extinction where opacity goes from a0 to a1, by the extinctions there; `nearby` where the two are much the same.
float meanExtinction(float a0, float a1, float e0, float e1, float nearby)
{
    float u0 = max(1.0 - a0, 0.0), u1 = max(1.0 - a1, 0.0), change = u1 - u0;
    bool differ = abs(change) > max(0.25 * max(u0, u1), 2e-6); // by more than roundings
    return differ ? 1.442695 + (u1 * e1 - u0 * e0) / change : nearby;
}

// Light of a piece of a ray, a length in opacity units of it or its first step if that is too much for one; the share of
// the piece that was taken, `least` or more.
vec4 linearLight(vec4 c0, vec4 c1, float units, float least, out float share)
{
    const float BITS = 0.2; // of extinction in a step: the rule is off by 1e-6 then
    float here = extinctionOf(c0.a), end = extinctionOf(c1.a), turn = abs(c1.a - c0.a);
    // So long that extinction comes to BITS, and that -log2(1 - opacity) is near a parabola.
    float bits = units * here, slope = max(units * end - bits, 0.0);
    share = 2.0 * BITS / max(bits + sqrt(bits * bits + 2.0 * BITS * slope), 1e-30);
    if (turn > 1e-6) share = min(share, max(0.15 * (1.0 - c0.a) / turn, 0.03125));
    share = max(share, least);
    share = share > 0.999 || units * max(here, end) < 1e-4 ? 1.0 : share;
    c1 = mix(c0, c1, share);
    float a = 0.5 * (c0.a + c1.a), middle = extinctionOf(a);
    end = share < 1.0 ? extinctionOf(c1.a) : end;
    units *= share;
    float first = meanExtinction(c0.a, a, here, middle, (5.0 * here + 8.0 * middle - end) * (1.0 / 12.0));
    float whole = meanExtinction(c0.a, c1.a, here, end, (here + 4.0 * middle + end) * (1.0 / 6.0));
    float halfway = opacityOf(0.5 * units * max(first, 0.0)), all = opacityOf(units * whole);
    return vec4(c1.rgb * all - (c1.rgb - c0.rgb) * ((4.0 * halfway + all) * (1.0 / 6.0)), all);
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

// One point on, up or down; of the last and the first there is none.
void movePoint(bool up, bool down)
{
    up = up && point + 1 < lastPoint;
    down = down && point > 0;
    int i = up ? point + 2 : max(point - 1, 0);
    vec4 color = texelFetch(lookupTable, 2 * i);
    float at = texelFetch(lookupTable, 2 * i + 1).r;
    if (up) {
        colorLow = colorHigh;
        pointLow = pointHigh;
        colorHigh = color;
        pointHigh = at;
        ++point;
    }
    if (down) {
        colorHigh = colorLow;
        pointHigh = pointLow;
        colorLow = color;
        pointLow = at;
        --point;
    }
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
#endif
