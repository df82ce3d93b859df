#!/usr/bin/env python3
"""chart.py CSV FOLDER [wall|cpu]: draws FOLDER/chart.svg and writes FOLDER/chart.md from what
osgVolumizerChart measured. Times are medians over rounds; ratios are medians of each round's ratio."""

import math
import statistics
import sys

from charting import (PANEL_WIDTH, Panel, comments, document, draw_axes, draw_curve, draw_legend, draw_title,
                      number, read, text)

# Colour, marker, dash: told apart by either of the first two, also by people who see few colours.
STYLES = {
    "osgVolumizer slabs": ("#c4001d", "circle", ""),
    "osgVolumizer, error asked for": ("#ff5a3c", "diamond", "5 2"),
    "osgVolumizer slabs cell by cell": ("#7a0012", "down", "1 2"), "osgVolumizer slices": ("#e69f00", "square", "6 3"),
    "bare march": ("#000000", "plus", "4 3"), "bare march integral": ("#808080", "cross", "4 3"),
    "osgVolume FixedFunction": ("#8a3ab9", "up", ""), "osgVolume RayTraced": ("#0050c0", "down", ""),
    "osgVolume Multipass": ("#00a0a0", "diamond", ""), "VTK GPU": ("#5f8a00", "hollow", ""),
    "VTK CPU": ("#8b4513", "bar", ""), "VolPack": ("#d6409f", "square", "2 2"),
    "OpenVDB VolumeRender": ("#005f5f", "up", "8 3"),
}
LIBRARY = "osgVolumizer slabs"
TARGETS = (4e-3, 1e-3, 1e-4)
COLUMNS = 3
CELL_WIDTH, CELL_HEIGHT, LEFT, TOP = 395, 345, 64, 62  # of a panel with its titles; of the first one


def read_sorted(file_name, clock):
    """What charting.read() gives, by step."""
    scenes = read(file_name, clock, "step_voxel", float)
    for _, curves in scenes.values():
        for points in curves.values():
            points.sort(reverse=True)
    return scenes


def time_at(points, rmse, pick):
    """Milliseconds at which the curve falls to rmse (a line in the logarithms between two steps), pick(rounds)
    being the time of a point; negative: of the coarsest step, already better; None: never."""
    before = None
    for _, error, _, _, rounds in points:
        time = pick(rounds)
        if error <= rmse:
            if before is None:
                return -time
            weight = math.log(before[0] / rmse) / math.log(before[0] / error)
            return math.exp(math.log(before[1]) * (1 - weight) + math.log(time) * weight)
        before = (error, time)
    return None


def ratio(points, library, rmse):
    """Median over rounds of (time of points) / (time of library) at one rmse, or None."""
    rounds = min(len(p[4]) for p in points + library)
    ratios = []
    for i in range(rounds):
        a = time_at(points, rmse, lambda times: times[i])
        b = time_at(library, rmse, lambda times: times[i])
        if a is None or b is None:
            return None
        ratios.append(abs(a) / abs(b))
    return statistics.median(ratios)


def order(points):
    """Slope of the least squares line through log error against log step; the four finest steps above
    an error of 1e-6."""
    used = [(math.log(p[0]), math.log(p[1])) for p in points if p[1] > 1e-6][-4:]
    if len(used) < 2:
        return float("nan")
    mx, my = (statistics.mean(v[i] for v in used) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in used) / sum((x - mx) ** 2 for x, _ in used)


