"""Charts as inline SVG. Colours come from the page's style sheet (light, dark and print), numbers have a
fixed number of digits: the same data give the same bytes."""

import math

WIDTH, HEIGHT = 360, 240
LEFT, RIGHT, TOP, BOTTOM = 52, 12, 12, 44


def _n(value):
    """A coordinate."""
    return f"{value:.2f}".rstrip("0").rstrip(".")


def escape(text):
    return str(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").replace('"', "&quot;")


def tick_text(value):
    return f"{value:.10g}".replace("-", "\u2212")


def linear_ticks(low, high, target=5):
    """Round numbers (1, 2 or 5 times a power of ten) within [low, high], about `target` of them."""
    if not high > low:
        return [low]
    raw = (high - low) / target
    power = 10 ** math.floor(math.log10(raw))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [round(i * step, 12) for i in range(first, last + 1)]


class Axis:
    """Maps values to positions."""

    def __init__(self, low, high, start, end, is_log=False):
        self.is_log = is_log
        self._low, self._high = self._of(low), self._of(high)
        if self._high <= self._low:
            self._high = self._low + 1
        self._start, self._end = start, end
        self.low, self.high = low, high

    def _of(self, value):
        return math.log10(value) if self.is_log else value

    def __call__(self, value):
        share = (self._of(value) - self._low) / (self._high - self._low)
        return self._start + share * (self._end - self._start)

    def ticks(self):
        if not self.is_log:
            return linear_ticks(self.low, self.high)
        decades = range(math.floor(self._low), math.ceil(self._high) + 1)
        factors = (1,) if self._high - self._low > 3 else (1, 2, 5)
        ticks = [factor * 10.0**decade for decade in decades for factor in factors]
        return [tick for tick in ticks if self._low - 1e-9 <= math.log10(tick) <= self._high + 1e-9]


class Chart:
    """One figure: axes with labels and units, marks, and a title for who cannot see it."""

    def __init__(self, title, x_label, y_label, x_range, y_range, x_log=False, y_log=False):
        self.x = Axis(*x_range, LEFT, WIDTH - RIGHT, x_log)
        self.y = Axis(*y_range, HEIGHT - BOTTOM, TOP, y_log)
        self._title, self._x_label, self._y_label = title, x_label, y_label
        self._marks = []

    def bar(self, x0, x1, y0, y1, style):
        left, right = sorted((self.x(x0), self.x(x1)))
        top, bottom = sorted((self.y(y0), self.y(y1)))
        self._marks.append(
            f'<rect class="{style}" x="{_n(left)}" y="{_n(top)}" width="{_n(max(right - left - 0.6, 0.6))}" '
            f'height="{_n(bottom - top)}"/>'
        )

    def dot(self, x, y, style, label=""):
        title = f"<title>{escape(label)}</title>" if label else ""
        self._marks.append(
            f'<circle class="{style}" cx="{_n(self.x(x))}" cy="{_n(self.y(y))}" r="3.2">{title}</circle>'
        )

    def line(self, points, style):
        path = " ".join(f"{_n(self.x(x))},{_n(self.y(y))}" for x, y in points)
        self._marks.append(f'<polyline class="{style}" points="{path}"/>')

    def vertical(self, x, style):
        self.line([(x, self.y.low), (x, self.y.high)], style)

    def text(self, x, y, text, style="note"):
        self._marks.append(
            f'<text class="{style}" x="{_n(self.x(x))}" y="{_n(self.y(y))}" text-anchor="middle">{escape(text)}</text>'
        )

    def svg(self):
        return (
            f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(self._title)}">'
            + self._axes()
            + "".join(self._marks)
            + "</svg>"
        )

    def _axes(self):
        bottom, right = HEIGHT - BOTTOM, WIDTH - RIGHT
        parts = []
        for tick in self.x.ticks():
            x = _n(self.x(tick))
            parts.append(f'<line class="grid" x1="{x}" y1="{TOP}" x2="{x}" y2="{bottom}"/>')
            parts.append(f'<text class="tick" x="{x}" y="{bottom + 14}" text-anchor="middle">{tick_text(tick)}</text>')
        for tick in self.y.ticks():
            y = _n(self.y(tick))
            parts.append(f'<line class="grid" x1="{LEFT}" y1="{y}" x2="{right}" y2="{y}"/>')
            parts.append(f'<text class="tick" x="{LEFT - 5}" y="{_n(self.y(tick) + 3.5)}" text-anchor="end">{tick_text(tick)}</text>')
        parts.append(f'<polyline class="axis" points="{LEFT},{TOP} {LEFT},{bottom} {right},{bottom}"/>')
        middle_x, middle_y = (LEFT + right) / 2, (TOP + bottom) / 2
        parts.append(f'<text class="label" x="{_n(middle_x)}" y="{HEIGHT - 10}" text-anchor="middle">{escape(self._x_label)}</text>')
        parts.append(
            f'<text class="label" x="13" y="{_n(middle_y)}" text-anchor="middle" '
            f'transform="rotate(-90 13 {_n(middle_y)})">{escape(self._y_label)}</text>'
        )
        return "".join(parts)


