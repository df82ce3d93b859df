#!/usr/bin/env python3
"""chart.py CSV FOLDER [wall|cpu]: draws FOLDER/chart.svg and writes FOLDER/chart.md from what
osgVolumizerChart measured. Times are medians over rounds; ratios are medians of each round's ratio."""

import csv
import math
import statistics
import sys

COLORS = {
    "osgVolumizer slabs": "#d62728", "osgVolumizer slices": "#ff9896",
    "bare march": "#000000", "bare march integral": "#7f7f7f",
    "osgVolume FixedFunction": "#9467bd", "osgVolume RayTraced": "#1f77b4",
    "osgVolume Multipass": "#17becf", "VTK GPU": "#2ca02c", "VTK CPU": "#bcbd22",
}
LIBRARY = "osgVolumizer slabs"
TARGETS = (4e-3, 1e-3)
PANEL_WIDTH, PANEL_HEIGHT, MARGIN, COLUMNS = 300, 240, 48, 3


def read(file_name, clock):
    """{scene: (description, {renderer: [(step, rmse, maximum, bias, [ms of each round])]})}, by step."""
    scenes = {}
    with open(file_name, newline="") as file:
        for row in csv.DictReader(file):
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
        names = [n for n in COLORS if any(n in curves for _, curves in scenes.values())]
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


def text(x, y, words, anchor="middle", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{words}</text>'


def draw_panel(panel, title, curves):
    right, bottom = panel.left + PANEL_WIDTH, panel.top + PANEL_HEIGHT
    out = [f'<rect x="{panel.left}" y="{panel.top}" width="{PANEL_WIDTH}" height="{PANEL_HEIGHT}" '
           'fill="none" stroke="#888"/>',
           text(panel.left + PANEL_WIDTH / 2, panel.top - 8, title, extra='font-weight="bold"')]
    for value in panel.ticks(*panel.x, (1, 2, 5)):
        x, _ = panel.at(value, 10.0 ** panel.y[0])
        out.append(f'<path d="M{x:.1f} {panel.top}V{bottom}" stroke="#ddd"/>')
        out.append(text(x, bottom + 14, f"{value:g}"))
    for value in panel.ticks(*panel.y, (1,)):
        _, y = panel.at(10.0 ** panel.x[0], value)
        out.append(f'<path d="M{panel.left} {y:.1f}H{right}" stroke="#ddd"/>')
        out.append(text(panel.left - 5, y + 4, f"{value:.0e}", "end"))
    for name, points in curves.items():
        places = [panel.at(statistics.median(p[4]), p[1]) for p in points if p[1] > 0]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        color = COLORS.get(name, "#8c564b")
        dash = ' stroke-dasharray="5 3"' if name.startswith("bare") else ""
        out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.8"{dash}/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.6" fill="{color}"/>' for x, y in places]
    return out


def svg(scenes, clock):
    rows = math.ceil(len(scenes) / COLUMNS)
    width = COLUMNS * (PANEL_WIDTH + 1.7 * MARGIN) + MARGIN
    height = rows * (PANEL_HEIGHT + 1.6 * MARGIN) + 2.2 * MARGIN
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
           'font-family="sans-serif" font-size="11">', '<rect width="100%" height="100%" fill="#fff"/>',
           text(width / 2, 18, f"Root mean square error (up) against {clock} milliseconds a frame (across); "
                "one point a sample distance", extra='font-size="14"')]
    names = [n for n in COLORS if any(n in curves for _, curves in scenes.values())]
    x = MARGIN
    for name in names:
        out.append(f'<path d="M{x:.1f} 34h14" stroke="{COLORS[name]}" stroke-width="3"/>')
        out.append(text(x + 18, 38, name, "start", 'font-size="10"'))
        x += 36 + 5.5 * len(name)
    for i, (scene, (description, curves)) in enumerate(scenes.items()):
        left = MARGIN * 1.4 + (i % COLUMNS) * (PANEL_WIDTH + 1.7 * MARGIN)
        top = 1.6 * MARGIN + (i // COLUMNS) * (PANEL_HEIGHT + 1.6 * MARGIN)
        out += draw_panel(Panel(left, top, curves), f"{scene}: {description}", curves)
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    clock = sys.argv[3] if len(sys.argv) > 3 else "wall"
    scenes = read(sys.argv[1], clock)
    for name, content in (("chart.svg", svg(scenes, clock)), ("chart.md", markdown(scenes, clock))):
        with open(f"{sys.argv[2]}/{name}", "w") as file:
            file.write(content)


if __name__ == "__main__":
    main()