def markdown(scenes, clock):
    lines = []
    for target in TARGETS:
        names = [n for n in STYLES if any(n in curves for _, curves in scenes.values())]
        lines += [f"Milliseconds ({clock}) to a root mean square error of {target:g}, and times the time of "
                  f"{LIBRARY} (median of rounds); '-': never at the steps tried, with the least error reached; "
                  "'<': at the coarsest step, which is better than that.", "",
                  "| scene | " + " | ".join(names) + " |",
                  "|---" * (len(names) + 1) + "|"]
        for scene, (_, curves) in scenes.items():
            cells = []
            for name in names:
                if name not in curves:
                    cells.append("not drawn")
                    continue
                time = time_at(curves[name], target, statistics.median)
                if time is None:
                    cells.append(f"- ({min(p[1] for p in curves[name]):.1e})")
                    continue
                text = f"{'<' if time < 0 else ''}{abs(time):.{0 if abs(time) >= 10 else 1}f}"
                times = ratio(curves[name], curves[LIBRARY], target) if LIBRARY in curves else None
                cells.append(text + (f" ({times:.2f}x)" if times and name != LIBRARY else ""))
            lines.append(f"| {scene} | " + " | ".join(cells) + " |")
        lines.append("")
    lines += ["| scene | renderer | order in step | least RMSE | its maximum | its bias | its step |",
              "|---|---|---|---|---|---|---|"]
    for scene, (_, curves) in scenes.items():
        for name, points in curves.items():
            best = min(points, key=lambda p: p[1])
            lines.append(f"| {scene} | {name} | {order(points):.1f} | {best[1]:.1e} | {best[2]:.1e} "
                         f"| {best[3]:+.1e} | {best[0]:g} |")
    return "\n".join(lines) + "\n"


def draw_targets(panel):
    right = panel.left + PANEL_WIDTH
    out = []
    for value in TARGETS:
        if panel.y[0] <= math.log10(value) <= panel.y[1]:
            _, y = panel.at(10.0 ** panel.x[0], value)
            out.append(f'<path d="M{panel.left} {y:.1f}H{right}" stroke="#c4001d" stroke-dasharray="2 3"/>')
            out.append(text(right + 3, y + 3, number(value), "start", 'font-size="9" fill="#c4001d"'))
    return out


def places(points):
    return [(statistics.median(p[4]), p[1]) for p in points if p[1] > 0]


def draw_panel(left, top, scene, description, curves):
    panel = Panel(left, top, [place for points in curves.values() for place in places(points)])
    out = draw_title(panel, scene, description)
    out += draw_axes(panel, "milliseconds a frame", "root mean square error") + draw_targets(panel)
    for name in reversed(list(STYLES)):  # ours on top
        if name in curves:
            out += draw_curve(panel, places(curves[name]), STYLES[name], 2.6 if name == LIBRARY else 1.5)
    return out


def svg(scenes, clock, run):
    cells = len(scenes) + 1
    rows = math.ceil(cells / COLUMNS)
    steps = sorted({p[0] for _, curves in scenes.values() for c in curves.values() for p in c})
    names = [n for n in STYLES if any(n in curves for _, curves in scenes.values())]
    notes = ["Down and to the left is better. Each mark is one distance",
             f"between samples, from {steps[-1]:g} voxels (top left) to {steps[0]:g} (bottom",
             "right), each half of the one before; a curve ends where a",
             "frame takes half a second. Where the error is asked for, that",
             "is a thousandth for each voxel of a step, and what came out.",
             "Dotted: the errors that the tables of the README are for.",
             f"Times: {clock}, medians over rounds."] + run
    legend = 19 * len(names) + 15 * (len(notes) + 3)
    width, height = COLUMNS * CELL_WIDTH + 10, rows * CELL_HEIGHT + 36 + max(0, legend - CELL_HEIGHT)
    parts = []
    for i, (scene, (description, curves)) in enumerate(scenes.items()):
        left, top = LEFT + (i % COLUMNS) * CELL_WIDTH, TOP + (i // COLUMNS) * CELL_HEIGHT
        parts += draw_panel(left, top, scene, description, curves)
    last = cells - 1
    parts += draw_legend(LEFT - 20 + (last % COLUMNS) * CELL_WIDTH, TOP + 6 + (last // COLUMNS) * CELL_HEIGHT,
                         {n: STYLES[n] for n in names}, notes)
    title = "Time against error of volume renderers, scene by scene"
    return document(width, height, title, run, parts)


def main():
    clock = sys.argv[3] if len(sys.argv) > 3 else "wall"
    scenes, run = read_sorted(sys.argv[1], clock), comments(sys.argv[1])
    for name, content in (("chart.svg", svg(scenes, clock, run)), ("chart.md", markdown(scenes, clock))):
        with open(f"{sys.argv[2]}/{name}", "w") as file:
            file.write(content)


if __name__ == "__main__":
    main()
