// What all that march share.

// What is left of the light when marching stops: the most that this may change any pixel.
#define OPAQUE_ENOUGH 3e-5

#ifdef COUNT_SAMPLES
float sampleCount = 0.0;
#define COUNT_SAMPLE sampleCount += 1.0;
#else
#define COUNT_SAMPLE
#endif
