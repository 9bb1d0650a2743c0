#!/usr/bin/env python3
"""layers_test.py ROOT: holds the includes below ROOT/modules to the house's arrows. Ends with 1 and a line for
each include that points where none may.

    process -> messaging -> rig, result -> files -> core;  rig_calibrator -> the modules that it runs;  images beside core;  in core, arrows point up the list of
    modules/core/CMakeLists.txt;  only core's own room of small headers (core/*.hpp) is everyone's
"""
import re
import sys
from pathlib import Path

# A room, and the rooms that it may include from beside itself. "core" stands for all of core's rooms.
ROOMS = {
    "core": set(),
    "images": set(),
    "files": {"core"},
    "rig": {"core", "files"},
    "result": {"core", "files"},
    "messaging": {"core", "files", "rig", "result", "images", "voqcal"},  # voqcal: what lcm-gen makes
    "health": {"core", "rig", "voqcal"},
}
PROCESS = {"core", "files", "rig", "result", "messaging", "health", "images", "voqcal"}  # never another process
# ... but the one that does for all pairs of a rig what these do for one.
ROOMS["rig_calibrator"] = PROCESS | {"voq_selector", "extrinsic_estimator", "extrinsic_refiner", "assessor", "pose_guide"}


def core_rooms(modules):
    """In the order of their list: each may include those above it."""
    return re.findall(r"^add_subdirectory\((\w+)\)", (modules / "core/CMakeLists.txt").read_text(), re.M)


def why_not(source, target, order):
    """Why `source` may not include `target`, both paths below modules/; empty if it may."""
    here, there = source.split("/"), target.split("/")
    if here[0] != there[0]:
        allowed = ROOMS.get(here[0], PROCESS)
        names = ", ".join(sorted(allowed)) or "nothing"
        return "" if there[0] in allowed else f"{here[0]} may include of ours only: {names}"
    if here[0] != "core" or len(there) == 2:
        return ""  # its own room, or core's small headers
    if len(here) == 2:
        return "core's small headers include no room"
    for room in (here[1], there[1]):
        if room not in order:
            return f"core/{room} is not in modules/core/CMakeLists.txt"
    return "" if order.index(there[1]) <= order.index(here[1]) else f"core/{there[1]} comes after core/{here[1]}"


def wrong_includes(modules):
    order = core_rooms(modules)
    rooms = {path.name for path in modules.iterdir() if path.is_dir()} | {"voqcal"}
    for path in sorted(modules.rglob("*.?pp")):
        source = path.relative_to(modules).as_posix()
        for number, line in enumerate(path.read_text().splitlines(), 1):
            found = re.match(r'#include ["<]((\w+)/[^">]+)[">]', line)
            if not found or found[2] not in rooms:
                continue
            reason = why_not(source, found[1], order)
            if reason:
                yield f"modules/{source}:{number}: includes {found[1]}: {reason}"


def check_the_check():
    """The rules themselves, on includes that must be allowed or refused."""
    order = ["geometry", "board", "likelihood"]
    allowed = [
        ("core/board/a.hpp", "core/geometry/b.hpp"),
        ("core/board/a.hpp", "core/units.hpp"),
        ("assessor/a.cpp", "result/b.hpp"),
        ("assessor/a.cpp", "assessor/b.hpp"),
        ("rig_calibrator/a.cpp", "assessor/b.hpp"),
    ]
    refused = [
        ("core/geometry/a.hpp", "core/board/b.hpp"),
        ("core/units.hpp", "core/board/b.hpp"),
        ("core/board/a.cpp", "files/b.hpp"),
        ("images/a.cpp", "core/units.hpp"),
        ("files/a.cpp", "rig/b.hpp"),
        ("rig/a.cpp", "messaging/b.hpp"),
        ("rig/a.cpp", "result/b.hpp"),
        ("result/a.cpp", "voqcal/sample_t.hpp"),
        ("messaging/a.cpp", "assessor/b.hpp"),
        ("assessor/a.cpp", "dashboard/b.hpp"),
        ("rig_calibrator/a.cpp", "sample_collector/b.hpp"),
    ]
    for source, target in allowed:
        assert not why_not(source, target, order), (source, target)
    for source, target in refused:
        assert why_not(source, target, order), (source, target)


check_the_check()
problems = list(wrong_includes(Path(sys.argv[1]) / "modules"))
print("\n".join(problems) if problems else "every include points along an arrow")
sys.exit(1 if problems else 0)
