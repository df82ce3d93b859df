#!/usr/bin/env python3
"""chart.py CSV FOLDER [wall|cpu]: draws FOLDER/chart.svg and writes FOLDER/chart.md from what
osgVolumizerChart measured. Times are medians over rounds; ratios are medians of each round's ratio."""

import csv
import math
import statistics
import sys

# Colour, marker, dash: told apart by either of the first two, also by people who see few colours.
STYLES = {
    "osgVolumizer slabs": ("#c4001d", "circle", ""), "osgVolumizer slices": ("#e69f00", "square", "6 3"),
    "bare march": ("#000000", "plus", "4 3"), "bare march integral": ("#808080", "cross", "4 3"),
    "osgVolume FixedFunction": ("#8a3ab9", "up", ""), "osgVolume RayTraced": ("#0050c0", "down", ""),
    "osgVolume Multipass": ("#00a0a0", "diamond", ""), "VTK GPU": ("#5f8a00", "hollow", ""),
    "VTK CPU": ("#8b4513", "bar", ""),
}
LIBRARY = "osgVolumizer slabs"
TARGETS = (4e-3, 1e-3)
PANEL_WIDTH, PANEL_HEIGHT, COLUMNS = 310, 250, 3
CELL_WIDTH, CELL_HEIGHT, LEFT, TOP = 395, 345, 64, 62  # of a panel with its titles; of the first one


def comments(file_name):
    """What the program wrote of its run, as "# name: value" lines."""
    with open(file_name) as file:
        return [line[1:].strip() for line in file if line.startswith("#")]


