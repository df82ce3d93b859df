// The highest value on the ray.

#define BETTER(a, b) max(a, b)
#define WORST -3e38
