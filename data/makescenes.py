#!/usr/bin/env python3
"""Makes head.osgt and mixed.osgt, and the voxels of activation.tif, in this folder.

mixed.osgt: the head of head.tif, whose skull was taken off; an implant that takes its place, a
translucent cap with a titanium rim and screws; a field of brain activity that is painted over the
brain; a plate of glass under the neck. Python 3 and oiiotool (of OpenImageIO).

    python3 data/makescenes.py

Frames: voxel (i, j, k) of the head lies at x = 41.5 - k, y = i - 63.5, z = 63.5 - j: x to the left
ear, y to the back, z up, in voxels, about the middle of the scan.
"""
import math
import os
import subprocess
import tempfile

FOLDER = os.path.dirname(os.path.abspath(__file__))
UPRIGHT = ("0 1 0 0", "0 0 -1 0", "-1 0 0 0", "41.5 -63.5 63.5 1")  # rows; voxel to x, y, z

# The cap: the part of an ellipsoid above a plane, both fitted to where the skull was cut.
CENTER, RADII = (0.0, 10.0, -2.0), (41.0, 43.5, 46.0)
CUT_NORMAL, CUT_POINT = (0.0, 0.56, 0.83), (0.0, -27.0, 24.5)
RINGS, SEGMENTS = 12, 48
RIM = 0.045  # radians, as seen from the middle
SCREWS = 8

ACTIVITY_SIZE, ACTIVITY_SPACING = 24, 1.5
ACTIVITY_ORIGIN = (48.0, 22.0, 6.0)  # voxel frame of the head
FOCI = [((17.0, 8.0, 22.0), 6.0), ((5.0, 14.0, 15.0), 4.0)]  # from the origin, radius; voxels of the head

FRAME_TIME = 1.0 / 15.0  # seconds, while the view moves
# A view from the front, a little to the left and from above; rows.
VIEW = ("0.766044443 -0.623694071 -0.155504397 0", "0.64278761 0.743289649 0.185322924 0",
        "0 -0.241921896 0.970295726 0", "0 0 0 1")


class Writer:
    """Scene text: blocks with braces, and the numbers that OSG gives to its objects."""

    def __init__(self):
        self.lines = ["#Ascii Scene", "#Version 161", "#Generator OpenSceneGraph 3.6.5", ""]
        self.depth = 0
        self.count = 0

    def line(self, text):
        self.lines.append("  " * self.depth + text)

    def open(self, text):
        self.line(text + " {")
        self.depth += 1

    def object(self, kind, name=None, static=False):
        self.open(kind)
        self.count += 1
        self.line(f"UniqueID {self.count}")
        if name:
            self.line(f'Name "{name}"')
        if static:
            self.line("DataVariance STATIC")

    def close(self, blocks=1):
        for _ in range(blocks):
            self.depth -= 1
            self.line("}")

    def save(self, name):
        with open(os.path.join(FOLDER, name), "w") as file:
            file.write("\n".join(self.lines) + "\n")


def numbers(values):
    return " ".join(f"{v:.5g}" if abs(v) > 1e-9 else "0" for v in values)


def record(w, name, fields):
    w.open(name)
    w.line("Version Integers 1 4")
    for field in fields:
        w.line(field)
    w.line("End")
    w.close()


def box(w, size):
    x, y, z = (n - 1 for n in size)
    w.object("osgVolumizer::VolumeGeometry")
    w.open("TetraSet")
    w.line("Version Integers 1 4")
    w.line('Layout Text 1 "V3F"')
    w.open("Vertices Doubles 24")
    w.line(f"0 0 0  {x} 0 0  0 {y} 0  {x} {y} 0  0 0 {z}  {x} 0 {z}  0 {y} {z}  {x} {y} {z}")
    w.close()
    w.open("Tetrahedra Indices 20")
    w.line("0 1 2 4  3 2 1 7  5 4 7 1  6 7 4 2  1 2 4 7")
    w.close()
    w.line("End")
    w.close(2)


