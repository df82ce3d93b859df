// The mean value over the length of the ray.

#ifdef RESOLVE
float gatheredEntry(vec4 ray)
{
    if (!(ray.y > 0.0)) discard;
    return ray.x / ray.y * valueToEntry.x + valueToEntry.y;
}
#endif
