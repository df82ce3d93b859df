"""What chart.py and mesh_chart.py share: pieces of SVG, and the comments that a run begins with."""

import csv
import math

PANEL_WIDTH, PANEL_HEIGHT = 310, 250


def comments(file_name):
    """What the program wrote of its run, as "# name: value" lines."""
    with open(file_name) as file:
        return [line[1:].strip() for line in file if line.startswith("#")]


class Panel:
    """Logarithmic axes that hold the (x, y) of points, all positive."""

    def __init__(self, left, top, points):
        self.left, self.top = left, top
        self.x = self.decades([p[0] for p in points])
        self.y = self.decades([p[1] for p in points])

    @staticmethod
    def decades(values):
        low, high = math.log10(min(values)), math.log10(max(values))
        return (low - 0.05 * (high - low) - 0.01, high + 0.05 * (high - low) + 0.01)

    def at(self, x, y):
        u = (math.log10(x) - self.x[0]) / (self.x[1] - self.x[0])
        v = (math.log10(y) - self.y[0]) / (self.y[1] - self.y[0])
        return (self.left + u * PANEL_WIDTH, self.top + (1 - v) * PANEL_HEIGHT)

    @staticmethod
    def ticks(low, high, factors):
        for decade in range(math.floor(low), math.ceil(high) + 1):
            for factor in factors:
                value = factor * 10.0 ** decade
                if low <= math.log10(value) <= high:
                    yield value


def read(file_name, clock, column, kind):
    """{scene: (description, {renderer: [(kind(column), rmse, maximum, bias, [ms of each round])]})}."""
    scenes = {}
    with open(file_name, newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            curves = scenes.setdefault(row["scene"], (row["description"], {}))[1]
            rounds = [float(t) for t in row[clock + "_ms_rounds"].split(";")]
            curves.setdefault(row["renderer"], []).append(
                (kind(row[column]), float(row["rmse"]), float(row["maximum"]), float(row["bias"]), rounds))
    return scenes


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


def number(value):
    """1e-3 rather than 0.001 or 1e-03."""
    return f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e")


def draw_axes(panel, across, up, across_tick="{:g}".format, up_tick=number, factors=(1, 2, 5),
              up_factors=(1,)):
    """The frame, grid, and both names. Ticks are labelled by the functions; they are the factors times
    powers of ten, and across these alone where there are many."""
    right, bottom = panel.left + PANEL_WIDTH, panel.top + PANEL_HEIGHT
    out = [f'<rect x="{panel.left}" y="{panel.top}" width="{PANEL_WIDTH}" height="{PANEL_HEIGHT}" '
           'fill="none" stroke="#888"/>',
           text(panel.left + PANEL_WIDTH / 2, bottom + 31, across),
           text(0, 0, up, extra=f'transform="translate({panel.left - 43} '
                f'{panel.top + PANEL_HEIGHT / 2}) rotate(-90)"')]
    wide = panel.x[1] - panel.x[0] > 2.2
    for value in panel.ticks(*panel.x, (1, 10) if wide else factors):
        x, _ = panel.at(value, 10.0 ** panel.y[0])
        out.append(f'<path d="M{x:.1f} {panel.top}V{bottom}" stroke="#e2e2e2"/>')
        out.append(text(x, bottom + 15, across_tick(value)))
    for value in panel.ticks(*panel.y, up_factors):
        _, y = panel.at(10.0 ** panel.x[0], value)
        out.append(f'<path d="M{panel.left} {y:.1f}H{right}" stroke="#e2e2e2"/>')
        out.append(text(panel.left - 5, y + 4, up_tick(value), "end"))
    return out


def draw_title(panel, title, description):
    middle = panel.left + PANEL_WIDTH / 2
    return [text(middle, panel.top - 21, title, extra='font-weight="bold" font-size="13"'),
            text(middle, panel.top - 7, description, extra='font-size="10"')]


def draw_curve(panel, points, style, width):
    """A line with a mark at each (x, y); style: colour, marker, dash."""
    color, shape, dash = style
    places = [panel.at(*p) for p in points]
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return [f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}"{dashes}/>'] + \
        [marker(shape, x, y, color) for x, y in places]


def draw_legend(left, top, styles, notes):
    """styles: {name: style}, in order."""
    out = []
    for i, (name, (color, shape, dash)) in enumerate(styles.items()):
        y = top + 19 * i
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        out.append(f'<path d="M{left:.1f} {y:.1f}h36" stroke="{color}" stroke-width="2"{dashes}/>')
        out.append(marker(shape, left + 18, y, color))
        out.append(text(left + 46, y + 4, name, "start", 'font-size="12"'))
    for i, note in enumerate(notes):
        out.append(text(left, top + 19 * len(styles) + 12 + 15 * i, note, "start", 'font-size="10.5"'))
    return out


def document(width, height, title, run, parts):
    """The whole file; run: the comments of the measurement."""
    return "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
         f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
         f"<desc>{escaped('; '.join(run))}</desc>", '<rect width="100%" height="100%" fill="#fff"/>',
         text(width / 2, 20, title, extra='font-size="16"')] + parts + ["</svg>"]) + "\n"
