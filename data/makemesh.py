#!/usr/bin/env python3
"""Makes the unstructured mesh of mesh.osgt: steady temperature in a bent steel bar.

A bar of round cross section (radius 10 mm), bent through 180 degrees about the y axis (radius
30 mm), is heated by a coil around the middle of the bend, held at 20 degrees at both ends, and
cooled by the air along its side. Linear tetrahedra, conjugate gradients; Python 3 and nothing else.

    python3 makemesh.py > mesh.osgt

Every vertex carries the colour and opacity of its temperature.
"""
import math
import sys

BAR_RADIUS = 10.0  # mm
BEND_RADIUS = 30.0  # mm, to the axis of the bar
CELLS_ACROSS = 6
CELLS_ALONG = 28
CONDUCTIVITY = 0.045  # W/(mm K), steel
FILM = 6.0e-5  # W/(mm^2 K), moving air
SOURCE = 6.0e-2  # W/mm^3 in the middle of the coil
COIL_WIDTH = 9.0  # mm, standard deviation along the bar
AMBIENT = 20.0  # degrees Celsius

# The six tetrahedra around the diagonal 0-7 of a cube; corner bits are x, y, z. All cubes are cut the
# same way, so that neighbours agree on their shared faces (Kuhn 1960).
KUHN = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]

# Temperature, as a fraction of the hottest, to red, green, blue and opacity.
COLOURS = [
    (0.00, (0.25, 0.45, 0.85, 0.10)),
    (0.25, (0.60, 0.25, 0.75, 0.14)),
    (0.50, (0.90, 0.25, 0.20, 0.20)),
    (0.75, (1.00, 0.60, 0.10, 0.32)),
    (1.00, (1.00, 0.97, 0.75, 0.60)),
]


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def make_mesh():
    """Returns positions (mm), tetrahedra, boundary triangles of the side, arc lengths, end vertices."""
    n, m = CELLS_ACROSS, CELLS_ALONG
    positions, arcs, ends = [], [], set()
    for k in range(m + 1):
        angle = math.pi * k / m
        for j in range(n + 1):
            for i in range(n + 1):
                u, v = 2.0 * i / n - 1.0, 2.0 * j / n - 1.0
                # The square to the disc.
                x = BAR_RADIUS * u * math.sqrt(1.0 - 0.5 * v * v)
                y = BAR_RADIUS * v * math.sqrt(1.0 - 0.5 * u * u)
                if k in (0, m):
                    ends.add(len(positions))
                distance = BEND_RADIUS + x
                positions.append((-distance * math.cos(angle), y, distance * math.sin(angle)))
                arcs.append(BEND_RADIUS * angle)

    def vertex(i, j, k):
        return i + (n + 1) * (j + (n + 1) * k)

    tetrahedra, count = [], {}
    for k in range(m):
        for j in range(n):
            for i in range(n):
                corner = [vertex(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) for c in range(8)]
                for t in KUHN:
                    tetra = tuple(corner[c] for c in t)
                    tetrahedra.append(tetra)
                    for skip in range(4):
                        face = tuple(sorted(tetra[:skip] + tetra[skip + 1 :]))
                        count[face] = count.get(face, 0) + 1
    side = [f for f, times in count.items() if times == 1 and not all(v in ends for v in f)]
    return positions, tetrahedra, side, arcs, ends


def assemble(positions, tetrahedra, side, arcs):
    """Rows of the stiffness matrix (dictionaries) and the load, of -div(k grad T) = source with
    k dT/dn = film (ambient - T) on the side. Unknown: the temperature above ambient."""
    rows = [{} for _ in positions]
    load = [0.0] * len(positions)

    def add(i, j, value):
        rows[i][j] = rows[i].get(j, 0.0) + value

    for tetra in tetrahedra:
        p = [positions[v] for v in tetra]
        six_volume = dot(subtract(p[1], p[0]), cross(subtract(p[2], p[0]), subtract(p[3], p[0])))
        volume = abs(six_volume) / 6.0
        gradients = []
        for a in range(4):
            b, c, d = [p[x] for x in range(4) if x != a]
            normal = cross(subtract(c, b), subtract(d, b))
            height = dot(normal, subtract(p[a], b))
            gradients.append(tuple(x / height for x in normal))
        middle = sum(arcs[v] for v in tetra) / 4.0 - 0.5 * math.pi * BEND_RADIUS
        heat = SOURCE * math.exp(-0.5 * (middle / COIL_WIDTH) ** 2)
        for a in range(4):
            load[tetra[a]] += 0.25 * volume * heat
            for b in range(4):
                add(tetra[a], tetra[b], CONDUCTIVITY * volume * dot(gradients[a], gradients[b]))
    for face in side:
        p = [positions[v] for v in face]
        normal = cross(subtract(p[1], p[0]), subtract(p[2], p[0]))
        area = 0.5 * math.sqrt(dot(normal, normal))
        for a in range(3):
            for b in range(3):
                add(face[a], face[b], FILM * area / (6.0 if a == b else 12.0))
    return rows, load


