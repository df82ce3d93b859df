// What all that march share.

// What is left of the light when marching stops: the most that this may change any pixel.
uniform float opaqueEnough;

// Opacity of bits of extinction, without cancelling the digits of little.
float opacityOf(float bits)
{
    float depth = 0.6931471806 * bits;
    return depth < 0.02 ? depth * (1.0 - depth * (0.5 - depth * (0.16666667 - depth * 0.041666668))) : 1.0 - exp2(-bits);
}

// The points of Gauss's rule of two are so far from the ends of a piece of length 1.
#define GAUSS 0.21132487

// Light of a piece, premultiplied colour and opacity: both points' colour and extinction, through which they are taken
// for linear. By parts: of a colour that goes from c0 to c1, c1 times all, less what of the change came too late.
vec4 lightOfPiece(vec4 first, vec4 second, float units)
{
    const float WIDTH = 1.0 - 2.0 * GAUSS, BEND = 0.5 * GAUSS * GAUSS / WIDTH;
    float e0 = first.a * units, e1 = second.a * units, all = 0.5 * (e0 + e1);
    float d0 = max(GAUSS * e0 - BEND * (e1 - e0), 0.0), d1 = all - max(GAUSS * e1 - BEND * (e0 - e1), 0.0);
    float opacity = opacityOf(all);
    vec3 change = (second.rgb - first.rgb) / WIDTH, end = second.rgb + GAUSS * change;
    return vec4(max(end * opacity - change * (0.5 * (opacityOf(d0) + opacityOf(d1))), 0.0), opacity);
}

// Steps that adapt are as long as the light that they give allows: what a step is off by grows with its light and the
// square of its length. The same as core/accuracy/AdaptiveStep.
uniform float mostWeight; // of light, in a step of one period
float stretch = 1.0;      // length of the next step, periods
#define SHORTEST_STRETCH 0.25
#define LONGEST_STRETCH 3.0

// Whether a step is short enough for the light that it gives; sets the length of the next one, or of another try.
bool suitsStep(float light)
{
    float weight = light * stretch * stretch;
    bool tooLong = weight > mostWeight && stretch > SHORTEST_STRETCH;
    float longer = 8.0 * weight < mostWeight ? min(2.0 * stretch, LONGEST_STRETCH) : stretch;
    stretch = tooLong ? max(0.5 * stretch, SHORTEST_STRETCH) : longer;
    return !tooLong;
}

#ifdef COUNT_SAMPLES
float sampleCount = 0.0;
#define COUNT_SAMPLE sampleCount += 1.0;
#else
#define COUNT_SAMPLE
#endif
