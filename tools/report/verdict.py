"""Is the result good? Each check says what it looked at and what it means, the verdict is the worst."""

GOOD, LOOK, BAD = "good", "look", "bad"
ORDER = (GOOD, LOOK, BAD)
HEADLINES = {
    GOOD: "Good: use it.",
    LOOK: "Usable, but look at what is marked below.",
    BAD: "Do not use it yet: see what is marked below.",
}

# Limits (good below the first, bad above the second), and where they come from.
HELD_OUT_MM = (5.0, 12.0)  # the method's paper reports means of 10 to 12 mm on a VLP-16
OVERFIT_RATIO = (1.5, 3.0)  # held out against in sample; 1.1 is common with 30 poses
SIGMA_DEG = (0.05, 0.2)  # 0.05 degrees is 9 mm at 10 m
SIGMA_MM = (3.0, 10.0)
NORMAL_DEG = (0.7, 2.0)  # a clean simulated VLP-16 shows about 0.6
NUM_POSES = (15, 6)  # here more is better
EMPTY_CELLS = (4, 7)  # of the 9 parts of the image
REJECTED_SHARE = (0.15, 0.4)


def grade(value, limits):
    """None (unknown) is not good."""
    if value is None:
        return LOOK
    good, bad = limits
    if good > bad:  # more is better
        return GOOD if value >= good else BAD if value < bad else LOOK
    return GOOD if value <= good else BAD if value > bad else LOOK


def check(name, value, limits, text):
    return {"name": name, "grade": grade(value, limits), "text": text}


def num_empty_cells(data):
    camera = data["rig"]["camera"]
    size = (camera["width_px"], camera["height_px"])
    filled = {
        tuple(min(max(int(3 * (c + 0.5) / n), 0), 2) for c, n in zip(sample["camera_centre_px"], size))
        for sample in data["samples"]
        if sample["is_used"] and sample["camera_centre_px"]
    }
    return 9 - len(filled)


def number(value, digits, unit):
    return "unknown" if value is None else f"{value:.{digits}f} {unit}"


def fit_checks(data):
    scores = data["result"]["scores"]
    left_out, in_sample = scores["held_out"]["centre_mm"]["mean"], scores["in_sample"]["centre_mm"]["mean"]
    ratio = left_out / in_sample if left_out is not None and in_sample else None
    normal = scores["held_out"]["normal_deg"]["mean"]
    return [
        check(
            "Poses it never saw",
            left_out,
            HELD_OUT_MM,
            f"The board's centre lands {number(left_out, 1, 'mm')} (mean) from where the camera sees it, on poses left "
            "out of the fit.",
        ),
        check(
            "No overfitting",
            ratio,
            OVERFIT_RATIO,
            f"That is {number(ratio, 2, 'times')} the error on the poses that made the result.",
        ),
        check(
            "Board directions",
            normal,
            NORMAL_DEG,
            f"Lidar and camera disagree by {number(normal, 2, 'degrees')} (mean) on where the board faces. Above a "
            "degree the lidar's ranges are usually biased; the centres do not show it.",
        ),
    ]


def certainty_checks(data):
    sigma = [data["result"]["covariance"][i][i] ** 0.5 for i in range(6)]
    rotation_deg, translation_mm = max(sigma[:3]) * 57.29577951308232, max(sigma[3:]) * 1e3
    return [
        check("Rotation is certain", rotation_deg, SIGMA_DEG, f"Largest standard deviation {rotation_deg:.3f} degrees."),
        check("Translation is certain", translation_mm, SIGMA_MM, f"Largest standard deviation {translation_mm:.1f} mm."),
    ]


def pose_checks(data):
    samples = data["samples"]
    num_used = sum(sample["is_used"] for sample in samples)
    share = 1 - num_used / len(samples)
    empty = num_empty_cells(data)
    return [
        check("Enough poses", num_used, NUM_POSES, f"{num_used} poses were used; 20 to 40 are recommended."),
        check(
            "Poses all over the image",
            empty,
            EMPTY_CELLS,
            f"{9 - empty} of the 9 parts of the image have a pose. Where there is none, the result is extrapolated.",
        ),
        check(
            "Few samples rejected",
            share,
            REJECTED_SHARE,
            f"{len(samples) - num_used} of {len(samples)} samples disagreed with the others and were left out.",
        ),
    ]


def sentence(text):
    return text[:1].upper() + text[1:].rstrip(".") + "."


def scene_checks(data):
    """The scene's own word, and the likeliest cause of what is wrong; nothing where they were not asked."""
    result = data["result"]
    checks = []
    scene = result.get("scene_check")
    if scene and scene["verdict"] != "not judged":
        agrees = scene["verdict"] == "agrees"
        checks.append({"name": "The whole scene", "grade": GOOD if agrees else BAD, "text": sentence(scene["reason"])})
    if "diagnosis" in result:
        findings = result["diagnosis"]
        text = sentence(findings[0]["text"]) if findings else "Nothing was found that would explain the errors better."
        checks.append({"name": "Nothing suspicious", "grade": LOOK if findings else GOOD, "text": text})
    return checks


def judge(data):
    """{grade, headline, checks}."""
    checks = fit_checks(data) + certainty_checks(data) + pose_checks(data) + scene_checks(data)
    worst = max((each["grade"] for each in checks), key=ORDER.index)
    return {"grade": worst, "headline": HEADLINES[worst], "checks": checks}
