#!/usr/bin/python3 -EsSB
"""make_report.py RESULT_JSON OVERLAYS OUT [CODE]: report.html of a result and the pictures of its samples.
make_report.py --no-result JSON PICTURES OUT: no_result.html, of what was seen where there is no result.
make_report.py --compile CODE: the template as code, which saves compiling it for each report.

No network, no scripts in the page, the same bytes for the same input. Python's flags keep it to Debian's packages: of the
user's (PYTHONPATH, pip, conda) none is seen, whatever is in them.
"""

import base64
import json
import os
import pathlib
import re
import sys

sys.path.append("/usr/lib/python3/dist-packages")
import jinja2  # noqa: E402  (of Debian's python3-jinja2)

import svg  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
AXES = ("x", "y", "z")


def finite(values):
    return [value for value in values if value is not None]


def mean(values):
    return sum(values) / len(values) if values else None


def sigma(variance):
    """None: the poses are too few to tell."""
    return None if variance is None else variance**0.5


def held_out(sample, error="centre_mm"):
    """The error of a used sample by the extrinsic refined without it; None if there is none."""
    return sample["errors"]["held_out"][error] if sample["is_used"] else None


def set_histograms(chosen):
    """One histogram of what the sets gave for each of the six parameters."""
    figures = []
    for key, unit in (("rotation_deg", "degrees"), ("translation_mm", "mm")):
        for i, axis in enumerate(AXES):
            kept = [s[key][i] for s in chosen if s["is_kept"]]
            dropped = [s[key][i] for s in chosen if not s["is_kept"] and s["status"] == "converged"]
            name = f"{key.split('_')[0]} {axis}"
            figure = svg.histogram_with_gaussian(
                f"Histogram of the sets' {name}", f"{name}, difference from the average ({unit})", kept, dropped
            )
            figures.append({**figure, "name": name, "unit": unit})
    return figures


def voq_figure(sets):
    histogram, chosen = sets["all_voq"], sets["chosen"]
    if not histogram or not chosen:
        return None
    return {
        "svg": svg.log_histogram(
            "Histogram of the VOQ of all sets",
            "VOQ (condition number + board error in mm)",
            histogram["edges"],
            histogram["counts"],
            max(s["voq"] for s in chosen),
        ),
        "num_sets": histogram["num_sets"],
        "num_chosen": len(chosen),
        "best": min(s["voq"] for s in chosen),
        "worst": max(s["voq"] for s in chosen),
    }


def cells_figure(samples, camera):
    """Held-out error in each ninth of the image."""
    width, height = camera["width_px"], camera["height_px"]
    inside = [[[] for _ in range(3)] for _ in range(3)]
    points = []
    for sample in samples:
        error, centre = held_out(sample), sample["camera_centre_px"]
        if error is None or centre is None:
            continue
        column, row = (min(max(int(3 * (c + 0.5) / n), 0), 2) for c, n in zip(centre, (width, height)))
        inside[row][column].append(error)
        points.append((*centre, f"pose {sample['id']}: {error:.1f} mm"))
    cells = [[{"mean": mean(errors) or 0.0, "n": len(errors)} for errors in row] for row in inside]
    if not points:
        return None
    return {
        "svg": svg.image_cells("Held-out error by part of the image", width, height, cells, points),
        "num_empty": sum(not cell["n"] for row in cells for cell in row),
    }


def range_figure(samples):
    points = [
        (s["range_m"], held_out(s), f"pose {s['id']}: {held_out(s):.1f} mm at {s['range_m']:.1f} m")
        for s in samples
        if held_out(s) is not None
    ]
    if not points:
        return None
    low, high = min(p[0] for p in points), max(p[0] for p in points)
    edges = [low + (high - low) * i / 4 for i in range(5)] if high > low else [low - 0.5, low + 0.5]
    return svg.scatter_with_means(
        "Held-out error against range", "range of the board from the lidar (m)", "centre error (mm)", points, edges
    )


def picture(folder, sample, kind):
    path = folder / f"{sample['id']:04d}_{kind}.jpg"
    return encoded(path) if path.exists() else None


def encoded(path):
    return "data:image/jpeg;base64," + base64.b64encode(path.read_bytes()).decode()


def poses(samples, folder):
    kinds = ("scene", "before", "after")
    return [{**sample, "pictures": {kind: picture(folder, sample, kind) for kind in kinds}} for sample in samples]


def coloured(samples, folder):
    """Of the one sample that has them, the pictures of its points in the image's colours."""
    for sample in samples:
        pictures = [picture(folder, sample, kind) for kind in ("coloured", "coloured_by_turned")]
        if all(pictures):
            return {"id": sample["id"], "range_m": sample["range_m"], "right": pictures[0], "wrong": pictures[1]}
    return None


def kind_of(reason):
    """A reason without its details: "lidar: board bent" of "lidar: board bent by 481 mm"."""
    parts = reason.split(": ")
    kept = parts[:2] if parts[0] in ("lidar", "camera") else parts[:1]
    return re.sub(r" by \d.*", "", ": ".join(kept))


