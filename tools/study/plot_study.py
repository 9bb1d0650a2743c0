#!/usr/bin/python3 -EsB
"""Plots what voq_study wrote: plot_study.py FOLDER. Each plot is a PNG and an SVG beside the tables.

The first line is Debian's own Python, for which tools/setup installs matplotlib, without the user's packages.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

# The same tables give the same bytes: no dates, no random ids.
matplotlib.rcParams.update({"svg.hashsalt": "voqcal", "svg.fonttype": "none", "font.size": 10,
                            "axes.grid": True, "grid.alpha": 0.3, "axes.titlesize": 11})
BLUE, ORANGE, GREY = "#1f5fa8", "#d9710f", "#888888"
MAX_DOTS = 4000  # of a scatter plot: more only make the files large

NAMES = {"voq": "VOQ", "condition_number": "condition number", "board_error": "board error",
         "determinant": "determinant", "centre_distance": "distance of the centres",
         "scene_error": "predicted scene error", "random": "random", "all_poses": "all poses, one set"}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def number(row, column):
    return float(row[column]) if row[column] else float("nan")


def column(rows, name):
    return [number(row, name) for row in rows]


def logarithmic(*axes):
    """Plain numbers at 1, 2 and 5 of each decade; of many decades at 1 only."""
    for axis in axes:
        set_scale = axis.axes.set_xscale if axis.axis_name == "x" else axis.axes.set_yscale
        set_scale("log")
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 150 * low else (1,), numticks=12))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def save(figure, folder, name):
    figure.savefig(folder / f"{name}.png", dpi=120)
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    plt.close(figure)


def sentence(figure, text):
    figure.text(0.01, 0.01, text, fontsize=9, color="#333333", va="bottom", wrap=True)
    figure.tight_layout(rect=(0, 0.08, 1, 1))


def plot_spread(bins, xlabel, title, text, folder, name):
    """Spread of the calibration results of each bin."""
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(7.5, 6), sharex=True)
    x = column(bins, "figure")
    upper.plot(x, column(bins, "translation_spread_mm"), "o-", color=BLUE, ms=4)
    upper.set(ylabel="spread of translation (mm)", title=title)
    lower.plot(x, column(bins, "rotation_spread_deg"), "s-", color=ORANGE, ms=4)
    lower.set(ylabel="spread of rotation (degrees)", xlabel=xlabel)
    logarithmic(upper.xaxis, upper.yaxis, lower.yaxis)
    sentence(figure, text)
    save(figure, folder, name)


def plot_error(bins, xlabel, title, text, folder, name, log):
    """Mean and deviation of the reprojection error over the scene."""
    figure, axes = plt.subplots(figsize=(7.5, 4.6))
    x = column(bins, "figure")
    mean, deviation = column(bins, "error_mm"), column(bins, "deviation_mm")
    axes.plot(x, mean, "o-", color=BLUE, ms=4, label="mean over the scene")
    axes.plot(x, column(bins, "median_error_mm"), ":", color=BLUE, label="the same, median set of the bin")
    axes.plot(x, deviation, "s-", color=ORANGE, ms=4, label="standard deviation over the scene")
    axes.set(xlabel=xlabel, ylabel="reprojection error of the centre (mm)", title=title)
    if log:
        logarithmic(axes.xaxis, axes.yaxis)
    else:
        axes.set_ylim(bottom=0)
    axes.legend()
    sentence(figure, text)
    save(figure, folder, name)


def plot_figures(sets, correlations, folder):
    """Each figure that is known before calibration against the held-out error."""
    panels = [("voq", "voq", "VOQ"), ("condition_number", "kappa", "condition number"),
              ("board_error", "e_be_mm", "board error (mm)"), ("determinant", "volume", "volume of the normals"),
              ("centre_distance", "centre_distance_m", "RMS distance of the centres (m)"),
              ("scene_error", "predicted_error_mm", "predicted scene error (mm)")]
    spearman = {row["figure"]: number(row, "spearman") for row in correlations}
    scored = [row for row in sets if row["held_out_mm"]]
    shown = scored[::max(1, -(-len(scored) // MAX_DOTS))]
    figure, axes = plt.subplots(2, 3, figsize=(11, 7), sharey=True)
    for panel, (name, column_name, label) in zip(axes.flat, panels):
        panel.plot(column(shown, column_name), column(shown, "held_out_mm"), ".", ms=1.5, color=BLUE, alpha=0.5)
        panel.set(xlabel=label, title=f"rank correlation {spearman[name]:+.2f}")
        logarithmic(panel.xaxis, panel.yaxis)
    for panel in axes[:, 0]:
        panel.set_ylabel("held-out error of the set (mm)")
    sentence(figure, "Each dot is a set of three poses, calibrated and scored on all other poses. A figure that tells good "
                     "sets from bad\nsorts the dots: its rank correlation is near +1 (for volume and distance, where more "
                     "is better, the sign is turned).")
    save(figure, folder, "figures_against_error")


def plot_selectors(selectors, folder):
    figure, axes = plt.subplots(figsize=(7.5, 4.6))
    selectors = list(reversed(selectors))
    y = range(len(selectors))
    for offset, key, color, label in ((0.2, "average", BLUE, "average of the chosen sets"),
                                      (-0.2, "final", ORANGE, "refined over all poses from that average")):
        axes.barh([i + offset for i in y], column(selectors, f"{key}_mean_mm"), 0.38, color=color, label=label,
                  xerr=column(selectors, f"{key}_deviation_mm"), error_kw={"ecolor": GREY, "capsize": 3})
    axes.set_yticks(list(y))
    axes.set_yticklabels([NAMES[row["criterion"]] for row in selectors])
    axes.set(xlabel="centre error on poses left out (mm)", title="What the choice of sets is worth")
    axes.set_xlim(left=0)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncol=2, frameon=False)
    sentence(figure, "Leave-one-out: sets are chosen, calibrated, averaged and refined without a pose, then scored on it.\n"
                     "Bars: mean over the poses; whiskers: standard deviation.")
    save(figure, folder, "selectors")


def main(folder):
    sets, correlations = read(folder / "sets.csv"), read(folder / "correlations.csv")
    bins = read(folder / "bins.csv")
    of = {name: [row for row in bins if row["experiment"] == name]
          for name in ("condition_number", "board_error", "voq")}
    each = f"Each dot: the mean of {of['voq'][0]['num_sets']} of all {len(sets)} sets of three poses, in order of"
    plot_spread(of["condition_number"], "condition number of the normals",
                "Condition number against the scatter of the result",
                f"{each} the condition number.\nSpread: how far the extrinsics of these sets lie apart "
                "(1 sigma, three axes together).", folder, "condition_number")
    kept = sum(int(row["num_sets"]) for row in of["board_error"])
    plot_error(of["board_error"], "board error (mm): sum of the four edges' errors, mean of the three poses",
               "Board error against reprojection error (condition number < 20)",
               f"Each dot: the mean of {of['board_error'][0]['num_sets']} of {kept} sets with a condition number below 20, "
               "in order of board error.\nThe error is taken over all poses of the scene.", folder, "board_error", False)
    plot_spread(of["voq"], "VOQ", "VOQ against the scatter of the result",
                f"{each} VOQ.\nSpread: how far the extrinsics of these sets lie apart (1 sigma, three axes together).",
                folder, "voq_spread")
    plot_error(of["voq"], "VOQ", "VOQ against the error over the whole scene",
               f"{each} VOQ.\nThe error is taken over all poses of the scene.", folder, "voq_error", True)
    plot_figures(sets, correlations, folder)
    plot_selectors(read(folder / "selectors.csv"), folder)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: plot_study.py FOLDER")
    main(pathlib.Path(sys.argv[1]))