def appearance(w, name, file, size, table, shading, rule="ABSORB", placed=None):
    """A volume in its box; `table` is a file name, or points (fraction, r, g, b, opacity)."""
    w.object("osgVolumizer::VolumeAppearance", name)
    w.open("Children 1")
    if placed:
        w.object("osg::MatrixTransform", static=True)
        w.open("Children 1")
    box(w, size)
    if placed:
        w.close()
        w.open("Matrix")
        for row in placed:
            w.line(row)
        w.close(2)
    w.close()
    record(w, "Sampling", [
        'Technique Text 1 "AUTOMATIC"', 'Interpolation Text 1 "LINEAR"',
        'Lookup Text 1 "AUTOMATIC_LOOKUP"', "ExactFiltering Integers 1 0",
        'SamplingMode Text 1 "VIEWPORT_ALIGNED"', 'SamplingSpace Text 1 "OBJECT"',
        "SamplingPeriod Doubles 3 1 1 1", "MaximumSamples Integers 1 4096",
        "OpacityUnit Doubles 1 1", 'RayFunction Text 1 "COMPOSITE"', "IsoValue Doubles 1 0.5",
        f"Shading Integers 1 {int(shading)}", "Material Doubles 4 0.4 0.9 0.25 24",
        'Gradients Text 1 "PRECOMPUTED"', "AccumulationBits Integers 1 32",
        f'CombineRule Text 1 "{rule}"', "ErrorTolerance Doubles 1 0",
        f"TargetFrameTime Doubles 1 {FRAME_TIME:.6g}"])
    w.open("Voxels")
    w.object("osgVolumizer::Voxels")
    record(w, "Bricks", [
        f'FileName Text 1 "{file}"', 'FileOptions Text 1 ""', "BrickSize Integers 3 256 256 256",
        "Overlap Integers 1 3", "Spacing Doubles 3 1 1 1", "Origin Doubles 3 0 0 0"])
    w.close(2)
    w.open("LookupTable")
    w.object("osgVolumizer::LookupTable")
    if isinstance(table, str):
        record(w, "Function", [f'FileName Text 1 "{table}"'])
    else:
        values = "  ".join(numbers(p) for p in table)
        record(w, "Function", ['Domain Text 1 "RANGE_FRACTION"',
                               f"Points Doubles {5 * len(table)} {{ {values} }}"])
    w.close(3)


def material(w, color, alpha, specular, shininess):
    """The state of a lit surface, translucent where alpha is below 1."""
    w.open("StateSet TRUE")
    w.object("osg::StateSet")
    if alpha < 1.0:
        w.open("ModeList 1")
        w.line("GL_BLEND ON")
        w.close()
    w.open("AttributeList 1")
    w.object("osg::Material")
    for name, scale in (("Ambient", 0.5), ("Diffuse", 1.0)):
        c = numbers([scale * v for v in color] + [alpha])
        w.line(f"{name} TRUE Front {c} Back {c}")
    s = numbers([specular] * 3 + [1.0])
    w.line(f"Specular TRUE Front {s} Back {s}")
    w.line("Emission TRUE Front 0 0 0 1 Back 0 0 0 1")
    w.line(f"Shininess TRUE Front {shininess} Back {shininess}")
    w.close()
    w.line("Value OFF")
    w.close()
    if alpha < 1.0:
        w.line("RenderingHint 2")
        w.line("RenderBinMode USE_RENDERBIN_DETAILS")
        w.line("BinNumber 10")
        w.line('BinName "DepthSortedBin"')
    w.close(2)


def array(w, name, kind, binding, values):
    w.open(f"{name} TRUE")
    w.object(f"osg::{kind}")
    w.line(f"Binding {binding}")
    w.open(f"vector {len(values)}")
    for value in values:
        w.line(numbers(value))
    w.close(3)


def mesh(w, name, points, normals, triangles, color, alpha, specular=0.5, shininess=48):
    w.object("osg::Geometry", name)
    material(w, color, alpha, specular, shininess)
    w.open("PrimitiveSetList 1")
    w.object("osg::DrawElementsUShort")
    w.line("Mode TRIANGLES")
    indices = [i for t in triangles for i in t]
    w.open(f"vector {len(indices)}")
    for first in range(0, len(indices), 24):
        w.line(" ".join(map(str, indices[first:first + 24])))
    w.close(3)
    array(w, "VertexArray", "Vec3Array", "BIND_PER_VERTEX", points)
    array(w, "NormalArray", "Vec3Array", "BIND_PER_VERTEX", normals)
    array(w, "ColorArray", "Vec4Array", "BIND_OVERALL", [tuple(color) + (alpha,)])
    w.close()