def histogram_with_gaussian(title, x_label, kept, dropped):
    """What the sets gave: bars of the kept (full) and dropped (pale) ones, the Gaussian of the kept."""
    values = kept + dropped
    mean = sum(kept) / len(kept) if kept else 0.0
    sigma = math.sqrt(sum((v - mean) ** 2 for v in kept) / len(kept)) if kept else 0.0
    reach = max([4 * sigma] + [abs(v - mean) for v in kept] + [1e-9]) * 1.05
    low, high, bins = mean - reach, mean + reach, 24
    width = (high - low) / bins

    def counts(of):
        found = [0] * bins
        for value in of:  # what lies beyond is counted in the outermost bars
            found[min(max(int((value - low) / width), 0), bins - 1)] += 1
        return found

    kept_counts, dropped_counts = counts(kept), counts(dropped)
    peak = len(kept) * width / (sigma * math.sqrt(2 * math.pi)) if sigma > 0 else 0
    top = max([k + d for k, d in zip(kept_counts, dropped_counts)] + [peak, 1]) * 1.08
    chart = Chart(title, x_label, "sets", (low, high), (0, top))
    for i, (k, d) in enumerate(zip(kept_counts, dropped_counts)):
        x0, x1 = low + i * width, low + (i + 1) * width
        if k:
            chart.bar(x0, x1, 0, k, "kept")
        if d:
            chart.bar(x0, x1, k, k + d, "dropped")
    if sigma > 0:
        curve = [low + j * (high - low) / 120 for j in range(121)]
        chart.line([(x, peak * math.exp(-0.5 * ((x - mean) / sigma) ** 2)) for x in curve], "curve")
    return {"svg": chart.svg(), "mean": mean, "sigma": sigma, "n": len(values)}


def log_histogram(title, x_label, edges, counts, last_chosen):
    """All sets (pale), and those up to `last_chosen` (full)."""
    top = max(counts)
    chart = Chart(title, x_label, "sets", (edges[0], edges[-1]), (0.8, top * 1.5), True, True)
    for low, high, count in zip(edges, edges[1:], counts):
        if count:
            chart.bar(low, high, 0.8, count, "kept" if low <= last_chosen else "dropped")
    chart.vertical(last_chosen, "limit")
    return chart.svg()


def scatter_with_means(title, x_label, y_label, points, edges):
    """points: (x, y, label). A horizontal line is the mean of each of the bins with at least two."""
    top = max(y for _, y, _ in points) * 1.1
    chart = Chart(title, x_label, y_label, (edges[0], edges[-1]), (0, top or 1))
    for x, y, label in points:
        chart.dot(x, y, "dot", label)
    for low, high in zip(edges, edges[1:]):
        inside = [y for x, y, _ in points if low <= x < high or (x == high == edges[-1])]
        if len(inside) >= 2:
            mean = sum(inside) / len(inside)
            chart.line([(low, mean), (high, mean)], "mean")
    return chart.svg()


