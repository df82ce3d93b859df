// The integral of the value, as a fraction of the range.

#ifdef RESOLVE
float gatheredEntry(vec4 ray)
{
    if (!(ray.y > 0.0)) discard;
    return ray.x * valueToEntry.x + ray.y * valueToEntry.y;
}
#endif
