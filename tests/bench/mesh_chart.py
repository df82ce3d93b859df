#!/usr/bin/env python3
"""mesh_chart.py CSV FOLDER [wall|cpu]: draws FOLDER/mesh.svg and writes FOLDER/mesh.md from what
osgVolumizerMeshChart measured. Times are medians over rounds; ratios are medians of each round's ratio."""

import statistics
import sys

from charting import (Panel, comments, document, draw_axes, draw_curve, draw_legend, draw_title, number, read)

# Colour, marker, dash: told apart by either of the first two, also by people who see few colours.
STYLES = {
    "osgVolumizer": ("#c4001d", "circle", ""), "VTK projected tetrahedra": ("#5f8a00", "hollow", ""),
    "VTK rays": ("#8b4513", "bar", ""), "VTK rays partial": ("#0050c0", "down", "6 3"),
    "VTK rays linear": ("#8a3ab9", "up", "4 3"),
}
LIBRARY = "osgVolumizer"
CELL_WIDTH, CELL_HEIGHT, LEFT, TOP = 395, 345, 64, 62  # of a panel with its titles; of the first one


def read_sorted(file_name, clock):
    """What charting.read() gives, by size."""
    scenes = read(file_name, clock, "tetrahedra", int)
    for _, curves in scenes.values():
        for points in curves.values():
            points.sort()
    return scenes


def ratio(rounds, library):
    """Median over rounds of a time over the library's."""
    return statistics.median(a / b for a, b in zip(rounds, library))


def markdown(scenes, clock):
    lines = [f"Milliseconds ({clock}) of a frame, each of a new view, and times the time of {LIBRARY} (median of "
             "rounds); root mean square error against double precision, its maximum and its bias.", "",
             "| scene | tetrahedra | renderer | ms | RMSE | maximum | bias |", "|---|---|---|---|---|---|---|"]
    for scene, (_, curves) in scenes.items():
        library = {p[0]: p[4] for p in curves.get(LIBRARY, [])}
        for size in sorted({p[0] for points in curves.values() for p in points}):
            for name, points in curves.items():
                for _, rmse, maximum, bias, rounds in (p for p in points if p[0] == size):
                    time = f"{statistics.median(rounds):.1f}"
                    if name != LIBRARY and size in library:
                        time += f" ({ratio(rounds, library[size]):.2f}x)"
                    lines.append(f"| {scene} | {size} | {name} | {time} | {rmse:.1e} | {maximum:.1e} | {bias:+.1e} |")
    return "\n".join(lines) + "\n"


def draw_panel(left, top, title, description, up, curves):
    """curves: {renderer: [(tetrahedra, value)]}; values of 0 have no place on a logarithmic axis."""
    curves = {name: [p for p in points if p[1] > 0] for name, points in curves.items()}
    panel = Panel(left, top, [p for points in curves.values() for p in points])
    out = draw_title(panel, title, description)
    out += draw_axes(panel, "tetrahedra", up, number, number if up.startswith("root") else "{:g}".format, (1, 3),
                     (1, 3))
    for name in reversed(list(STYLES)):  # ours on top
        if curves.get(name):
            out += draw_curve(panel, curves[name], STYLES[name], 2.6 if name == LIBRARY else 1.5)
    return out


def svg(scenes, clock, run):
    """One row a scene: time, and error, against the number of tetrahedra."""
    parts = []
    for i, (scene, (description, curves)) in enumerate(scenes.items()):
        top = TOP + i * CELL_HEIGHT
        times = {n: [(p[0], statistics.median(p[4])) for p in points] for n, points in curves.items()}
        errors = {n: [(p[0], p[1]) for p in points] for n, points in curves.items()}
        parts += draw_panel(LEFT, top, scene, description, "milliseconds a frame", times)
        parts += draw_panel(LEFT + CELL_WIDTH, top, scene, description, "root mean square error", errors)
    styles = {n: s for n, s in STYLES.items() if any(n in curves for _, curves in scenes.values())}
    notes = ["Down is better. Each frame that is timed is of a new", "view. VTK's rays are cast on the CPU, its picture has",
             "8 bits; its projected tetrahedra have colours of 8 bits.",
             "Errors are against double precision, on every fourth", "pixel in x and y.",
             f"Times: {clock}, medians over rounds."] + run
    parts += draw_legend(LEFT - 20 + 2 * CELL_WIDTH, TOP + 6, styles, notes)
    title = "Time and error of renderers of unstructured grids in OpenSceneGraph and VTK"
    return document(3 * CELL_WIDTH + 10, len(scenes) * CELL_HEIGHT + 36, title, run, parts)


def main():
    clock = sys.argv[3] if len(sys.argv) > 3 else "wall"
    scenes, run = read_sorted(sys.argv[1], clock), comments(sys.argv[1])
    for name, content in (("mesh.svg", svg(scenes, clock, run)), ("mesh.md", markdown(scenes, clock))):
        with open(f"{sys.argv[2]}/{name}", "w") as file:
            file.write(content)


if __name__ == "__main__":
    main()
