#!/usr/bin/env python3
"""Prints board.svg: what to measure on a board for the rig file. Drawn to the scale of config/rigs/simulated_vlp16.yaml."""

WIDTH_MM, HEIGHT_MM, SQUARE_MM = 610, 850, 95
CORNERS_X, CORNERS_Y = 5, 7
OFFSET_X_MM = 2
PX_PER_MM = 0.4
LEFT, TOP = 160, 60
INK, MEASURE, CORNER = "#263238", "#c62828", "#1565c0"


def rect(x, y, width, height, fill, more=""):
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" fill="{fill}" {more}/>'


def text(x, y, words, colour=INK, anchor="start", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" {more}>{words}</text>'


def arrow(x0, y0, x1, y1, colour):
    return (
        f'<path d="M{x0:.1f} {y0:.1f}L{x1:.1f} {y1:.1f}" stroke="{colour}" stroke-width="1.6" '
        'marker-start="url(#tip)" marker-end="url(#tip)"/>'
    )


def squares(left, top, side):
    columns, rows = CORNERS_X + 1, CORNERS_Y + 1
    dark_parity = (rows - 1) % 2  # the lower left one is dark
    return [
        rect(left + i * side, top + j * side, side, side, INK)
        for j in range(rows)
        for i in range(columns)
        if (i + j) % 2 == dark_parity
    ]


def drawing():
    width, height, side = WIDTH_MM * PX_PER_MM, HEIGHT_MM * PX_PER_MM, SQUARE_MM * PX_PER_MM
    right, bottom = LEFT + width, TOP + height
    middle_x, middle_y = LEFT + width / 2, TOP + height / 2
    pattern_left = middle_x + OFFSET_X_MM * PX_PER_MM - (CORNERS_X + 1) * side / 2
    pattern_top = middle_y - (CORNERS_Y + 1) * side / 2
    yield rect(0, 0, 800, 440, "#fff")
    yield rect(LEFT, TOP, width, height, "#fafafa", 'stroke="#607d8b" stroke-width="2"')
    yield from squares(pattern_left, pattern_top, side)
    for j in range(CORNERS_Y):
        for i in range(CORNERS_X):
            x, y = pattern_left + (i + 1) * side, pattern_top + (j + 1) * side
            yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.6" fill="{CORNER}" stroke="#fff" stroke-width="1"/>'
    yield arrow(LEFT, TOP - 18, right, TOP - 18, MEASURE)
    yield text(middle_x, TOP - 28, "width_m: 0.61", MEASURE, "middle", 'font-weight="bold"')
    yield arrow(LEFT - 18, TOP, LEFT - 18, bottom, MEASURE)
    yield text(LEFT - 30, middle_y, "height_m: 0.85", MEASURE, "end", 'font-weight="bold"')
    yield text(LEFT - 30, middle_y + 20, "the whole plate,", INK, "end")
    yield text(LEFT - 30, middle_y + 38, "without its stand", INK, "end")
    notes = right + 34
    square_top = pattern_top + side
    yield arrow(right + 16, square_top, right + 16, square_top + side, MEASURE)
    yield text(notes, square_top + 16, "square_m: 0.095", MEASURE, "start", 'font-weight="bold"')
    yield text(notes, square_top + 34, "measure over several squares and divide")
    yield text(notes, middle_y - 12, "num_corners_x: 5", CORNER, "start", 'font-weight="bold"')
    yield text(notes, middle_y + 8, "num_corners_y: 7", CORNER, "start", 'font-weight="bold"')
    yield text(notes, middle_y + 28, "inner corners (blue), not squares:")
    yield text(notes, middle_y + 46, "6 x 8 squares have 5 x 7 of them")
    yield text(notes, bottom - 84, "pattern_offset_x_m, _y_m", MEASURE, "start", 'font-weight="bold"')
    yield text(notes, bottom - 64, "only if the pattern is not in the plate's middle")
    yield text(notes, bottom - 36, "Which way up: with a dark square at the")
    yield text(notes, bottom - 18, "pattern's lower left, where the sum of")
    yield text(notes, bottom, "corners is odd; else choose, and keep to it.")


print(
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 800 440" width="800" height="440" '
    'font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="14" role="img" '
    'aria-label="What to measure on a board: width, height, one square, and the inner corners to count">\n'
    '<defs><marker id="tip" markerWidth="10" markerHeight="8" refX="9" refY="4" orient="auto-start-reverse">'
    f'<path d="M0 0 10 4 0 8z" fill="{MEASURE}"/></marker></defs>'
)
print("\n".join(drawing()))
print("</svg>")
