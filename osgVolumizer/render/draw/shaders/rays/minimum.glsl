// The lowest value on the ray.

#define BETTER(a, b) min(a, b)