def rejected_frames(frames):
    """Reasons with how often and when (seconds after the first)."""
    found = {}
    for frame in frames["rejected"]:
        found.setdefault(kind_of(frame["reason"]), []).append(frame["utime"])
    start = min((f["utime"] for f in frames["rejected"]), default=0)
    return [
        {"reason": reason, "count": len(times), "seconds": [(t - start) / 1e6 for t in times]}
        for reason, times in sorted(found.items(), key=lambda item: (-len(item[1]), item[0]))
    ]


def ring_figure(bias):
    rings = bias.get("ring_m") or {}
    bars = [
        (ring, 1e3 * value, 1e3 * (error or 0.0))
        for ring, (value, error) in enumerate(zip(rings.get("value", []), rings.get("standard_error", [])))
    ]
    if len(bars) < 2:  # a cloud without ring numbers has one
        return None
    return svg.error_bars("Range offset of each ring", "ring (by its number)", "reads too long by (mm)", bars)


def scene_figures(check):
    """The score along each axis: where it is highest is where the scene wants the extrinsic."""
    probes = check.get("perturbed")
    if not probes:
        return []
    refined = check["score"]["refined"]
    figures = []
    for first, unit, factor, what in ((0, "degrees", 57.29577951308232, "turned"), (3, "mm", 1e3, "shifted")):
        lines = []
        for i, axis in enumerate(AXES):
            points = [(factor * p["delta"][first + i], p["score"]) for p in probes if p["delta"][first + i] != 0]
            lines.append((f"line-{axis}", sorted([*points, (0.0, refined)])))
        label = f"{what} about the camera's axes by ({unit})" if first == 0 else f"{what} along them by ({unit})"
        figures.append(svg.curves(f"Score of the scene, {what}", label, "score (0.5 is chance)", lines))
    return figures


def predicted_figure(errors):
    if not errors:
        return None
    lines = [
        ("line-x", [(e["range_m"], e["centre_mm"]) for e in errors if e["centre_mm"] is not None]),
        ("line-y", [(e["range_m"], e["corner_mm"]) for e in errors if e["corner_mm"] is not None]),
    ]
    return svg.curves("Predicted error by range", "range of a point (m)", "predicted error (mm)", lines, True, True)


class Code(jinja2.BytecodeCache):
    """A template's code in a file. jinja2 passes it over if it is another template's or another Python's."""

    def __init__(self, path, is_written):
        self.path, self.is_written = pathlib.Path(path), is_written

    def load_bytecode(self, bucket):
        if not self.is_written and self.path.is_file():
            with self.path.open("rb") as file:
                bucket.load_bytecode(file)

    def dump_bytecode(self, bucket):
        if self.is_written:
            with self.path.open("wb") as file:
                bucket.write_bytecode(file)


def page(code=None, name="report.html.j2"):
    environment = jinja2.Environment(
        # Not by its path, which would be in the code.
        loader=jinja2.FunctionLoader(lambda name: (HERE / name).read_text(encoding="utf-8")), bytecode_cache=code,
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )
    environment.filters["minus"] = lambda text: str(text).replace("-", "\u2212")
    return environment.get_template(name)


def report(data, overlays, template):
    result, samples = data["result"], data["samples"]
    return template.render(
        data=data,
        result=result,
        style=(HERE / "report.css").read_text(encoding="utf-8"),
        verdict=data["verdict"],
        sigma=[sigma(result["covariance_given_rig"][i][i]) for i in range(6)],
        place_sigma=[sigma(result["covariance"][i][i]) for i in range(6)],
        histograms=set_histograms(data["sets"]["chosen"]),
        voq=voq_figure(data["sets"]),
        cells=cells_figure(samples, data["rig"]["camera"]),
        range_svg=range_figure(samples),
        coloured=coloured(samples, overlays),
        poses=poses(samples, overlays),
        range_key=data["range_colours"],
        frames=rejected_frames(data["frames"]),
        rings=ring_figure(result.get("lidar_bias") or {}),
        scene=scene_figures(result.get("scene_check") or {}),
        predicted=predicted_figure(result.get("predicted_errors")),
    )


def main(result_json, overlays, out, code=None):
    data = json.loads(pathlib.Path(result_json).read_text(encoding="utf-8"))
    write(report(data, pathlib.Path(overlays), page(code and Code(code, is_written=False))), out)


def no_result(what_was_seen, pictures, out):
    data = json.loads(pathlib.Path(what_was_seen).read_text(encoding="utf-8"))
    for part in data["misses"] + data["samples"]:
        part["pictures"] = [encoded(pathlib.Path(pictures) / name) for name in part["files"]]
    style = (HERE / "report.css").read_text(encoding="utf-8")
    write(page(name="no_result.html.j2").render(data=data, style=style), out)


def write(text, out):
    unfinished = pathlib.Path(f"{out}.unfinished")
    unfinished.write_text(text, encoding="utf-8")
    os.replace(unfinished, out)


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "--compile":
        page(Code(sys.argv[2], is_written=True))
    elif len(sys.argv) == 5 and sys.argv[1] == "--no-result":
        no_result(*sys.argv[2:])
    elif len(sys.argv) in (4, 5):
        main(*sys.argv[1:])
    else:
        sys.exit("usage: make_report.py RESULT_JSON OVERLAYS_FOLDER OUT [CODE] | --no-result JSON PICTURES OUT | --compile CODE")
