// The lowest value on the ray.

#define BETTER(a, b) min(a, b)
#define WORST 3e38