def solve(rows, load, fixed):
    """Conjugate gradients, scaled by the diagonal; unknowns in `fixed` are zero."""
    free = [0.0 if i in fixed else 1.0 for i in range(len(rows))]
    entries = [list(row.items()) for row in rows]
    scale = [f / row[i] for i, (row, f) in enumerate(zip(rows, free))]
    x = [0.0] * len(rows)
    r = [b * f for b, f in zip(load, free)]
    z = [a * s for a, s in zip(r, scale)]
    p = z[:]
    rz = dot(r, z)
    first = rz
    for _ in range(10 * len(rows)):
        q = [f * sum(v * p[j] for j, v in row) for row, f in zip(entries, free)]
        step = rz / dot(p, q)
        x = [a + step * b for a, b in zip(x, p)]
        r = [a - step * b for a, b in zip(r, q)]
        z = [a * s for a, s in zip(r, scale)]
        rz, last = dot(r, z), rz
        if rz < 1e-20 * first:
            return x
        p = [a + rz / last * b for a, b in zip(z, p)]
    raise RuntimeError("conjugate gradients did not converge")


def colour(fraction):
    for (low, a), (high, b) in zip(COLOURS, COLOURS[1:]):
        if fraction <= high:
            w = max(0.0, (fraction - low) / (high - low))
            return tuple((1.0 - w) * x + w * y for x, y in zip(a, b))
    return COLOURS[-1][1]


SCENE = """#Ascii Scene
#Version 161
#Generator OpenSceneGraph 3.6.5

osgVolumizer::VolumeAppearance {{
  UniqueID 1
  Name "bent bar"
  Children 1 {{
    osgVolumizer::VolumeGeometry {{
      UniqueID 2
      TetraSet {{
        Version Integers 1 1
        Layout Text 1 "C4F_V3F"
        Vertices Doubles {values} {{
{vertices}
        }}
        Tetrahedra Indices {indices} {{
{tetrahedra}
        }}
        End
      }}
    }}
  }}
  Sampling {{
    Version Integers 1 1
    Technique Text 1 "AUTOMATIC"
    Interpolation Text 1 "LINEAR"
    Lookup Text 1 "AUTOMATIC_LOOKUP"
    ExactFiltering Integers 1 0
    SamplingMode Text 1 "VIEWPORT_ALIGNED"
    SamplingSpace Text 1 "OBJECT"
    SamplingPeriod Doubles 3 0.5 0.5 0.5
    MaximumSamples Integers 1 4096
    OpacityUnit Doubles 1 4
    End
  }}
}}
"""


def scene(positions, tetrahedra, colours):
    def numbers(values):
        return " ".join(f"{value:.4g}" for value in values)

    return SCENE.format(
        values=7 * len(positions),
        vertices="\n".join(numbers(c + p) for c, p in zip(colours, positions)),
        indices=4 * len(tetrahedra),
        tetrahedra="\n".join(" ".join(map(str, t)) for t in tetrahedra),
    )


def main():
    positions, tetrahedra, side, arcs, ends = make_mesh()
    rise = solve(*assemble(positions, tetrahedra, side, arcs), ends)
    hottest = max(rise)
    print(
        f"{len(positions)} vertices, {len(tetrahedra)} tetrahedra, "
        f"{AMBIENT:.0f} to {AMBIENT + hottest:.0f} degrees",
        file=sys.stderr,
    )
    sys.stdout.write(scene(positions, tetrahedra, [colour(t / hottest) for t in rise]))


if __name__ == "__main__":
    main()