def unit(v):
    length = math.sqrt(sum(c * c for c in v))
    return [c / length for c in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def cap_frame():
    """Pole, two directions across, and the angle of the rim, on the unit sphere of the ellipsoid."""
    scaled = [n * r for n, r in zip(CUT_NORMAL, RADII)]
    height = sum(n * (p - c) for n, p, c in zip(CUT_NORMAL, CUT_POINT, CENTER))
    pole = unit(scaled)
    across = unit(cross(pole, (1.0, 0.0, 0.0)))
    return pole, across, cross(pole, across), math.acos(height / math.hypot(*scaled))


def on_cap(frame, polar, around, lift=0.0):
    """A point of the ellipsoid, `lift` above it, and the normal there."""
    pole, u, v, _ = frame
    s = [math.cos(polar) * a + math.sin(polar) * (math.cos(around) * b + math.sin(around) * c)
         for a, b, c in zip(pole, u, v)]
    normal = unit([a / r for a, r in zip(s, RADII)])
    return [c + r * a + lift * n for c, r, a, n in zip(CENTER, RADII, s, normal)], normal


def cap(frame, first, last, rings, lift=0.0):
    points, normals, triangles = [], [], []
    for r in range(rings + 1):
        for s in range(SEGMENTS):
            point, normal = on_cap(frame, first + (last - first) * r / rings,
                                   2.0 * math.pi * s / SEGMENTS, lift)
            points.append(point)
            normals.append(normal)
    for r in range(rings):
        for s in range(SEGMENTS):
            a, b = r * SEGMENTS + s, r * SEGMENTS + (s + 1) % SEGMENTS
            triangles += [(a, a + SEGMENTS, b), (b, a + SEGMENTS, b + SEGMENTS)]
    return points, normals, triangles


def revolved(profile, center, axis, segments=SEGMENTS):
    """A closed profile of (radius, height) turned about an axis: flat rings between its corners."""
    axis = unit(axis)
    u = unit(cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 1.0, 0.0)))
    v = cross(axis, u)
    points, normals, triangles = [], [], []
    for (r0, h0), (r1, h1) in zip(profile, profile[1:]):
        slope = unit((h0 - h1, r1 - r0, 0.0))
        base = len(points)
        for s in range(segments):
            angle = 2.0 * math.pi * s / segments
            out = [math.cos(angle) * a + math.sin(angle) * b for a, b in zip(u, v)]
            for r, h in ((r0, h0), (r1, h1)):
                points.append([c + r * o + h * a for c, o, a in zip(center, out, axis)])
                normals.append([slope[0] * o + slope[1] * a for o, a in zip(out, axis)])
        for s in range(segments):
            a, b = base + 2 * s, base + 2 * ((s + 1) % segments)
            triangles += [(a, a + 1, b), (b, a + 1, b + 1)]
    return points, normals, triangles


def joined(parts):
    points, normals, triangles = [], [], []
    for p, n, t in parts:
        triangles += [tuple(i + len(points) for i in corner) for corner in t]
        points += p
        normals += n
    return points, normals, triangles


def activation():
    """Voxels of brain activity, 8 bits, as a TIFF file of slices."""
    with tempfile.TemporaryDirectory() as work:
        slices = []
        for k in range(ACTIVITY_SIZE):
            data = bytearray()
            for j in range(ACTIVITY_SIZE):
                for i in range(ACTIVITY_SIZE):
                    place = [ACTIVITY_SPACING * n for n in (i, j, k)]
                    value = sum(math.exp(-sum((a - b) ** 2 for a, b in zip(place, focus)) / radius ** 2)
                                for focus, radius in FOCI)
                    data.append(round(255 * min(value, 1.0)))
            slices.append(os.path.join(work, f"{k:03d}.pgm"))
            with open(slices[-1], "wb") as file:
                file.write(b"P5\n%d %d\n255\n" % (ACTIVITY_SIZE, ACTIVITY_SIZE) + data)
        subprocess.run(["oiiotool", *slices, "--siappendall", "--nosoftwareattrib", "--attrib",
                        "DateTime", "2026:01:01 00:00:00", "--compression", "zip:9", "-o",
                        os.path.join(FOLDER, "activation.tif")], check=True)