def read(file_name, clock):
    """{scene: (description, {renderer: [(step, rmse, maximum, bias, [ms of each round])]})}, by step."""
    scenes = {}
    with open(file_name, newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            curves = scenes.setdefault(row["scene"], (row["description"], {}))[1]
            rounds = [float(t) for t in row[clock + "_ms_rounds"].split(";")]
            curves.setdefault(row["renderer"], []).append(
                (float(row["step_voxel"]), float(row["rmse"]), float(row["maximum"]),
                 float(row["bias"]), rounds))
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


class Panel:
    """Logarithmic axes: time across, error up."""

    def __init__(self, left, top, curves):
        self.left, self.top = left, top
        points = [(statistics.median(p[4]), p[1]) for c in curves.values() for p in c if p[1] > 0]
        self.x = self.decades([p[0] for p in points])
        self.y = self.decades([p[1] for p in points])

    @staticmethod
    def decades(values):
        low, high = math.log10(min(values)), math.log10(max(values))
        return (low - 0.05 * (high - low) - 0.01, high + 0.05 * (high - low) + 0.01)

    def at(self, time, error):
        u = (math.log10(time) - self.x[0]) / (self.x[1] - self.x[0])
        v = (math.log10(error) - self.y[0]) / (self.y[1] - self.y[0])
        return (self.left + u * PANEL_WIDTH, self.top + (1 - v) * PANEL_HEIGHT)

    @staticmethod
    def ticks(low, high, factors):
        for decade in range(math.floor(low), math.ceil(high) + 1):
            for factor in factors:
                value = factor * 10.0 ** decade
                if low <= math.log10(value) <= high:
                    yield value


def escaped(words):
    return words.replace("&", "&amp;").replace("<", "&lt;")


def text(x, y, words, anchor="middle", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{escaped(words)}</text>'


def marker(shape, x, y, color):
    r = 3.2
    paths = {"square": f"M{x - r:.1f} {y - r:.1f}h{2 * r}v{2 * r}h{-2 * r}z",
             "up": f"M{x:.1f} {y - r - 0.6:.1f}l{r + 0.6} {2 * r}h{-2 * r - 1.2}z",
             "down": f"M{x:.1f} {y + r + 0.6:.1f}l{r + 0.6} {-2 * r}h{-2 * r - 1.2}z",
             "diamond": f"M{x:.1f} {y - r - 1:.1f}l{r + 1} {r + 1}l{-r - 1} {r + 1}l{-r - 1} {-r - 1}z"}
    strokes = {"plus": f"M{x - r - 1:.1f} {y:.1f}h{2 * r + 2}M{x:.1f} {y - r - 1:.1f}v{2 * r + 2}",
               "cross": f"M{x - r:.1f} {y - r:.1f}l{2 * r} {2 * r}M{x - r:.1f} {y + r:.1f}l{2 * r} {-2 * r}",
               "bar": f"M{x:.1f} {y - r - 1.5:.1f}v{2 * r + 3}"}
    if shape in paths:
        return f'<path d="{paths[shape]}" fill="{color}"/>'
    if shape in strokes:
        return f'<path d="{strokes[shape]}" stroke="{color}" stroke-width="1.8" fill="none"/>'
    fill = "#fff" if shape == "hollow" else color
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}" fill="{fill}" stroke="{color}" stroke-width="1.5"/>'


def draw_axes(panel):
    right, bottom = panel.left + PANEL_WIDTH, panel.top + PANEL_HEIGHT
    out = [f'<rect x="{panel.left}" y="{panel.top}" width="{PANEL_WIDTH}" height="{PANEL_HEIGHT}" '
           'fill="none" stroke="#888"/>',
           text(panel.left + PANEL_WIDTH / 2, bottom + 31, "milliseconds a frame"),
           text(0, 0, "root mean square error", extra=f'transform="translate({panel.left - 43} '
                f'{panel.top + PANEL_HEIGHT / 2}) rotate(-90)"')]
    wide = panel.x[1] - panel.x[0] > 2.2
    for value in panel.ticks(*panel.x, (1, 10) if wide else (1, 2, 5)):
        x, _ = panel.at(value, 10.0 ** panel.y[0])
        out.append(f'<path d="M{x:.1f} {panel.top}V{bottom}" stroke="#e2e2e2"/>')
        out.append(text(x, bottom + 15, f"{value:g}"))
    for value in panel.ticks(*panel.y, (1,)):
        _, y = panel.at(10.0 ** panel.x[0], value)
        out.append(f'<path d="M{panel.left} {y:.1f}H{right}" stroke="#e2e2e2"/>')
        out.append(text(panel.left - 5, y + 4, f"{value:.0e}".replace("e-0", "e-"), "end"))
    for value in TARGETS:
        if panel.y[0] <= math.log10(value) <= panel.y[1]:
            _, y = panel.at(10.0 ** panel.x[0], value)
            out.append(f'<path d="M{panel.left} {y:.1f}H{right}" stroke="#c4001d" stroke-dasharray="2 3"/>')
            out.append(text(right + 3, y + 3, f"{value:.0e}".replace("e-0", "e-"), "start",
                            'font-size="9" fill="#c4001d"'))
    return out


def draw_panel(panel, scene, description, curves):
    middle = panel.left + PANEL_WIDTH / 2
    out = [text(middle, panel.top - 21, scene, extra='font-weight="bold" font-size="13"'),
           text(middle, panel.top - 7, description, extra='font-size="10"')] + draw_axes(panel)
    for name in reversed(list(STYLES)):  # ours on top
        if name not in curves:
            continue
        color, shape, dash = STYLES[name]
        places = [panel.at(statistics.median(p[4]), p[1]) for p in curves[name] if p[1] > 0]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        wide = 2.6 if name == LIBRARY else 1.5
        out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{wide}"{dashes}/>')
        out += [marker(shape, x, y, color) for x, y in places]
    return out


def draw_legend(left, top, names, notes):
    out = []
    for i, name in enumerate(names):
        color, shape, dash = STYLES[name]
        y = top + 19 * i
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        out.append(f'<path d="M{left:.1f} {y:.1f}h36" stroke="{color}" stroke-width="2"{dashes}/>')
        out.append(marker(shape, left + 18, y, color))
        out.append(text(left + 46, y + 4, name, "start", 'font-size="12"'))
    for i, note in enumerate(notes):
        out.append(text(left, top + 19 * len(names) + 12 + 15 * i, note, "start", 'font-size="10.5"'))
    return out


def svg(scenes, clock, run):
    cells = len(scenes) + 1
    rows = math.ceil(cells / COLUMNS)
    width, height = COLUMNS * CELL_WIDTH + 10, rows * CELL_HEIGHT + 36
    steps = sorted({p[0] for _, curves in scenes.values() for c in curves.values() for p in c})
    names = [n for n in STYLES if any(n in curves for _, curves in scenes.values())]
    notes = ["Down and to the left is better. Each mark is one distance",
             f"between samples, from {steps[-1]:g} voxels (top left) to {steps[0]:g} (bottom",
             "right), each half of the one before; a curve ends where a",
             "frame takes half a second.",
             "Dotted: the errors that the tables of the README are for.",
             f"Times: {clock}, medians over rounds."] + run
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
           f"<desc>{escaped('; '.join(run))}</desc>", '<rect width="100%" height="100%" fill="#fff"/>',
           text(width / 2, 20, "Time against error of volume renderers in OpenSceneGraph and VTK, scene by scene",
                extra='font-size="16"')]
    for i, (scene, (description, curves)) in enumerate(scenes.items()):
        left, top = LEFT + (i % COLUMNS) * CELL_WIDTH, TOP + (i // COLUMNS) * CELL_HEIGHT
        out += draw_panel(Panel(left, top, curves), scene, description, curves)
    last = cells - 1
    out += draw_legend(LEFT - 20 + (last % COLUMNS) * CELL_WIDTH, TOP + 6 + (last // COLUMNS) * CELL_HEIGHT,
                       names, notes)
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    clock = sys.argv[3] if len(sys.argv) > 3 else "wall"
    scenes, run = read(sys.argv[1], clock), comments(sys.argv[1])
    for name, content in (("chart.svg", svg(scenes, clock, run)), ("chart.md", markdown(scenes, clock))):
        with open(f"{sys.argv[2]}/{name}", "w") as file:
            file.write(content)


if __name__ == "__main__":
    main()