def image_cells(title, width_px, height_px, cells, points):
    """The image cut into 3 x 3: the mean error of each cell as its shade and number, a dot each pose.

    cells: rows of {mean, n}; points: (x_px, y_px, label)."""
    drawn_width = WIDTH - 8
    drawn_height = drawn_width * height_px / width_px
    worst = max([cell["mean"] for row in cells for cell in row if cell["n"]] + [1e-9])
    parts = []
    for i, row in enumerate(cells):
        for j, cell in enumerate(row):
            x, y = 4 + j * drawn_width / 3, 4 + i * drawn_height / 3
            shade = f"{0.08 + 0.62 * cell['mean'] / worst:.2f}" if cell["n"] else "0"
            parts.append(
                f'<rect class="cell" fill-opacity="{shade}" x="{_n(x)}" y="{_n(y)}" width="{_n(drawn_width / 3)}" '
                f'height="{_n(drawn_height / 3)}"/>'
            )
    for x_px, y_px, label in points:
        x, y = 4 + (x_px + 0.5) / width_px * drawn_width, 4 + (y_px + 0.5) / height_px * drawn_height
        parts.append(f'<circle class="dot" cx="{_n(x)}" cy="{_n(y)}" r="2.6"><title>{escape(label)}</title></circle>')
    for i, row in enumerate(cells):
        for j, cell in enumerate(row):
            x, y = 4 + (j + 0.5) * drawn_width / 3, 4 + (i + 0.5) * drawn_height / 3
            text = f"{cell['mean']:.1f} mm" if cell["n"] else "no pose"
            parts.append(f'<text class="cell-text" x="{_n(x)}" y="{_n(y)}" text-anchor="middle">{text}</text>')
            if cell["n"]:
                parts.append(
                    f'<text class="note" x="{_n(x)}" y="{_n(y + 14)}" text-anchor="middle">{cell["n"]} '
                    f'{"pose" if cell["n"] == 1 else "poses"}</text>'
                )
    return (
        f'<svg viewBox="0 0 {WIDTH} {_n(drawn_height + 8)}" role="img" aria-label="{escape(title)}">'
        + "".join(parts)
        + "</svg>"
    )


def error_bars(title, x_label, y_label, bars):
    """bars: (x, value, standard error)."""
    reach = max([abs(v) + e for _, v, e in bars] + [1e-9]) * 1.1
    xs = [x for x, _, _ in bars]
    chart = Chart(title, x_label, y_label, (min(xs) - 0.7, max(xs) + 0.7), (-reach, reach))
    chart.line([(chart.x.low, 0), (chart.x.high, 0)], "axis")
    for x, value, error in bars:
        chart.bar(x - 0.35, x + 0.35, 0, value, "kept")
        chart.line([(x, value - error), (x, value + error)], "curve")
    return chart.svg()


def curves(title, x_label, y_label, lines, x_log=False, y_log=False):
    """lines: (style, [(x, y), ...]). A logarithmic axis has no place for 0; None if nothing is left to show."""
    lines = [
        (style, [(x, y) for x, y in points if (x > 0 or not x_log) and (y > 0 or not y_log)]) for style, points in lines
    ]
    if not any(points for _, points in lines):
        return None
    xs = [x for _, points in lines for x, _ in points]
    ys = [y for _, points in lines for _, y in points]
    low, high = min(ys), max(ys)
    margin = 0 if y_log else 0.08 * (high - low or 1)
    chart = Chart(title, x_label, y_label, (min(xs), max(xs)), (low - margin, high + margin), x_log, y_log)
    for style, points in lines:
        chart.line(points, style)
        for x, y in points:
            chart.dot(x, y, "dot " + style)
    return chart.svg()