def head(w):
    appearance(w, "head", "head.tif", (128, 128, 84), "head.lut", shading=True)


def framed(w, radius, center, children):
    """A group whose bound is this sphere, for viewers to frame, whatever there is beyond it. Its children
    lie in a group of their own: OSG's Optimizer forgets the ranges of children that it merges."""
    w.object("osg::LOD", "framed")
    w.line("CullingActive FALSE")
    w.open("Children 1")
    w.object("osg::Group", "things")
    w.open(f"Children {children}")
    return lambda: (w.close(3), w.line("CenterMode USER_DEFINED_CENTER"),
                    w.line(f"UserCenter {numbers(center)} {radius:g}"), w.open("RangeList 1"),
                    w.line("0 1e+30"), w.close(2))


def transform(w, name, rows):
    w.object("osg::MatrixTransform", name, static=True)
    return lambda: (w.open("Matrix"), [w.line(r) for r in rows], w.close(2))


def begin_scene(radius, center, children, upright_children):
    """A writer that is at the things below the transform `upright`, what ends those, and the scene."""
    w = Writer()
    end_view = transform(w, "view", VIEW)
    w.open("Children 1")
    end_frame = framed(w, radius, center, children)
    end_upright = transform(w, "upright", UPRIGHT)
    w.open(f"Children {upright_children}")
    head(w)

    def end_things():
        w.close()
        end_upright()

    def end_scene(name):
        end_frame()
        w.close()
        end_view()
        w.save(name)

    return w, end_things, end_scene


def head_scene():
    _, end_things, end_scene = begin_scene(60, (0.0, 3.0, -10.0), 1, 1)
    end_things()
    end_scene("head.osgt")


def mixed_scene():
    w, end_things, end_scene = begin_scene(62, (0.0, 5.0, -7.0), 6, 2)
    frame = cap_frame()
    rim = frame[3]
    placed = (f"{ACTIVITY_SPACING} 0 0 0", f"0 {ACTIVITY_SPACING} 0 0", f"0 0 {ACTIVITY_SPACING} 0",
              numbers(ACTIVITY_ORIGIN) + " 1")
    appearance(w, "activity", "activation.tif", (ACTIVITY_SIZE,) * 3,
               [(0.0, 1, 1, 1, 0), (0.15, 1, 1, 1, 0), (0.4, 0.25, 0.9, 0.35, 0.85),
                (0.75, 0.05, 0.55, 1.0, 1), (1.0, 0.1, 0.3, 1.0, 1)],
               shading=False, rule="PAINT", placed=placed)
    end_things()
    mesh(w, "implant", *cap(frame, 0.002, rim - RIM, RINGS), (0.6, 0.85, 1.0), 0.28, 0.9, 90)
    mesh(w, "rim", *joined([cap(frame, rim - RIM, rim, 2, 0.6), cap(frame, rim - RIM, rim, 2, -0.6)]),
         (0.72, 0.74, 0.78), 1.0, 0.7, 60)
    screws = []
    for s in range(SCREWS):
        point, normal = on_cap(frame, rim - 0.5 * RIM, 2.0 * math.pi * (s + 0.5) / SCREWS)
        screws.append(revolved([(0.0, 2.0), (1.8, 1.7), (2.1, 0.4), (1.2, 0.2), (1.2, -5.0), (0.0, -6.5)],
                               point, normal, segments=14))
    mesh(w, "screws", *joined(screws), (0.85, 0.72, 0.45), 1.0, 0.8, 70)
    place, upwards = (0.0, 12.0, -51.0), (0.0, 0.0, 1.0)
    mesh(w, "base", *revolved([(0.0, 0.0), (43.0, 0.0)], place, upwards), (0.55, 0.9, 0.8), 0.45, 0.8, 80)
    mesh(w, "base ring", *revolved([(42.6, 0.9), (44.4, 0.9), (45.0, 0.3), (45.0, -1.2), (42.6, -1.2), (42.6, 0.9)],
                                   place, upwards), (0.72, 0.74, 0.78), 1.0, 0.7, 60)
    end_scene("mixed.osgt")


if __name__ == "__main__":
    activation()
    head_scene()
    mixed_scene()
